// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/simplify.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "vcg_core/base/lazy_priority_queue.h"
#include "vcg_core/mesh/flips.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Collapses leave this much below kHighestValence for flips and further collapses.
constexpr int kSpareValence = 2;

/// A network with the lengths that its edges are wanted to have, by vertex.
struct Scaled {
    Network& net;
    PerVertex<float> inverse_squared;  ///< of the wanted lengths; empty: all are 1

    /// Of an edge, over what is wanted at its end with the shorter wanted length.
    float squared_length(VertexId a, VertexId b) const {
        const float squared = (net.position(a) - net.position(b)).SquaredNorm();
        return inverse_squared.empty() ? squared : squared * std::max(inverse_squared[a], inverse_squared[b]);
    }
};

/// True if moving \p v to \p where turns the normal of a face at v by more than about 72 degrees. Ignores the
/// faces at \p except (-1: none).
bool folds(const Network& net, VertexId v, const Point3f& where, VertexId except) {
    constexpr float kSquaredCosine = 0.1F;  // of that angle
    const Ring& ring = net.ring(v);
    for (int i = 0; i < ring.face_count(); ++i) {
        const VertexId a = ring[i];
        const VertexId b = ring.next(i);
        if (a == except || b == except) continue;
        const Point3f before = area_vector(net.position(v), net.position(a), net.position(b));
        const Point3f after = area_vector(where, net.position(a), net.position(b));
        const float product = before * after;
        if (product <= 0 || product * product < kSquaredCosine * before.SquaredNorm() * after.SquaredNorm())
            return true;
    }
    return false;
}

bool may_collapse(const Network& net, VertexId gone, VertexId kept, bool careful) {
    return net.ring(gone).valence + net.ring(kept).valence - 4 <= kHighestValence - kSpareValence &&
           net.can_collapse(gone, kept) && !(careful && folds(net, gone, net.position(kept), kept));
}

/// Collapses \p v along its first edge that is not longer than the bound and may go.
void collapse_short_edge(const Scaled& scaled, VertexId v, float squared_bound) {
    Network& net = scaled.net;
    for (const VertexId w : net.ring(v)) {
        if (scaled.squared_length(v, w) > squared_bound || !may_collapse(net, v, w, true)) continue;
        net.collapse(v, w);
        return;
    }
}

/// Quickly reduces a mesh of many more than \p vertices vertices, to no fewer than that. Every sweep over the
/// vertices collapses edges shorter than a bound that grows from sweep to sweep. O(n) per sweep.
void collapse_in_sweeps(const Scaled& scaled, int vertices, float squared_bound) {
    constexpr float kGrowth = 1.5F;  // of the squared lengths
    constexpr int kSweeps = 24;      // then the bound is 130 times as long as at first
    for (int sweep = 0; sweep < kSweeps; ++sweep, squared_bound *= kGrowth)
        for (const VertexId v : scaled.net.vertices()) {
            if (scaled.net.vertex_count() <= vertices) return;
            collapse_short_edge(scaled, v, squared_bound);
        }
}

float mean_squared_length(const Scaled& scaled) {
    double sum = 0;
    double count = 0;
    for (const VertexId v : scaled.net.vertices())
        for (const VertexId w : scaled.net.ring(v)) {
            sum += static_cast<double>(scaled.squared_length(v, w));
            ++count;
        }
    return static_cast<float>(sum / count);
}

struct HalfEdge {
    float squared_length;
    VertexId gone, kept;  ///< by its collapse

    bool operator<(const HalfEdge& other) const {
        return std::tie(squared_length, gone, kept) < std::tie(other.squared_length, other.gone, other.kept);
    }
};

/// Collapses edges in the order of their lengths. \p careful: none that would fold the surface.
void collapse_to(const Scaled& scaled, int vertices, bool careful) {
    Network& net = scaled.net;
    LazyPriorityQueue<HalfEdge> queue;
    const auto push = [&](VertexId a, VertexId b) { queue.push({scaled.squared_length(a, b), a, b}); };
    for (const VertexId v : net.vertices())
        for (const VertexId w : net.ring(v)) push(v, w);
    const auto exists = [&](const HalfEdge& e) { return net.alive(e.gone) && net.adjacent(e.gone, e.kept); };
    HalfEdge next{};
    while (net.vertex_count() > vertices && queue.pop(next, exists)) {
        if (!may_collapse(net, next.gone, next.kept, careful)) continue;
        net.collapse(next.gone, next.kept);
        for (const VertexId w : net.ring(next.kept)) {  // what spoke against their collapse may have gone
            push(next.kept, w);
            push(w, next.kept);
        }
    }
}

/// True if both new faces lie within 45 degrees of the area-weighted mean of the old ones.
bool is_flat(const FlipNormals& normals) {
    const Point3f n = normals.before[0] + normals.before[1];
    return std::all_of(std::begin(normals.after), std::end(normals.after), [&](const Point3f& m) {
        const float product = m * n;
        return product > 0 && product * product > 0.5F * m.SquaredNorm() * n.SquaredNorm();
    });
}

/// Moves every vertex halfway to the mean of its neighbours, within its tangent plane; on a boundary, to the
/// middle between its two neighbours there.
void smooth_tangentially(Network& net) {
    for (const VertexId v : net.vertices()) {
        const Ring& ring = net.ring(v);
        if (ring.open != 0) {
            const Point3f mean = (net.position(ring[0]) + net.position(ring[ring.valence - 1])) * 0.5F;
            const Point3f where = (net.position(v) + mean) * 0.5F;
            if (!folds(net, v, where, -1)) net.set_position(v, where);
            continue;
        }
        const Point3f p = net.position(v);
        Point3f mean(0, 0, 0);
        Point3f normal(0, 0, 0);
        for (int i = 0; i < ring.valence; ++i) {
            mean += net.position(ring[i]);
            normal += area_vector(p, net.position(ring[i]), net.position(ring.next(i)));
        }
        const float squared = normal.SquaredNorm();
        if (!(squared > 0)) continue;
        Point3f move = mean / static_cast<float>(ring.valence) - p;
        move -= normal * (move * normal / squared);
        const Point3f where = p + move * 0.5F;
        if (!folds(net, v, where, -1)) net.set_position(v, where);
    }
}

void make_even(Network& net) {
    flip_edges_for_valence(net, {is_flat, kHighestValence});
    smooth_tangentially(net);
}

}  // namespace

void simplify(Network& network, int vertices, const PerVertex<float>& lengths) {
    constexpr int kRounds = 3;
    constexpr int kSweepAbove = 6;  // times the wanted vertices
    Scaled scaled{network, PerVertex<float>(lengths.size(), 0)};
    for (VertexId v = 0; v < lengths.size(); ++v)
        if (network.alive(v)) scaled.inverse_squared[v] = 1 / (lengths[v] * lengths[v]);
    if (network.vertex_count() > kSweepAbove * vertices) {
        collapse_in_sweeps(scaled, kSweepAbove * vertices, 0.5F * mean_squared_length(scaled));
        make_even(network);
    }
    for (int i = 0; i < kRounds && network.vertex_count() > vertices; ++i) {
        // An even mesh allows collapses that would have folded the uneven one.
        collapse_to(scaled, vertices, true);
        make_even(network);
    }
    if (network.vertex_count() > vertices) collapse_to(scaled, vertices, false);
    for (int i = 0; i < kRounds; ++i) make_even(network);
}

}  // namespace neuralmesh
