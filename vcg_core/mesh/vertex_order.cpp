// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/vertex_order.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "vcg_core/base/z_order.h"

namespace neuralmesh {

namespace {

/// Of 2^21 cells along [-1, 1].
std::uint64_t cell_of(float coordinate) {
    return static_cast<std::uint64_t>((std::clamp(coordinate, -1.0F, 0.999F) + 1) * 0x1p20F);
}

std::uint64_t morton_code(const vcg::Point3f& p) {
    return z_order(cell_of(p[0]), cell_of(p[1]), cell_of(p[2]));
}

}  // namespace

std::vector<VertexId> morton_order(const Network& network) {
    std::vector<std::pair<std::uint64_t, VertexId>> codes;
    codes.reserve(static_cast<std::size_t>(network.vertex_count()));
    for (const VertexId v : network.vertices()) codes.emplace_back(morton_code(network.position(v)), v);
    std::sort(codes.begin(), codes.end());
    std::vector<VertexId> order;
    order.reserve(codes.size());
    for (const auto& [code, v] : codes) order.push_back(v);
    return order;
}

}  // namespace neuralmesh
