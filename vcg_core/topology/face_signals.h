// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What the points say about every face: how many are nearest to it, and how many it should have for its area.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/random.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// A fair sample of \p target: of a cloud without weights at most \p count points, each once, one of every
/// few that follow each other; else \p count signals. O(count).
std::vector<Vector3> fair_sample(const TargetSpace& target, std::size_t count, Random& random);

/// The support of every face of a surface.
struct FaceSignals {
    /// A signal and its squared distance from its face.
    struct Assigned {
        Vector3 point;
        float squared_distance;
    };
    std::vector<Assigned> signals;  ///< face by face
    PerFace<int> first;             ///< where those of a face begin; one more entry at the end
    PerFace<int> wins;              ///< their number
    PerFace<float> farthest;        ///< the greatest squared distance of those of a face, 0 if there is none
    PerFace<float> expected;  ///< signals that its area would win at the density of the surface around it
    PerFace<float> area;
    PerVertex<float> density;  ///< signals per area around the vertex

    /// Signals that \p face, also one that the surface does not have, of this area would win.
    float expected_on(const Triangle& face, float of_area) const {
        return of_area * (density[face[0]] + density[face[1]] + density[face[2]]) / 3;
    }
    Span<const Assigned> of(int face) const {
        return {signals.data() + first[face], signals.data() + first[face + 1]};
    }

    /// Share of the expected signals below which a face lacks support.
    static constexpr float kLeastShare = 0.1F;
    bool lacks_support(int face) const {
        return static_cast<float>(wins[face]) < kLeastShare * expected[face];
    }
    /// ln of how much likelier \p faces won as few signals as they did without support than with it; 0 if
    /// they won all that they should have.
    double lack_of(const std::vector<int>& faces) const;
};

/// Assigns every one of \p signals to its nearest face. The density around a vertex is that of the faces with
/// signals within about four rings; where none has any, that of the nearest vertices with a density. So a
/// membrane does not lower the density that it is measured by, however wide it is. The result does not depend
/// on the number of threads. O(signals x log faces + rings of the widest membrane x faces).
FaceSignals face_signals(const Network& network, const Surface& surface, const std::vector<Vector3>& signals,
                         ThreadTeam& team);

}  // namespace neuralmesh
