// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "tests/unit/support/network_starts.h"
#include "tests/unit/support/referee.h"

namespace neuralmesh {
namespace {

/// Interleaves 21 bits of each coordinate, one by one.
std::uint64_t slow_morton_code(const vcg::Point3f& p) {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
        const float clamped = std::clamp(p[k], -1.0F, 0.999F);
        const auto steps = static_cast<std::uint64_t>((clamped + 1) * 0x1p20F);
        for (int bit = 0; bit < 21; ++bit) code |= (steps >> bit & 1) << (3 * bit + k);
    }
    return code;
}

/// A torus with free slots; its coordinates reach 1.4.
Network torus_with_free_slots() {
    Network network = referee::network_of(shapes::torus_grid(30, 20));
    Random random(5);
    for (int step = 0; step < 3000; ++step) network_starts::random_operation(network, random, 400, 700);
    for (int step = 0; step < 300; ++step) network_starts::random_operation(network, random, 1, 1);
    return network;
}

TEST(VertexOrder, MortonOrderSortsByInterleavedCoordinates) {
    const Network network = torus_with_free_slots();
    ASSERT_LT(network.vertex_count(), network.slot_count());
    std::vector<std::pair<std::uint64_t, VertexId>> codes;
    for (const VertexId v : network.vertices()) codes.emplace_back(slow_morton_code(network.position(v)), v);
    std::sort(codes.begin(), codes.end());
    std::vector<VertexId> expected;
    for (const auto& [code, v] : codes) expected.push_back(v);
    EXPECT_EQ(morton_order(network), expected);
}

TEST(VertexOrder, InterleaveFreeSpreadsFreeIdsEvenly) {
    for (const int size : {0, 1, 7, 100})
        for (int count = 0; count <= size; ++count) {
            SCOPED_TRACE(testing::Message() << count << " between " << size);
            std::vector<VertexId> ids(static_cast<std::size_t>(size));
            for (int i = 0; i < size; ++i) ids[static_cast<std::size_t>(i)] = size - i;
            const std::vector<VertexId> order = interleave_free(ids, count);
            int used = 0;
            int free = 0;
            for (const VertexId v : order) {
                if (v >= 0) {
                    ASSERT_EQ(v, size - used++);
                } else {
                    ++free;
                }
                // After k of n ids there are count x k / n free ones, but for rounding.
                ASSERT_LE(free * size, count * used);
                ASSERT_GE((free + 1) * size, count * (used - 1));
            }
            EXPECT_EQ(used, size);
            EXPECT_EQ(free, count);
        }
}

}  // namespace
}  // namespace neuralmesh
