#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Makes the pictures, the tables of features, and the screenshots: figures.sh [BUILD [PICTURES [OUT]]]
#   BUILD     the build folder, configured, with plugins and the virtual environment (default build)
#   PICTURES  the folder of the pictures (default screenshots)
#   OUT       the folder of tables, numbers, clouds and meshes (default out/figures)
# NEURAL_MESH_DATA may name a folder of models that are in no Debian package. Screenshots of MeshLab 2025.07 are made if
# tests/hosts/gui_debian_root.sh has made its root directory.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
cd "$here/../../.."
build="${1:-build}"
pictures="${2:-screenshots}"
out="${3:-out/figures}"
python="${PYTHON:-$build/venv/bin/python}"
roots="${NEURAL_MESH_ROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/neural-mesh/roots}"
plugin="$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so"
mkdir -p "$pictures" "$out"

say() { printf '== %s\n' "$*"; }

# picture NAME WIDTH SCRIPT WORD...: makes one picture, at most so wide.
picture() {
    say "$1.png"
    "$python" "$here/$3" "$pictures/$1.png" "${@:4}"
    "$python" "$here/small_png.py" --width "$2" "$pictures/$1.png"
}

# screenshots SCRIPT VERSION: the filter in that MeshLab's window, dialog and result.
screenshots() {
    say "Screenshots of $2"
    PYTHON="$python" "tests/hosts/$1" "$build/plugins/meshlab-$2/libfilter_neuralmesh.so" \
        "$out/figure_bunny_vertices.ply" "$out/gui"
    cp "$out/gui/meshlab_$2"_{dialog,result}.png "$pictures"
    "$python" "$here/small_png.py" --width 1080 "$pictures/meshlab_$2"_{dialog,result}.png
}

cmake --build "$build" --target learn plugins -- --quiet
say "Figures of the paper"
"$python" "$here/../paper/paper_figures.py" --learn "$build/tests/learn" --out "$out" --pictures "$pictures"
if [ -n "${NEURAL_MESH_DATA:-}" ]; then
    picture open_scans 1080 open_scans.py --learn "$build/tests/learn" --data "$NEURAL_MESH_DATA" --out "$out"
    picture raw_scans 900 open_scans.py --learn "$build/tests/learn" --sheet raw --data "$NEURAL_MESH_DATA" --out "$out"
fi
picture creases 1080 creases.py --plugin "$plugin" --out "$out"
picture crease_lines 1080 crease_lines.py --learn "$build/tests/learn" --out "$out"
picture texture 900 texture.py --plugin "$plugin" --out "$out"
picture python 1080 python_page.py --plugin "$plugin"
picture going_on 1080 going_on.py --learn "$build/tests/learn" --out "$out"
screenshots gui_2020_09.sh 2020.09
if [ -e "$roots/sid.complete" ]; then screenshots gui_2025_07.sh 2025.07; fi
say "What selects features best"
"$python" "$here/../paper/features.py" --learn "$build/tests/learn" --out "$out"
say "Edges along creases"
"$python" "$here/../paper/crease_table.py" --learn "$build/tests/learn" --out "$out"
