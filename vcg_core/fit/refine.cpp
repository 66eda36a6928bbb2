// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/refine.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vcg_core/fit/redistribute.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

namespace {

/// A pass splits edges longer than this share of the longest one.
constexpr float kLong = 0.7F;
/// Shorter edges, as a share of the longest one, are not split.
constexpr float kShortest = 0.01F;

/// The middle of the cubic curve from \p p to \p q that starts and ends at right angles to the unit normals
/// there (the edges of the PN triangles of Vlachos et al. 2001). The middle of the edge itself where that
/// would be a crease: where the sine of the angle between edge and tangent plane is above \p steepest.
Vector3 middle_of_curve(const Vector3& p, const Vector3& n_p, const Vector3& q, const Vector3& n_q,
                        float steepest) {
    const Vector3 middle = 0.5F * (p + q);
    const Vector3 edge = q - p;
    const float steep = steepest * edge.norm();
    const float at_p = edge.dot(n_p);
    const float at_q = edge.dot(n_q);
    if (std::abs(at_p) > steep || std::abs(at_q) > steep) return middle;
    return middle + (at_q * n_q - at_p * n_p) / 8;
}

/// For middle_of_curve(). A learned mesh has many vertices where the surface bends. Between points alone, the
/// long edges of a box of 1 x 2 x 3 would bulge by 4 % of its volume with .35.
float steepest(NewVertices where) { return where == NewVertices::curved ? 0.5F : 0.25F; }

PerVertex<Vector3> vertex_normals(const Network& network) {
    const Surface surface(network);
    PerVertex<Vector3> normals(network.slot_count(), Vector3::Zero());
    for (int f = 0; f < surface.face_count(); ++f)
        for (const VertexId v : surface.faces[f]) normals[v] += unit_normal(surface, f);
    for (Vector3& n : normals) n.normalize();
    return normals;
}

/// The edges that have \p at_least this share of the longest one's length, as splits in the
/// middle, the longest first. The gain is the squared length.
std::vector<EdgeSplit> splits_of_edges(const Network& network, NewVertices where, float at_least) {
    const PerVertex<Vector3> normals = vertex_normals(network);
    std::vector<EdgeSplit> splits;
    float longest = 0;
    for (const VertexId a : network.vertices()) {
        const Ring& ring = network.ring(a);
        for (int i = 0; i < ring.valence; ++i) {
            if (ring[i] < a) continue;
            const Vector3 p = to_eigen(network.position(a));
            const Vector3 q = to_eigen(network.position(ring[i]));
            const Vector3 middle = where == NewVertices::on_edges
                                       ? Vector3(0.5F * (p + q))
                                       : middle_of_curve(p, normals[a], q, normals[ring[i]], steepest(where));
            splits.push_back({(p - q).squaredNorm(), a, ring[i], middle});
            longest = std::max(longest, splits.back().gain);
        }
    }
    const auto is_short = [&](const EdgeSplit& split) { return split.gain < at_least * at_least * longest; };
    splits.erase(std::remove_if(splits.begin(), splits.end(), is_short), splits.end());
    std::stable_sort(splits.begin(), splits.end(),
                     [](const EdgeSplit& x, const EdgeSplit& y) { return x.gain > y.gain; });
    return splits;
}

}  // namespace

int refine(Network& network, int vertices, NewVertices where, Progress& progress) {
    const int before = network.vertex_count();
    while (network.vertex_count() < vertices) {
        const double done_share = static_cast<double>(network.vertex_count()) / vertices;
        if (!progress(done_share, "Fitting to the points: more vertices")) break;
        const int missing = vertices - network.vertex_count();
        int done = 0;
        // The ends of the longest edges may have as many neighbours as a vertex can: then shorter ones.
        for (float share = kLong; done == 0 && share > kShortest; share *= kLong)
            done = insert(network, splits_of_edges(network, where, share), missing);
        if (done == 0) break;
    }
    return network.vertex_count() - before;
}

}  // namespace neuralmesh
