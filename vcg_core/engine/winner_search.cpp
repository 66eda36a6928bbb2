// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Singly linked lists through the vertex records of the network.
#include "vcg_core/engine/winner_search.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

namespace {

/// Cell edge in edge lengths of the network, see typical_edge_length(). By measurement.
constexpr float kCellEdge = 1.15F;
/// Bound on the float rounding of a cell border, in cells.
constexpr float kRounding = 1e-3F;
/// The same as a distance, which is larger in fine grids: within the frame, adding kOffset and multiplying by
/// the inverse edge each move a border by up to 2.5e-7, and a box has two borders.
constexpr float kLeastRounding = 1.2e-6F;
/// Of boxes around a signal, in cells: beyond, a search through all vertices is hardly slower.
constexpr float kMostReach = 4;

/// Squared distance of the network's sentinel, or more.
constexpr float kFar = 1e30F;

/// A vertex and its squared distance, in one number that orders by distance, then by id: the bits of a
/// non-negative float order like the float.
using RankedVertex = std::uint64_t;
constexpr RankedVertex kNoVertex = RankedVertex{0x7f800000} << 32 | 0xffffffff;

RankedVertex ranked(float squared_distance, VertexId v) {
    return RankedVertex{bit_cast<std::uint32_t>(squared_distance)} << 32 | static_cast<std::uint32_t>(v);
}

RankedVertex ranked(const VertexRecord& slot, VertexId v, const vcg::Point3f& s) {
    const float x = slot.x - s[0];
    const float y = slot.y - s[1];
    const float z = slot.z - s[2];
    return ranked(x * x + y * y + z * z, v);
}

float squared_distance_of(RankedVertex r) { return bit_cast<float>(static_cast<std::uint32_t>(r >> 32)); }

VertexId vertex_of(RankedVertex r) { return static_cast<VertexId>(r & 0xffffffff); }

/// Index of the list head of a cell, or of eight cells. The heads of 4 x 2 x 2 neighbouring cells share a
/// cache line.
template <class Ints>
NEURALMESH_ALWAYS_INLINE void bucket_of(const Ints& x, const Ints& y, const Ints& z, int shift,
                                        Ints& bucket) {
    const Ints hash = (x >> 2) * 0x9e3779b1u ^ (y >> 1) * 0x85ebca77u ^ (z >> 1) * 0xc2b2ae3du;
    const Ints line = (hash * 0x27d4eb2fu) >> shift;
    bucket = line << 4 | (x & 3u) | (y & 1u) << 2 | (z & 1u) << 3;
}

/// The list heads of the 2 x 2 x 2 cells from \p low on.
NEURALMESH_ALWAYS_INLINE void eight_buckets(FourInts low, int shift, EightWords& buckets) {
    const EightWords one_x = {0, 1, 0, 1, 0, 1, 0, 1};
    const EightWords one_y = {0, 0, 1, 1, 0, 0, 1, 1};
    const EightWords one_z = {0, 0, 0, 0, 1, 1, 1, 1};
    bucket_of(one_x + static_cast<std::uint32_t>(low[0]), one_y + static_cast<std::uint32_t>(low[1]),
              one_z + static_cast<std::uint32_t>(low[2]), shift, buckets);
}

/// The nearest vertex in the 2 x 2 x 2 cells from \p low on. Walks the eight lists in parallel, to the end of
/// the longest, without a branch per vertex: which cells are empty cannot be predicted.
NEURALMESH_MULTIVERSIONED RankedVertex scan_eight_cells(const VertexRecord* slots, const VertexId* heads,
                                                        int shift, FourInts low, const vcg::Point3f& s) {
    EightWords buckets;
    eight_buckets(low, shift, buckets);
    std::uint32_t b[8];
    std::memcpy(b, &buckets, sizeof b);
    EightInts ids = {heads[b[0]], heads[b[1]], heads[b[2]], heads[b[3]],
                     heads[b[4]], heads[b[5]], heads[b[6]], heads[b[7]]};
    EightInts nearest = ids;
    Eight least = Eight{} + kFar;
    std::int32_t links[8];
    std::memcpy(links, &ids, sizeof links);
    do {
        Four points[8];
        for (int i = 0; i < 8; ++i) points[i] = load_raw(&slots[links[i]]);
        EightVectors p;
        EightInts next;
        transpose(points, p, next);
        std::memcpy(links, &next, sizeof links);
        const Eight x = p.x - s[0];
        const Eight y = p.y - s[1];
        const Eight z = p.z - s[2];
        const Eight distance = x * x + y * y + z * z;
        const EightInts better = (distance < least) | ((distance == least) & (ids < nearest));
        choose(better, distance, least, least);
        choose(better, ids, nearest, nearest);
        ids = next;
    } while ((links[0] & links[1] & links[2] & links[3] & links[4] & links[5] & links[6] & links[7]) >= 0);
    float distances[8];
    std::int32_t winners[8];
    std::memcpy(distances, &least, sizeof distances);
    std::memcpy(winners, &nearest, sizeof winners);
    RankedVertex best = kNoVertex;
    for (int i = 0; i < 8; ++i) best = std::min(best, ranked(distances[i], winners[i]));
    return squared_distance_of(best) < kFar ? best : kNoVertex;
}

/// Mean length of the first edge of each vertex, weighted by its square. Signals are spread over the area, so
/// most of them fall where the edges are long. With cells for the plain mean, a ninth of the signals on a CAD
/// part would find the eight nearest cells empty. At most twice the plain mean, because a few edges across
/// the whole surface, as a landing may leave them, would give cells with thousands of vertices.
float typical_edge_length(const Network& network) {
    constexpr double kMostOverMean = 2;
    double sum = 0, squares = 0, cubes = 0;
    for (const VertexId v : network.vertices()) {
        const vcg::Point3f edge = network.position(v) - network.position(network.ring(v)[0]);
        const auto squared = static_cast<double>(edge.SquaredNorm());
        const double length = std::sqrt(squared);
        sum += length;
        squares += squared;
        cubes += squared * length;
    }
    if (!(squares > 0)) return 0;
    return static_cast<float>(std::min(cubes / squares, kMostOverMean * sum / network.vertex_count()));
}

}  // namespace

