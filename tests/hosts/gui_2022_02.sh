#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Runs the filter in the window of MeshLab 2022.02 of Debian trixie:
# gui_2022_02.sh [PLUGIN [CLOUD [OUT]]]
# The Debian root directory is made on first use, in $NEURAL_MESH_ROOTS or the user's cache folder. Needs root.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
exec "$here/gui_in_root.sh" 2022.02 trixie "$@"
