// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The two planes that meet at a crease.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/learning/filtered_faces.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The angle between two planes, and the distance of a point from their line of intersection.
struct Crease {
    float turn = 0;              ///< (2 sin(theta / 2))^2 = 2 - 2 cos(theta), theta the angle of the planes
    float squared_distance = 0;  ///< of the point from the line, in squared edge lengths
    vcg::Point3f to_line{0, 0, 0};  ///< from the point to the nearest one of the line
};

/// Fits two planes to the faces around a point.
class TwoPlanes {
public:
    /// Keeps references. \p faces are those of \p network.
    TwoPlanes(const Network& network, const FilteredFaces& faces)
        : network_(network), faces_(faces), visited_(faces.count(), -1) {}

    /// The crease near the point \p x, by the faces of the two-ring of the vertex \p v of the network. \p
    /// edge is the unit of the distance. The turn is 0 if all these faces have the same normal. O(k^2) for k
    /// faces.
    Crease crease_near(const vcg::Point3f& x, float edge, VertexId v);

private:
    struct Member {
        vcg::Point3f normal;
        vcg::Point3f centre;
        float weight;
    };

    void collect(const vcg::Point3f& x, VertexId v);
    void add_faces_around(VertexId v, const vcg::Point3f& x, float reach);
    bool choose_seeds(float least_cosine);
    bool refine();

    const Network& network_;
    const FilteredFaces& faces_;
    PerFace<int> visited_;  ///< the collection that visited the face last
    int collection_ = 0;
    std::vector<Member> members_;
    vcg::Point3f normals_[2];
    vcg::Point3f points_[2];  ///< one on each plane
};

/// Mean length of the edges at \p v. O(valence).
float mean_edge_at(const Network& network, VertexId v);

}  // namespace neuralmesh
