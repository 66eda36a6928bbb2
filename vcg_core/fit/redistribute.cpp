// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/redistribute.h"

#include <algorithm>
#include <array>
#include <optional>

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
        if (touched[around.previous(around.find(ring.next(i)))] != 0) return false;
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
VertexMoves::Insertion carry_out(Network& network, const EdgeSplit& split) {
    const SplitPlace place = *split_place(network, split);
    return {network.split(place.at, place.first, place.count, to_vcg(split.position)), place.at};
}

}  // namespace

VertexMoves redistribute(Network& network, const std::vector<Collapse>& collapses,
                         const std::vector<EdgeSplit>& splits, int max_pairs, const PerVertex<char>& barred) {
    // Splits are chosen first, since there are many cheap collapses but few places with large errors.
    PerVertex<char> touched = barred;
    const std::vector<EdgeSplit> chosen = choose_splits(network, splits, max_pairs, touched);
    VertexMoves result;
    for (const Collapse& collapse : collapses) {
        const std::size_t pairs = result.collapses.size();
        if (pairs >= chosen.size() || collapse.into < 0 || collapse.cost >= chosen[pairs].gain) break;
        if (collapse_untouched(network, collapse, touched))
            result.collapses.push_back({collapse.gone, collapse.into});
    }
    for (std::size_t i = 0; i < result.collapses.size(); ++i)
        result.insertions.push_back(carry_out(network, chosen[i]));
    return result;
}

int insert(Network& network, const std::vector<EdgeSplit>& splits, int max_count) {
    PerVertex<char> touched(network.slot_count(), 0);
    const std::vector<EdgeSplit> chosen = choose_splits(network, splits, max_count, touched);
    for (const EdgeSplit& split : chosen) carry_out(network, split);
    return static_cast<int>(chosen.size());
}

std::vector<VertexMoves::DoneCollapse> reduce(Network& network, const std::vector<Collapse>& collapses,
                                              int max_count, const PerVertex<char>& barred) {
    PerVertex<char> touched = barred;
    std::vector<VertexMoves::DoneCollapse> done;
    for (const Collapse& collapse : collapses) {
        if (static_cast<int>(done.size()) >= max_count || collapse.into < 0) break;
        if (collapse_untouched(network, collapse, touched)) done.push_back({collapse.gone, collapse.into});
    }
    return done;
}

std::vector<VertexMoves::DoneCollapse> reduce_densely(Network& network,
                                                      const std::vector<Collapse>& collapses, int max_count,
                                                      const PerVertex<char>& barred) {
    PerVertex<char> touched(network.slot_count(), 0);
    std::vector<VertexMoves::DoneCollapse> done;
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

}  // namespace neuralmesh
