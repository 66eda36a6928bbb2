// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The two planes that meet at a crease, of the faces of a noisy mesh with smoothed normals.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// Faces whose unit normals are smoothed by a bilateral filter, which keeps creases (Zheng et al., "Bilateral
/// normal filtering for mesh denoising", 2011). The width of the filter follows the median angle between
/// adjacent faces, hence the noise.
class FilteredFaces {
public:
    /// The faces of \p network with its vertices at \p positions. O(vertices).
    FilteredFaces(const Network& network, const PerVertex<vcg::Point3f>& positions, ThreadTeam& team);

    int count() const { return surface_.face_count(); }
    /// As Surface::faces_around().
    Span<const int> around(VertexId v) const { return surface_.faces_around(v); }
    bool has_corner(int f, VertexId v) const {
        const Triangle& face = surface_.faces[f];
        return face[0] == v || face[1] == v || face[2] == v;
    }
    const vcg::Point3f& normal(int f) const { return normals_[f]; }
    const vcg::Point3f& centre(int f) const { return centres_[f]; }
    float area(int f) const { return areas_[f]; }

private:
    void filter(ThreadTeam& team);
    vcg::Point3f filtered_normal(int f, float width) const;
    float median_difference(ThreadTeam& team) const;

    Surface surface_;  ///< for its faces only
    PerFace<vcg::Point3f> normals_;
    PerFace<vcg::Point3f> centres_;
    PerFace<float> areas_;
};

/// n / |n|; 0 for 0.
inline vcg::Point3f unit_or_zero(const vcg::Point3f& n) {
    const float length = n.Norm();
    return length > 0 ? n / length : vcg::Point3f(0, 0, 0);
}

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
