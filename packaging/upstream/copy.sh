#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Puts the filter into a source tree of MeshLab (2022.02 or later): copy.sh MESHLAB
# Then add meshlabplugins/filter_neuralmesh to MESHLAB_PLUGINS in its src/CMakeLists.txt, or pass
# -DMESHLAB_PLUGINS=meshlabplugins/filter_neuralmesh to build it alone.
set -eu
project=$(cd "$(dirname "$0")/../.." && pwd)
[ -d "${1:-}/src/meshlabplugins" ] || { echo "copy.sh: '${1:-}' is no source tree of MeshLab." >&2; exit 1; }
folder=$1/src/meshlabplugins/filter_neuralmesh
mkdir -p "$folder/vcg_core"
cd "$project/filter_neuralmesh"
cp actions.cpp actions.h host_layer.h host_parameters.h meshlab_2022.cpp meshlab_2022.h "$folder/"
cd "$project/vcg_core"
find . -path ./c_api -prune -o \( -name '*.cpp' -o -name '*.h' \) -print | while read -r file; do
    mkdir -p "$folder/vcg_core/$(dirname "$file")"
    cp "$file" "$folder/vcg_core/$file"
done
cp "$project/packaging/upstream/CMakeLists.txt" "$folder/"