WinnerSearch::WinnerSearch(Network& network) : network_(network) { rebuild(); }

void WinnerSearch::rebuild_if_outgrown() {
    const int n = network_.vertex_count();
    if (n > 2 * built_for_ || 3 * n < built_for_) rebuild();
}

void WinnerSearch::rebuild() {
    built_for_ = network_.vertex_count();
    // With cells below 1e-5 of the diagonal, cell coordinates would not be exact in float.
    edge_ = std::max(kCellEdge * typical_edge_length(network_), 1e-5F);
    inverse_edge_ = 1 / edge_;
    std::size_t lines = 4;
    shift_ = 30;
    while (16 * lines < 4 * static_cast<std::size_t>(built_for_)) {
        lines *= 2;
        --shift_;
    }
    heads_.assign(16 * lines, -1);
    for (const VertexId v : network_.vertices()) add(v);
}

std::size_t WinnerSearch::bucket_of(std::int32_t x, std::int32_t y, std::int32_t z) const {
    std::uint32_t bucket = 0;
    neuralmesh::bucket_of(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                          static_cast<std::uint32_t>(z), shift_, bucket);
    return bucket;
}

void WinnerSearch::link(VertexId v, std::size_t bucket) {
    network_.slots()[v].link = heads_[bucket];
    heads_[bucket] = v;
}

void WinnerSearch::unlink(VertexId v, std::size_t bucket) {
    VertexRecord* slots = network_.slots();
    VertexId* link = &heads_[bucket];
    while (*link != v) link = &slots[*link].link;
    *link = slots[v].link;
}

void WinnerSearch::add(VertexId v) { link(v, bucket_of(cell_of(load_xyz(&network_.slots()[v])))); }

void WinnerSearch::remove(VertexId v) { unlink(v, bucket_of(cell_of(load_xyz(&network_.slots()[v])))); }

void WinnerSearch::prefetch_heads(const vcg::Point3f& s) const {
    const FourInts low = first_of_nearest(s);
    for (int z = 0; z < 2; ++z)
        for (int y = 0; y < 2; ++y) prefetch(&heads_[bucket_of(low[0], low[1] + y, low[2] + z)]);
}

void WinnerSearch::prefetch_vertices(const vcg::Point3f& s) const {
    EightWords buckets;
    eight_buckets(first_of_nearest(s), shift_, buckets);
    for (int i = 0; i < 8; ++i) prefetch(network_.slots() + heads_[buckets[i]]);
}

std::uint64_t WinnerSearch::scan_box(const vcg::Point3f& s, float reach) const {
    const VertexRecord* slots = network_.slots();
    const FourInts low = cell_of(s - vcg::Point3f(reach, reach, reach));
    const FourInts high = cell_of(s + vcg::Point3f(reach, reach, reach));
    RankedVertex best = kNoVertex;
    for (std::int32_t z = low[2]; z <= high[2]; ++z)
        for (std::int32_t y = low[1]; y <= high[1]; ++y)
            for (std::int32_t x = low[0]; x <= high[0]; ++x)
                for (VertexId v = heads_[bucket_of(x, y, z)]; v >= 0; v = slots[v].link)
                    best = std::min(best, ranked(slots[v], v, s));
    return best;
}

std::uint64_t WinnerSearch::scan_all(const vcg::Point3f& s) const {
    const VertexRecord* slots = network_.slots();
    RankedVertex best = kNoVertex;
    for (const VertexId v : network_.vertices()) best = std::min(best, ranked(slots[v], v, s));
    return best;
}

VertexId WinnerSearch::winner(const vcg::Point3f& s) const {
    RankedVertex best = scan_eight_cells(network_.slots(), heads_.data(), shift_, first_of_nearest(s), s);
    const float rounding = std::max(kRounding * edge_, kLeastRounding);
    const float sure = 0.5F * edge_ - rounding;
    if (squared_distance_of(best) < sure * sure) return vertex_of(best);
    for (float reach = 2 * edge_; reach <= kMostReach * edge_; reach *= 2) {
        const float to_best = std::sqrt(squared_distance_of(best)) + rounding;
        best = std::min(best, scan_box(s, std::min(reach, to_best)));
        if (std::sqrt(squared_distance_of(best)) + rounding <= reach) return vertex_of(best);
    }
    return vertex_of(scan_all(s));
}

}  // namespace neuralmesh
