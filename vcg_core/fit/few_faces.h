// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The faces that a collapse or a flip would make, and which of them is nearest to each of eight points.
#pragma once

#include <array>
#include <cstddef>

#include "vcg_core/base/simd.h"
#include "vcg_core/mesh/ring.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// Eight points of a list, the last ones perhaps fewer.
struct PointPacket {
    static constexpr std::size_t kPoints = 8;
    void set(std::size_t lane, const Vector3& p) {
        points.x[lane] = p[0];
        points.y[lane] = p[1];
        points.z[lane] = p[2];
    }
    EightVectors points{};
};

/// At most as many faces as a vertex may have.
class FewFaces {
public:
    /// The nearest face of each of eight points.
    struct Nearest {
        Eight squared_distance;  ///< with the bits of foot_on_triangle()
        EightInts label;         ///< of the face added first among those at that distance
    };

    void add(const Vector3& a, const Vector3& b, const Vector3& c, int label) {
        faces_[count_++] = {a, b - a, c - a, label};
    }
    /// Without a face the distances are the largest float. O(faces).
    void find_nearest(const PointPacket& packet, Nearest& nearest) const;

private:
    struct Face {
        Vector3 a, ab, ac;
        int label;
    };
    struct Kernel;

    std::array<Face, Ring::kMaxValence> faces_;
    std::size_t count_ = 0;
};

}  // namespace neuralmesh
