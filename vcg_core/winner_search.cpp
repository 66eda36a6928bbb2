// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Hashed uniform grid with singly linked lists through the network's slots.
#include "winner_search.h"

#include <algorithm>
#include <limits>

namespace neuralmesh {

namespace {

/// Cell edge in mean edge lengths of the network: measured, flat between 0.8 and 1.3.
constexpr float kCellEdge = 1.0F;
/// Float rounding of a cell border, in cells, generously.
constexpr float kRounding = 1e-3F;
/// A box of more cells than this is dearer than looking at every vertex of a small network.
constexpr int kMostCells = 1000;

float squared_distance(const Slot& a, const vcg::Point3f& s) {
    const float x = a.x - s[0];
    const float y = a.y - s[1];
    const float z = a.z - s[2];
    return x * x + y * y + z * z;
}

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
    std::size_t capacity = 64;
    hash_shift_ = 64 - 4;  // the last two bits of an index are those of x
    while (capacity < 2 * static_cast<std::size_t>(laid_out_for_)) {
        capacity *= 2;
        --hash_shift_;
    }
    cells_.assign(capacity, Cell{kEmpty, -1});
    used_cells_ = 0;
    for (VertexId v = 0; v < network_.slot_count(); ++v)
        if (network_.alive(v)) link(v, key_at(network_.slots()[v]));
}

WinnerSearch::Cell& WinnerSearch::cell_for(std::uint64_t key) {
    std::size_t i = home_of(key);
    while (cells_[i].key != key && cells_[i].key != kEmpty) i = (i + 1) & (cells_.size() - 1);
    if (cells_[i].key == kEmpty) {
        cells_[i].key = key;
        ++used_cells_;
    }
    return cells_[i];
}

VertexId WinnerSearch::head_of(std::uint64_t key) const {
    std::size_t i = home_of(key);
    while (cells_[i].key != key) {
        if (cells_[i].key == kEmpty) return -1;
        i = (i + 1) & (cells_.size() - 1);
    }
    return cells_[i].head;
}

void WinnerSearch::link(VertexId v, std::uint64_t key) {
    Cell& cell = cell_for(key);
    network_.slots()[v].next_in_cell = cell.head;
    cell.head = v;
}

void WinnerSearch::unlink(VertexId v, std::uint64_t key) {
    Slot* slots = network_.slots();
    VertexId* link = &cell_for(key).head;
    while (*link != v) link = &slots[*link].next_in_cell;
    *link = slots[v].next_in_cell;
}

void WinnerSearch::add(VertexId v) {
    link(v, key_at(network_.slots()[v]));
    // Emptied cells keep their entry until the next layout, so moves alone can fill the table.
    if (2 * used_cells_ > cells_.size()) lay_out();
}

void WinnerSearch::remove(VertexId v) { unlink(v, key_at(network_.slots()[v])); }

void WinnerSearch::move(VertexId v, const vcg::Point3f& where) {
    Slot& slot = network_.slots()[v];
    const FourInts from = cell_of(load_xyz(&slot));
    const FourInts to = cell_of(Four{where[0], where[1], where[2], 0});
    if (from[0] == to[0] && from[1] == to[1] && from[2] == to[2]) {
        network_.set_position(v, where);
        return;
    }
    unlink(v, key_of(from[0], from[1], from[2]));
    network_.set_position(v, where);
    link(v, key_of(to[0], to[1], to[2]));
    if (2 * used_cells_ > cells_.size()) lay_out();
}

void WinnerSearch::prefetch(const vcg::Point3f& s) const {
    const float half = 0.5F * edge_;
    for (const float z : {s[2] - half, s[2] + half})
        for (const float y : {s[1] - half, s[1] + half})
            __builtin_prefetch(&cells_[home_of(key_of(cell_of(s[0] - half), cell_of(y), cell_of(z)))]);
}

void WinnerSearch::scan_cell(std::int32_t x, std::int32_t y, std::int32_t z, const vcg::Point3f& s,
                             Best& best) const {
    const Slot* slots = network_.slots();
    for (VertexId v = head_of(key_of(x, y, z)); v >= 0; v = slots[v].next_in_cell) {
        const float d = squared_distance(slots[v], s);
        if (d < best.squared_distance || (d == best.squared_distance && v < best.vertex)) best = {d, v};
    }
}

void WinnerSearch::scan_box(const vcg::Point3f& s, float reach, Best& best) const {
    std::int32_t low[3];
    std::int32_t high[3];
    for (int i = 0; i < 3; ++i) {
        low[i] = cell_of(s[i] - reach);
        high[i] = cell_of(s[i] + reach);
    }
    for (std::int32_t z = low[2]; z <= high[2]; ++z)
        for (std::int32_t y = low[1]; y <= high[1]; ++y)
            for (std::int32_t x = low[0]; x <= high[0]; ++x) scan_cell(x, y, z, s, best);
}

void WinnerSearch::scan_all(const vcg::Point3f& s, Best& best) const {
    const Slot* slots = network_.slots();
    for (VertexId v = 0; v < network_.slot_count(); ++v) {
        if (!network_.alive(v)) continue;
        const float d = squared_distance(slots[v], s);
        if (d < best.squared_distance) best = {d, v};
    }
}

VertexId WinnerSearch::winner(const vcg::Point3f& s) const {
    Best best{std::numeric_limits<float>::infinity(), -1};
    // Half a cell each way: the 2 x 2 x 2 cells nearest to s, which settle most signals.
    const float sure = (0.5F - kRounding) * edge_;
    scan_box(s, 0.5F * edge_, best);
    if (best.squared_distance < sure * sure) return best.vertex;
    if (best.vertex < 0) scan_box(s, 2 * edge_, best);
    const float reach = best.vertex < 0 ? std::numeric_limits<float>::infinity()
                                        : std::sqrt(best.squared_distance) + kRounding * edge_;
    const float cells_across = 2 * reach * inverse_edge_ + 2;
    if (cells_across * cells_across * cells_across < static_cast<float>(std::min(network_.slot_count(), kMostCells)) ||
        cells_across < 5) {
        scan_box(s, reach, best);
    } else {
        best = {std::numeric_limits<float>::infinity(), -1};
        scan_all(s, best);
    }
    return best.vertex;
}

}  // namespace neuralmesh
