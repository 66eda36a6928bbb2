// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/few_faces.h"

#include <limits>

#include "vcg_core/mesh/triangle_lanes.h"

namespace neuralmesh {

struct FewFaces::Kernel {
    NEURALMESH_MULTIVERSIONED static void run(const FewFaces& few, const EightVectors& points,
                                              Nearest& nearest);
};

void FewFaces::Kernel::run(const FewFaces& few, const EightVectors& points, Nearest& nearest) {
    nearest.squared_distance = Eight{} + std::numeric_limits<float>::max();
    nearest.label = EightInts{};
    for (std::size_t i = 0; i < few.count_; ++i) {
        const Face& face = few.faces_[i];
        const EightVectors ap{points.x - face.a[0], points.y - face.a[1], points.z - face.a[2]};
        Eight squared;
        squared_distance_to_triangle(face.ab, face.ac, ap, squared);
        const EightInts better = squared < nearest.squared_distance;
        choose(better, squared, nearest.squared_distance, nearest.squared_distance);
        choose(better, EightInts{} + face.label, nearest.label, nearest.label);
    }
}

void FewFaces::find_nearest(const PointPacket& packet, Nearest& nearest) const {
    Kernel::run(*this, packet.points, nearest);
}

}  // namespace neuralmesh
