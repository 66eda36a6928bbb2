#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Every cloud of the folder clouds/ becomes a neural mesh in meshes/, two at a time.
# Start it where the script reconstruct.mlx lies.
set -euo pipefail
mkdir -p meshes
ls clouds/*.ply | parallel --jobs 2 --halt now,fail=1 \
    'xvfb-run -a meshlabserver -i {} -o meshes/{/} -m vq vc -s reconstruct.mlx'
