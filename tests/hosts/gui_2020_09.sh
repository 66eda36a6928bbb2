#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Runs the filter in the window of the installed MeshLab 2020.09:
# gui_2020_09.sh [PLUGIN [CLOUD [OUT]]]
# Saves meshlab_2020.09_dialog.png and meshlab_2020.09_result.png in the folder OUT (default out/gui).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
project=$(cd "$here/../.." && pwd)
plugin=${1:-$project/build/plugins/meshlab-2020.09/libfilter_neuralmesh.so}
cloud=${2:-$project/out/cloud/bunny_points.ply}
exec "${PYTHON:-/usr/bin/python3}" "$here/gui_filter.py" --plugin "$plugin" --cloud "$cloud" \
    --out "${3:-$project/out/gui}"
