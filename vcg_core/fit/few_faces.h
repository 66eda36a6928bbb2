// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The faces that a collapse or a flip would make, and which of them is nearest to a point.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "vcg_core/mesh/ring.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// At most as many faces as a vertex may have.
class FewFaces {
public:
    struct Nearest {
        float squared_distance = std::numeric_limits<float>::max();
        int label = 0;  ///< of the face added first among those at that distance
    };

    void add(const Vector3& a, const Vector3& b, const Vector3& c, int label) {
        faces_[count_++] = {a, b - a, c - a, label};
    }
    /// O(faces).
    Nearest nearest_to(const Vector3& p) const {
        Nearest nearest;
        for (std::size_t i = 0; i < count_; ++i) {
            const Face& face = faces_[i];
            const float squared = foot_on_triangle(face.ab, face.ac, p - face.a).squared_distance;
            if (squared < nearest.squared_distance) nearest = {squared, face.label};
        }
        return nearest;
    }

private:
    struct Face {
        Vector3 a, ab, ac;
        int label;
    };

    std::array<Face, Ring::kMaxValence> faces_;
    std::size_t count_ = 0;
};

}  // namespace neuralmesh
