// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Collapses, then flips and smoothing.
#include "vcg_core/mesh/simplify.h"

#include <algorithm>
#include <iterator>
#include <queue>
#include <utility>

#include "vcg_core/mesh/valence_flips.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

constexpr int kHighestValence = 12;

Point3f normal_of(const Point3f& a, const Point3f& b, const Point3f& c) { return (b - a) ^ (c - a); }

/// Would moving \p v to \p where turn over a face at v that does not contain \p except, or make it a sliver?
bool folds(const Network& net, VertexId v, const Point3f& where, VertexId except) {
    const Ring& ring = net.ring(v);
    for (int i = 0; i < ring.valence; ++i) {
        const VertexId a = ring[i], b = ring.next(i);
        if (a == except || b == except) continue;
        const Point3f pa = net.position(a), pb = net.position(b);
        const Point3f before = normal_of(net.position(v), pa, pb), after = normal_of(where, pa, pb);
        const float product = before * after;
        if (product <= 0 || product * product < 0.1F * before.SquaredNorm() * after.SquaredNorm())
            return true;
    }
    return false;
}

/// A half-edge collapse that waits for its turn.
struct Candidate {
    float squared_length;
    VertexId gone, kept;

    /// The shortest comes first; ties are broken by ids, so that the order never depends on the heap.
    bool operator<(const Candidate& other) const {
        if (squared_length != other.squared_length) return squared_length > other.squared_length;
        return std::pair(gone, kept) > std::pair(other.gone, other.kept);
    }
};

using Queue = std::priority_queue<Candidate>;

void push_edges_of(const Network& net, VertexId v, Queue& queue) {
    const Ring& ring = net.ring(v);
    for (int i = 0; i < ring.valence; ++i) {
        const float length = (net.position(v) - net.position(ring[i])).SquaredNorm();
        queue.push({length, v, ring[i]});
        queue.push({length, ring[i], v});
    }
}

bool result_valence_fits(const Network& net, VertexId gone, VertexId kept) {
    return net.ring(gone).valence + net.ring(kept).valence - 4 <= kHighestValence - 2;
}

bool may_collapse(const Network& net, VertexId gone, VertexId kept, bool careful) {
    return result_valence_fits(net, gone, kept) && net.can_collapse(gone, kept) &&
           !(careful && folds(net, gone, net.position(kept), kept));
}

/// Sweeps over the vertices, each time collapsing what is shorter than a growing bound: the quick way to a
/// mesh of at least \p vertices from one of many more. O(vertices) per sweep.
void collapse_in_sweeps(Network& net, int vertices, float squared_bound) {
    constexpr int kSweeps = 24;
    for (int sweep = 0; sweep < kSweeps && net.vertex_count() > vertices; ++sweep, squared_bound *= 1.5F)
        for (VertexId v = 0; v < net.slot_count() && net.vertex_count() > vertices; ++v) {
            if (!net.alive(v)) continue;
            const Ring& ring = net.ring(v);
            for (int i = 0; i < ring.valence; ++i) {
                if ((net.position(v) - net.position(ring[i])).SquaredNorm() > squared_bound) continue;
                if (!may_collapse(net, v, ring[i], true)) continue;
                net.collapse(v, ring[i]);
                break;
            }
        }
}

float mean_squared_length(const Network& net) {
    double sum = 0, count = 0;
    for (VertexId v = 0; v < net.slot_count(); ++v)
        for (int i = 0; i < net.ring(v).valence; ++i, ++count)
            sum += static_cast<double>((net.position(v) - net.position(net.ring(v)[i])).SquaredNorm());
    return static_cast<float>(sum / count);
}

/// Collapses in order of length. \p careful: no face may turn over.
void collapse_to(Network& net, int vertices, bool careful) {
    Queue queue;
    for (VertexId v = 0; v < net.slot_count(); ++v) {
        if (!net.alive(v)) continue;
        const Ring& ring = net.ring(v);
        for (int i = 0; i < ring.valence; ++i)
            queue.push({(net.position(v) - net.position(ring[i])).SquaredNorm(), v, ring[i]});
    }
    while (net.vertex_count() > vertices && !queue.empty()) {
        const auto [length, gone, kept] = queue.top();
        queue.pop();
        if (!net.alive(gone) || !net.adjacent(gone, kept)) continue;
        if (!may_collapse(net, gone, kept, careful)) continue;
        net.collapse(gone, kept);
        push_edges_of(net, kept, queue);
    }
}

/// True if both new faces lie within 45 degrees of the mean, weighted by area, of the old ones.
bool is_flat(const FlipNormals& normals) {
    const Point3f n = normals.before[0] + normals.before[1];
    return std::all_of(std::begin(normals.after), std::end(normals.after), [&](const Point3f& m) {
        const float product = m * n;
        return product > 0 && product * product > 0.5F * m.SquaredNorm() * n.SquaredNorm();
    });
}

void flip_for_valence(Network& net) { flip_edges_for_valence(net, {is_flat, kHighestValence}); }

/// Moves every vertex halfway to the mean of its neighbours, along the surface.
void smooth_tangentially(Network& net) {
    for (VertexId v = 0; v < net.slot_count(); ++v) {
        if (!net.alive(v)) continue;
        const Ring& ring = net.ring(v);
        const Point3f p = net.position(v);
        Point3f mean(0, 0, 0), normal(0, 0, 0);
        for (int i = 0; i < ring.valence; ++i) {
            mean += net.position(ring[i]);
            normal += normal_of(p, net.position(ring[i]), net.position(ring.next(i)));
        }
        const float squared = normal.SquaredNorm();
        if (!(squared > 0)) continue;
        Point3f move = mean / static_cast<float>(ring.valence) - p;
        move -= normal * (move * normal / squared);
        const Point3f where = p + move * 0.5F;
        if (!folds(net, v, where, -1)) net.set_position(v, where);
    }
}

}  // namespace

void simplify(Network& network, int vertices) {
    constexpr int kRounds = 3, kSweepAbove = 6;
    if (network.vertex_count() > kSweepAbove * vertices) {
        collapse_in_sweeps(network, kSweepAbove * vertices, 0.5F * mean_squared_length(network));
        flip_for_valence(network);
        smooth_tangentially(network);
    }
    for (int i = 0; i < kRounds && network.vertex_count() > vertices; ++i) {
        // Evening makes room for collapses that would have folded something.
        collapse_to(network, vertices, true);
        flip_for_valence(network);
        smooth_tangentially(network);
    }
    if (network.vertex_count() > vertices) collapse_to(network, vertices, false);
    for (int i = 0; i < kRounds; ++i) {
        flip_for_valence(network);
        smooth_tangentially(network);
    }
}

}  // namespace neuralmesh
