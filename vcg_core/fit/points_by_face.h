// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The points that a fit uses, and the face of the surface that each is nearest to.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/random.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// Points, and for each the place where its nearest face was found last: the next search starts there.
struct TrackedPoints {
    std::vector<Vector3> points;
    std::vector<float> weights;       ///< the area that each stands for; empty: all 1
    std::vector<WalkStart> last_hit;  ///< empty before the first search
};

/// The nearest faces of the points, exact. O(points x log faces).
std::vector<Hit> nearest_by_tree(const Surface& surface, const TrackedPoints& tracked, ThreadTeam& team);
/// The nearest faces that walks from the last hits find. Expected O(points).
std::vector<Hit> nearest_by_walk(const Surface& surface, const TrackedPoints& tracked, ThreadTeam& team);

/// The points assigned to each face.
class PointsByFace {
public:
    struct Assignment {
        Vector3 point;
        float influence;  ///< weight of the point: that of TrackedPoints, less for outliers
        Foot foot;        ///< on the face
    };

    /// \p hits has one entry for each of the \p points. O(points + faces).
    PointsByFace(const Surface& surface, const TrackedPoints& points, const std::vector<Hit>& hits);

    /// The points of \p face, in the order in which they were given.
    Span<const Assignment> of(int face) const {
        return {assignments_.data() + first_[face], assignments_.data() + first_[face + 1]};
    }
    Span<Assignment> of(int face) {
        return {assignments_.data() + first_[face], assignments_.data() + first_[face + 1]};
    }
    /// The numbers of points of the faces.
    PerFace<float> counts() const;
    /// The points of all faces, face by face.
    std::vector<Assignment>& all() { return assignments_; }
    /// Number of points for each of \p vertices vertices.
    float per_vertex(int vertices) const {
        return static_cast<float>(assignments_.size()) / static_cast<float>(vertices);
    }

    /// The sum of the influences of the points of \p face, or their number if the points have no weights.
    float weight(int face) const;
    /// The mean weight of the points of two faces, 1 if there are none.
    float mean_weight(int f, int g) const;

    /// Computes the feet again after the vertices have moved; every point keeps its face.
    void update_feet(const Surface& surface, ThreadTeam& team);

private:
    std::vector<Assignment> assignments_;
    bool weighted_;
    PerFace<int> first_;  ///< where those of a face begin; one more entry at the end
};

/// Assigns the \p tracked points to the faces hit. Reorders them by face, so that points near in space come
/// near in memory, and records the hits.
PointsByFace group_by_face(const Surface& surface, TrackedPoints& tracked, const std::vector<Hit>& hits,
                           ThreadTeam& team);

struct PointChoice {
    TrackedPoints fitted;    ///< in random order
    TrackedPoints held_out;  ///< no part of the fit; they measure its error
};

/// Chooses \p wanted points of \p target at random: of a cloud without repetition, at most all of them; of
/// faces at most 2 million or a tenth of \p wanted, whichever is more. One in eight is held out, at most
/// 10,000. Of a weighted cloud, points are chosen evenly over the surface, and the weights of the others make
/// up for those that are too few; their number is then about \p wanted. O(points of the cloud + wanted).
PointChoice choose_points(const TargetSpace& target, std::size_t wanted, Random& random);

}  // namespace neuralmesh
