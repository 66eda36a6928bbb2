// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Hashed uniform grid with singly linked lists through the network's slots.
#include "winner_search.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace neuralmesh {

namespace {

/// Cell edge in mean edge lengths of the network, by measurement.
constexpr float kCellEdge = 1.0F;
/// Float rounding of a cell border, in cells, generously.
constexpr float kRounding = 1e-3F;
/// A box of more cells than this is dearer than looking at every vertex of a small network.
constexpr int kMostCells = 1000;

/// Squared distance and vertex in one number that orders by distance, then by id: the bits of a non-negative
/// float order like the float.
using Candidate = std::uint64_t;
constexpr Candidate kNobody = Candidate{0x7f800000} << 32 | 0xffffffff;

Candidate candidate(const Slot& slot, VertexId v, const vcg::Point3f& s) {
    const float x = slot.x - s[0];
    const float y = slot.y - s[1];
    const float z = slot.z - s[2];
    const float squared_distance = x * x + y * y + z * z;
    std::uint32_t bits = 0;
    std::memcpy(&bits, &squared_distance, sizeof bits);
    return Candidate{bits} << 32 | static_cast<std::uint32_t>(v);
}

float squared_distance_of(Candidate c) {
    const auto bits = static_cast<std::uint32_t>(c >> 32);
    float d = 0;
    std::memcpy(&d, &bits, sizeof d);
    return d;
}

VertexId vertex_of(Candidate c) { return static_cast<VertexId>(c & 0xffffffff); }

/// Mean edge length, from every vertex's first edge.
float mean_edge_length(const Network& network) {
    double sum = 0;
    int count = 0;
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.alive(v)) continue;
        sum += static_cast<double>((network.position(v) - network.position(network.ring(v)[0])).Norm());
        ++count;
    }
    return count == 0 ? 0.0F : static_cast<float>(sum / count);
}

}  // namespace

WinnerSearch::WinnerSearch(Network& network) : network_(network) { lay_out(); }

void WinnerSearch::keep_up() {
    const int n = network_.vertex_count();
    if (n > 2 * laid_out_for_ || 3 * n < laid_out_for_) lay_out();
}

void WinnerSearch::lay_out() {
    laid_out_for_ = network_.vertex_count();
    // Below 1e-5 of the diagonal a cell coordinate would no longer be exact in float.
    edge_ = std::max(kCellEdge * mean_edge_length(network_), 1e-5F);
    inverse_edge_ = 1 / edge_;
    std::size_t lines = 2;
    line_shift_ = 31;
    while (16 * lines < 4 * static_cast<std::size_t>(laid_out_for_)) {
        lines *= 2;
        --line_shift_;
    }
    heads_.assign(16 * lines, -1);
    for (VertexId v = 0; v < network_.slot_count(); ++v)
        if (network_.alive(v)) add(v);
}

void WinnerSearch::link(VertexId v, std::size_t bucket) {
    network_.slots()[v].next_in_cell = heads_[bucket];
    heads_[bucket] = v;
}

void WinnerSearch::unlink(VertexId v, std::size_t bucket) {
    Slot* slots = network_.slots();
    VertexId* link = &heads_[bucket];
    while (*link != v) link = &slots[*link].next_in_cell;
    *link = slots[v].next_in_cell;
}

void WinnerSearch::add(VertexId v) { link(v, bucket_of(cell_of(load_xyz(&network_.slots()[v])))); }

void WinnerSearch::remove(VertexId v) { unlink(v, bucket_of(cell_of(load_xyz(&network_.slots()[v])))); }

void WinnerSearch::relink(VertexId v, std::size_t from, std::size_t to) {
    unlink(v, from);
    link(v, to);
}

void WinnerSearch::prefetch(const vcg::Point3f& s) const {
    const float half = 0.5F * edge_;
    const FourInts low = cell_of(s - vcg::Point3f(half, half, half));
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y) __builtin_prefetch(&heads_[bucket_of(low[0], low[1] + y, low[2] + z)]);
}

/// The 2 x 2 x 2 cells nearest to s, which reach at least half a cell's edge in all directions. The lists are
/// walked abreast and without a branch per vertex: which cells are empty is unpredictable.
std::uint64_t WinnerSearch::scan_nearest_cells(const vcg::Point3f& s) const {
    const Slot* slots = network_.slots();
    const float half = 0.5F * edge_;
    const FourInts low = cell_of(s - vcg::Point3f(half, half, half));
    VertexId lists[8];
    int open = 0;
    for (int i = 0; i < 8; ++i) {
        lists[open] = heads_[bucket_of(low[0] + (i & 1), low[1] + (i >> 1 & 1), low[2] + (i >> 2))];
        open += lists[open] >= 0 ? 1 : 0;
    }
    Candidate best = kNobody;
    while (open > 0) {
        int still_open = 0;
        for (int i = 0; i < open; ++i) {
            const VertexId v = lists[i];
            best = std::min(best, candidate(slots[v], v, s));
            lists[still_open] = slots[v].next_in_cell;
            still_open += lists[still_open] >= 0 ? 1 : 0;
        }
        open = still_open;
    }
    return best;
}

std::uint64_t WinnerSearch::scan_box(const vcg::Point3f& s, float reach) const {
    const Slot* slots = network_.slots();
    const FourInts low = cell_of(s - vcg::Point3f(reach, reach, reach));
    const FourInts high = cell_of(s + vcg::Point3f(reach, reach, reach));
    Candidate best = kNobody;
    for (std::int32_t z = low[2]; z <= high[2]; ++z)
        for (std::int32_t y = low[1]; y <= high[1]; ++y)
            for (std::int32_t x = low[0]; x <= high[0]; ++x)
                for (VertexId v = heads_[bucket_of(x, y, z)]; v >= 0; v = slots[v].next_in_cell)
                    best = std::min(best, candidate(slots[v], v, s));
    return best;
}

std::uint64_t WinnerSearch::scan_all(const vcg::Point3f& s) const {
    const Slot* slots = network_.slots();
    Candidate best = kNobody;
    for (VertexId v = 0; v < network_.slot_count(); ++v)
        if (network_.alive(v)) best = std::min(best, candidate(slots[v], v, s));
    return best;
}

VertexId WinnerSearch::winner(const vcg::Point3f& s) const {
    Candidate best = scan_nearest_cells(s);
    const float sure = (0.5F - kRounding) * edge_;
    if (squared_distance_of(best) < sure * sure) return vertex_of(best);
    // Anybody at all gives a radius that holds the winner.
    if (best == kNobody) best = scan_box(s, 2 * edge_);
    const float reach = std::sqrt(squared_distance_of(best)) + kRounding * edge_;
    const float across = 2 * reach * inverse_edge_ + 2;
    const bool box_is_small =
        across < 5 ||
        across * across * across < static_cast<float>(std::min(network_.slot_count(), kMostCells));
    return vertex_of(box_is_small ? scan_box(s, reach) : scan_all(s));
}

}  // namespace neuralmesh
