// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/redistribute.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "vcg_core/cloud/nearest_points.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

namespace {

/// Arguments of Network::split() that split an edge.
struct SplitPlace {
    VertexId at;  ///< the end of the edge that keeps its other neighbours
    int first;    ///< ring position of the first neighbour that the new vertex takes
    int count;    ///< of them: three, the other end in the middle; two on a boundary, the other end first
};

/// From the end \p at of the edge. A fan that includes a boundary edge of \p at besides the edge to split
/// would pull the boundary to the new vertex instead of splitting the edge.
std::optional<SplitPlace> split_place_at(const Network& network, VertexId at, VertexId other) {
    const Ring& ring = network.ring(at);
    const int i = ring.find(other);
    const bool on_boundary = ring.open != 0 && i == 0;
    if (i < 0 || (ring.open != 0 && !on_boundary && (i < 2 || i + 2 >= ring.valence))) return std::nullopt;
    const int previous = i == 0 ? ring.valence - 1 : i - 1;
    const SplitPlace place{at, on_boundary ? 0 : previous, on_boundary ? 2 : 3};
    return network.can_split(at, place.first, place.count) ? std::optional(place) : std::nullopt;
}

/// Nothing if the edge cannot be split.
std::optional<SplitPlace> split_place(const Network& network, const EdgeSplit& split) {
    const std::optional<SplitPlace> place = split_place_at(network, split.a, split.b);
    return place || network.ring(split.a).open == 0 ? place : split_place_at(network, split.b, split.a);
}

/// Carries out the collapse if it touches no \p touched vertex. \return whether it did
bool collapse_untouched(Network& network, const Collapse& collapse, PerVertex<char>& touched) {
    const Ring ring = network.ring(collapse.gone);
    const auto is_touched = [&](VertexId v) { return touched[v] != 0; };
    if (is_touched(collapse.gone) || std::any_of(ring.begin(), ring.end(), is_touched) ||
        !network.can_collapse(collapse.gone, collapse.into))
        return false;
    touched[collapse.gone] = 1;
    for (VertexId u : ring) touched[u] = 1;
    network.collapse(collapse.gone, collapse.into);
    return true;
}

/// Whether the faces around \p v and those beyond its ring are still the ones that its cost was measured on.
/// Each corner of a face that a collapse has made is \p touched: a neighbour of the vertex that went.
bool is_as_measured(const Network& network, VertexId v, const PerVertex<char>& touched) {
    if (touched[v] != 0) return false;
    const Ring& ring = network.ring(v);
    for (int i = 0; i < ring.face_count(); ++i) {
        if (touched[ring[i]] == 0 || touched[ring.next(i)] == 0) continue;
        const Ring& around = network.ring(ring[i]);
        if (touched[around.previous(around.find_existing(ring.next(i)))] != 0) return false;
    }
    return true;
}

/// The best splits that touch no \p touched vertex and not each other; marks their corners.
std::vector<EdgeSplit> choose_splits(const Network& network, const std::vector<EdgeSplit>& splits,
                                     int max_count, PerVertex<char>& touched) {
    std::vector<EdgeSplit> chosen;
    for (const EdgeSplit& split : splits) {
        if (static_cast<int>(chosen.size()) >= max_count) break;
        const Ring& ring = network.ring(split.a);
        const int i = ring.find(split.b);
        const bool on_boundary = ring.open != 0 && i == 0;
        const std::array<VertexId, 4> corners{split.a, split.b, ring.next(i),
                                              on_boundary ? ring.next(i) : ring.previous(i)};
        if (!split_place(network, split) ||
            std::any_of(corners.begin(), corners.end(), [&](VertexId v) { return touched[v] != 0; }))
            continue;
        for (VertexId v : corners) touched[v] = 1;
        chosen.push_back(split);
    }
    return chosen;
}

/// \pre the edge can be split
void carry_out(Network& network, const EdgeSplit& split) {
    const SplitPlace place = *split_place(network, split);
    network.split(place.at, place.first, place.count, to_vcg(split.position));
}

/// Carries out collapses, in their order, that touch no \p touched vertex and not each other, as long as
/// goes_on(number done, next) is true.
template <class GoesOn>
std::vector<DoneCollapse> collapse_apart(Network& network, const std::vector<Collapse>& collapses,
                                         PerVertex<char> touched, const GoesOn& goes_on) {
    std::vector<DoneCollapse> done;
    for (const Collapse& collapse : collapses) {
        if (collapse.into < 0 || !goes_on(static_cast<int>(done.size()), collapse)) break;
        if (collapse_untouched(network, collapse, touched)) done.push_back({collapse.gone, collapse.into});
    }
    return done;
}

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

std::vector<DoneCollapse> redistribute(Network& network, const std::vector<Collapse>& collapses,
                                       const std::vector<EdgeSplit>& splits, int max_pairs,
                                       const PerVertex<char>& barred) {
    // Splits are chosen first, since there are many cheap collapses but few places with large errors.
    PerVertex<char> touched = barred;
    const std::vector<EdgeSplit> chosen = choose_splits(network, splits, max_pairs, touched);
    const std::vector<DoneCollapse> done =
        collapse_apart(network, collapses, touched, [&](int count, const Collapse& next) {
            const auto i = static_cast<std::size_t>(count);
            return i < chosen.size() && next.cost < chosen[i].gain;
        });
    for (std::size_t i = 0; i < done.size(); ++i) carry_out(network, chosen[i]);
    return done;
}

int insert(Network& network, const std::vector<EdgeSplit>& splits, int max_count) {
    PerVertex<char> touched(network.slot_count(), 0);
    const std::vector<EdgeSplit> chosen = choose_splits(network, splits, max_count, touched);
    for (const EdgeSplit& split : chosen) carry_out(network, split);
    return static_cast<int>(chosen.size());
}

std::vector<DoneCollapse> reduce(Network& network, const std::vector<Collapse>& collapses, int max_count,
                                 const PerVertex<char>& barred) {
    return collapse_apart(network, collapses, barred,
                          [&](int count, const Collapse&) { return count < max_count; });
}

std::vector<DoneCollapse> reduce_densely(Network& network, const std::vector<Collapse>& collapses,
                                         int max_count, const PerVertex<char>& barred) {
    PerVertex<char> touched(network.slot_count(), 0);
    std::vector<DoneCollapse> done;
    const auto is_barred = [&](VertexId v) { return barred[v] != 0; };
    for (const Collapse& collapse : collapses) {
        if (static_cast<int>(done.size()) >= max_count || collapse.into < 0) break;
        const Ring ring = network.ring(collapse.gone);
        if (is_barred(collapse.gone) || std::any_of(ring.begin(), ring.end(), is_barred) ||
            !is_as_measured(network, collapse.gone, touched) ||
            !network.can_collapse(collapse.gone, collapse.into))
            continue;
        for (const VertexId u : ring) touched[u] = 1;
        network.collapse(collapse.gone, collapse.into);
        done.push_back({collapse.gone, collapse.into});
    }
    return done;
}

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

VertexPlaces::VertexPlaces(const Network& network) {
    for (const VertexId v : network.vertices()) {
        ids.push_back(v);
        places.push_back(network.position(v));
    }
}

PerVertex<VertexId> nearest_vertices(const VertexPlaces& before, const Network& after) {
    const NearestPoints search(before.places);
    PerVertex<VertexId> nearest(after.slot_count(), -1);
    for (const VertexId v : after.vertices())
        nearest[v] = before.ids[search.index(search.nearest_to(after.position(v)))];
    return nearest;
}

}  // namespace neuralmesh
