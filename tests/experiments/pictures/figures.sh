#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Makes the paper's table and figures, and the screenshots: figures.sh [BUILD [PICTURES [OUT]]]
#   BUILD     the build folder, configured, with plugins and the virtual environment (default build)
#   PICTURES  the folder of the pictures (default screenshots)
#   OUT       the folder of tables, numbers, clouds and meshes (default out/figures)
# NEURAL_MESH_DATA may name a folder of models that are in no Debian package. Screenshots of MeshLab 2022.02 and
# 2025.07 are made if tests/hosts/gui_debian_root.sh has made their root directories.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
cd "$here/../../.."
build="${1:-build}"
pictures="${2:-screenshots}"
out="${3:-out/figures}"
python="${PYTHON:-$build/venv/bin/python}"
roots="${NEURAL_MESH_ROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/neural-mesh/roots}"
mkdir -p "$pictures" "$out"

say() { printf '== %s\n' "$*"; }

# screenshots SCRIPT VERSION: the filter in that MeshLab's window, dialog and result.
screenshots() {
    PYTHON="$python" "tests/hosts/$1" "$build/plugins/meshlab-$2/libfilter_neuralmesh.so" \
        "$out/figure_bunny_vertices.ply" "$out/gui"
    cp "$out/gui/meshlab_$2"_{dialog,result}.png "$pictures"
    "$python" "$here/small_png.py" --width 1080 "$pictures/meshlab_$2"_{dialog,result}.png
}

cmake --build "$build" --target learn counter_trace check_mesh plugins -- --quiet
say "Figures of the paper"
"$python" "$here/../paper/paper_figures.py" --learn "$build/tests/learn" --out "$out" --pictures "$pictures"
if [ -n "${NEURAL_MESH_DATA:-}" ]; then
    say "Real scans, open"
    "$python" "$here/open_scans.py" "$build/tests/learn" "$pictures/open_scans.png" --data "$NEURAL_MESH_DATA" --out "$out"
    "$python" "$here/small_png.py" --width 1080 "$pictures/open_scans.png"
    "$python" "$here/open_scans.py" "$build/tests/learn" "$pictures/raw_scans.png" --sheet raw --data "$NEURAL_MESH_DATA" --out "$out"
    "$python" "$here/small_png.py" --width 900 "$pictures/raw_scans.png"
fi
say "Creases of noisy data"
"$python" "$here/creases.py" "$pictures/creases.png" --plugin "$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so" --out "$out"
"$python" "$here/small_png.py" --width 1080 "$pictures/creases.png"
say "Crease lines"
"$python" "$here/crease_lines.py" "$pictures/crease_lines.png" --learn "$build/tests/learn" --out "$out"
"$python" "$here/small_png.py" --width 1080 "$pictures/crease_lines.png"
say "Colours as a texture"
"$python" "$here/texture.py" "$pictures/texture.png" --plugin "$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so" --out "$out"
"$python" "$here/small_png.py" --width 900 "$pictures/texture.png"
say "From numpy"
"$python" "$here/python_page.py" "$pictures/python.png" --plugin "$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so"
"$python" "$here/small_png.py" --width 1080 "$pictures/python.png"
say "A start of one's own"
"$python" "$here/going_on.py" "$pictures/going_on.png" --learn "$build/tests/learn" --out "$out"
"$python" "$here/small_png.py" --width 1080 "$pictures/going_on.png"
say "Screenshots"
screenshots gui_2020_09.sh 2020.09
if [ -e "$roots/trixie.complete" ]; then screenshots gui_2022_02.sh 2022.02; fi
if [ -e "$roots/sid.complete" ]; then screenshots gui_2025_07.sh 2025.07; fi
say "Table 1 of the paper"
"$python" "$here/../paper/paper_table1.py" --learn "$build/tests/learn" --check "$build/tests/check_mesh" --out "$out"
say "Features by learning, by the final mesh and by the cloud"
"$python" "$here/../paper/features.py" --learn "$build/tests/learn" --out "$out"
say "Edges along creases"
"$python" "$here/../paper/crease_table.py" --learn "$build/tests/learn" --out "$out"
say "Creases of given meshes"
"$python" "$here/../paper/given_meshes.py" --plugin "$build/plugins/pymeshlab-2025.7/libfilter_neuralmesh.so" --out "$out"
say "Termination by eq 8"
"$python" "$here/../paper/paper_termination.py" --learn "$build/tests/learn" --trace "$build/tests/counter_trace" --out "$out"
