// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/local_width.h"

#include <algorithm>

#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// The shell may be that many steps from where the nodes of the solid end: it is made on every third node.
constexpr float kSkin = 3;
/// No smaller width can be told.
constexpr float kLeastSteps = 1.5F;
constexpr int kSmoothingRounds = 2;
/// Points move by no more than this share of the radius. With 1, where they lie on the shell itself, the
/// error of a cup with walls of half an edge is 1.6 times that with 0.5 (ablation.py).
constexpr float kMostRadii = 0.5F;

Point3f star_area_vector(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    Point3f sum(0, 0, 0);
    for (int i = 0; i < ring.face_count(); ++i)
        sum += area_vector(network.position(v), network.position(ring[i]), network.position(ring.next(i)));
    return sum;
}

/// Means over the stars of the neighbours, and of theirs: marching tetrahedra leave slivers, whose own
/// normals may lie in the surface.
PerVertex<Point3f> smooth_normals(const Network& network) {
    PerVertex<Point3f> normals(network.slot_count(), Point3f(0, 0, 0));
    for (const VertexId v : network.vertices()) normals[v] = star_area_vector(network, v);
    for (int round = 0; round < kSmoothingRounds; ++round) {
        const PerVertex<Point3f> before = normals;
        for (const VertexId v : network.vertices())
            for (const VertexId w : network.ring(v)) normals[v] += before[w];
    }
    for (const VertexId v : network.vertices()) normals[v].Normalize();
    return normals;
}

/// The way from \p p along \p direction to the first node that is in \p solid, or that is not if \p inside is
/// true; \p farthest if there is none before.
float way_to_end(const Lattice& lattice, const NodeSet& solid, bool inside, const Point3f& p,
                 const Point3f& direction, float farthest) {
    for (float way = kSkin * lattice.step; way < farthest; way += Lattice::kRayStride * lattice.step) {
        const NodeId node = lattice.node_of(p + direction * way);
        const bool in_solid = node < solid.size() && solid[node] != 0;
        if (in_solid != inside) return way;
    }
    return farthest;
}

}  // namespace

LocalWidths::LocalWidths(const Network& shell, const Lattice& lattice, const NodeSet& solid, float radius,
                         float farthest)
    : radius_(radius), step_(lattice.step), behind_(shell.slot_count()), before_(shell.slot_count()) {
    const PerVertex<Point3f> normals = smooth_normals(shell);
    for (const VertexId v : shell.vertices()) {
        const Point3f& p = shell.position(v);
        behind_[v] = way_to_end(lattice, solid, true, p, -normals[v], farthest + 2 * radius);
        before_[v] = way_to_end(lattice, solid, false, p, normals[v], farthest - 2 * radius);
    }
}

float LocalWidths::width(VertexId v, float farthest) const {
    const float least = std::max(radius_, kLeastSteps * step_);
    return std::min(farthest, std::max(least, std::min(wall(v, farthest), gap(v, farthest))));
}

float LocalWidths::thickening(VertexId v, float thick) const {
    const float farthest = farthest_for(thick, radius_);
    // Moved by a quarter of the room on either side, the wall is still no wider than the gap. Thinner walls,
    // where both sides may be one, are taken for the thinnest that the lattice tells: a blade whose edges are
    // not moved has twice the error there (ablation.py).
    const float thickness = std::max(wall(v, farthest), kLeastSteps * step_);
    const float room = std::max(0.0F, std::min(gap(v, farthest), thick) - thickness);
    return std::min(kMostRadii * radius_, room / 4);
}

}  // namespace neuralmesh
