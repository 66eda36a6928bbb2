#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Runs the filter in the window of MeshLab 2025.07 of Debian sid:
# gui_2025_07.sh [PLUGIN [CLOUD [OUT]]]
# The Debian root directory is made on first use, in $NEURAL_MESH_ROOTS or the user's cache folder. Needs root.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
project=$(cd "$here/../.." && pwd)
plugin=${1:-$project/build/plugins/meshlab-2025.07/libfilter_neuralmesh.so}
cloud=${2:-$project/out/cloud/bunny_points.ply}
root=${NEURAL_MESH_ROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/neural-mesh/roots}/sid
"$here/gui_debian_root.sh" 2025.07 sid "$root"
exec "${PYTHON:-/usr/bin/python3}" "$here/gui_filter.py" --root "$root" --plugin "$plugin" --cloud "$cloud" \
    --out "${3:-$project/out/gui}"
