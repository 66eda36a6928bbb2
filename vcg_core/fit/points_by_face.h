// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The points of a fit: which face each belongs to, and what they tell of the noise.
#pragma once

#include <algorithm>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/fit/least_squares.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// Points and for each where it was last found.
struct TrackedPoints {
    std::vector<Vector3> points;
    std::vector<WalkStart> near;
    std::vector<Vector3> directions;  ///< along which to measure; only of the points held back
};

struct Split {
    TrackedPoints fitted;
    TrackedPoints held;
};

/// The points to fit to and some held back to judge by: \p wanted points of \p target, all of a cloud or a
/// random choice; of faces at most 2 million or a tenth of those wanted, whichever is more. One in eight is
/// held back, but at most 10,000.
Split choose_points(const TargetSpace& target, std::size_t wanted, Random& random);

/// The nearest faces of the points, exactly. O(points log faces)
std::vector<Hit> exact_hits(const Surface& surface, const TrackedPoints& followed, ThreadTeam& team);
/// The nearest faces of the points by walks from where they were last found. O(points)
std::vector<Hit> walked_hits(const Surface& surface, const TrackedPoints& followed, ThreadTeam& team);

/// Ties the points to the faces hit. Sorts them by their faces, which also brings neighbours together in
/// memory, and notes where they are. Directions are not carried along.
PointsByFace by_face(const Surface& surface, TrackedPoints& followed, const std::vector<Hit>& hits);

/// Variance of the noise: the median over the faces of that of their points about a plane parallel to the
/// face. What neighbouring points share is misfit, what they do not share is noise.
float noise_variance(const Surface& surface, const PointsByFace& points);

/// How many points belong to the surface and how many are missing from it.
class Support {
public:
    /// Takes the density of the points around every vertex from some rings. O(vertices)
    Support(const Network& network, const Surface& surface, const PointsByFace& points);

    /// How many points a face should have more to be believed: webs and spikes are surface without points.
    /// \param twice_area of the face \param points those it has
    float missing(const Triangle& face, float twice_area, float points) const {
        const float density = density_[index(face[0])] + density_[index(face[1])] + density_[index(face[2])];
        return std::max(0.0F, kShare / 3 * density * twice_area - points - kPseudoPoints);
    }
    /// What one missing point counts, as a squared distance: the backward error of a face.
    float value() const { return value_; }

private:
    static constexpr float kShare = 0.3F;      ///< of the points that its area should have, a face needs ...
    static constexpr float kPseudoPoints = 2;  ///< ... but for so many

    std::vector<float> density_;  ///< by slot, of points per twice the area
    float value_ = 0;
};

/// Normals of the vertices, averaged over their rings twice: what noise leaves of them.
std::vector<Vector3> smoothed_normals(const Network& network, const Surface& surface);

float median(std::vector<float> values);
float mean_edge(const Surface& surface);

}  // namespace neuralmesh
