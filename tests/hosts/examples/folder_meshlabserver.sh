#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Makes a neural mesh in meshes/ of each cloud in clouds/, two at a time.
# Run it in the folder that contains clouds/ and reconstruct.mlx.
set -euo pipefail
mkdir -p meshes
ls clouds/*.ply | parallel --jobs 2 --halt now,fail=1 \
    'xvfb-run -a meshlabserver -i {} -o meshes/{/} -m vq vc -s reconstruct.mlx'
