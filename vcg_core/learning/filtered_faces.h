// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The faces of a noisy mesh with smoothed normals.
#pragma once

#include <vcg/space/point3.h>

#include "vcg_core/base/span.h"
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
    /// The same with the vertices where they are.
    FilteredFaces(const Network& network, ThreadTeam& team);

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

/// Weight of a normal whose squared difference from another is \p d: 1 at 0, falling with d / \p width. A
/// rational stand-in for exp(-d / width), whose bits differ between mathematical libraries.
inline float similarity(float d, float width) {
    const float x = 1 + d / width;
    return 1 / (x * x);
}

}  // namespace neuralmesh
