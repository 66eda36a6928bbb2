// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/rms_error.h"

#include <cmath>

#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

double rms_distance(const TargetSpace& target, const Network& network, int samples, Random& random) {
    const Surface surface(network);
    const FaceTree tree(surface);
    double sum = 0;
    for (int i = 0; i < samples; ++i)
        sum += static_cast<double>(tree.nearest(to_eigen(target.sample(random))).foot.squared_distance);
    return std::sqrt(sum / samples);
}

}  // namespace neuralmesh
