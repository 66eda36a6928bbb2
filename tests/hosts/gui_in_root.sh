#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Runs the filter in the MeshLab of another Debian release: gui_in_root.sh VERSION SUITE [PLUGIN [CLOUD [OUT]]]
# Called by gui_2022_02.sh and gui_2025_07.sh.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
project=$(cd "$here/../.." && pwd)
version=$1
suite=$2
shift 2
plugin=${1:-$project/build/plugins/meshlab-$version/libfilter_neuralmesh.so}
cloud=${2:-$project/out/cloud/bunny_points.ply}
roots=${NEURAL_MESH_ROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/neural-mesh/roots}
"$here/gui_debian_root.sh" "$version" "$suite" "$roots/$suite"
exec "${PYTHON:-/usr/bin/python3}" "$here/gui_filter.py" --root "$roots/$suite" --plugin "$plugin" --cloud "$cloud" \
    --out "${3:-$project/out/gui}"
