// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Operations that run out of memory leave the network unchanged.
#include "vcg_core/mesh/network.h"

#include <gtest/gtest.h>

#include <new>
#include <vector>

#include "allocations.h"
#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

/// Tries \p change on \p network with the first, the second, ... allocation failing, until it succeeds.
/// \return the number of failures
template <class Change>
int failures_before(Network& network, const Change& change) {
    const int vertices = network.vertex_count();
    const std::vector<Triangle> faces = network.faces();
    for (int nth = 0;; ++nth) {
        allocations::fail_at(nth);
        try {
            change();
            allocations::fail_at(-1);
            return nth;
        } catch (const std::bad_alloc&) {
            allocations::fail_at(-1);
        }
        EXPECT_EQ(network.validate(), "") << nth;
        EXPECT_EQ(network.vertex_count(), vertices);
        EXPECT_EQ(network.faces(), faces);
    }
}

TEST(OutOfMemory, AFailedSplitChangesNothing) {
    Network network = referee::network_of(shapes::icosphere(1));
    int failures = 0;
    for (VertexId v = 0; v < 12; ++v) {
        ASSERT_TRUE(network.can_split(v, 0, 3));
        failures += failures_before(network, [&] { network.split(v, 0, 3, network.position(v)); });
        ASSERT_EQ(network.validate(), "");
        EXPECT_EQ(network.position(network.slot_count() - 1), network.position(v));
    }
    EXPECT_GE(failures, 2);
    EXPECT_EQ(network.vertex_count(), 54);
}

TEST(OutOfMemory, AFailedCollapseChangesNothing) {
    for (const bool with_gaps : {false, true}) {
        Network network = referee::network_of(shapes::icosphere(1));
        if (with_gaps) {
            std::vector<VertexId> order = morton_order(network);
            order.insert(order.begin(), -1);
            network.renumber(order);
        }
        int failures = 0;
        for (const VertexId v : network.vertices()) {
            if (!network.can_collapse(v, network.ring(v)[0])) continue;
            failures += failures_before(network, [&] { network.collapse(v, network.ring(v)[0]); });
            ASSERT_EQ(network.validate(), "");
        }
        EXPECT_EQ(failures > 0, !with_gaps) << "one word holds all these gaps";
    }
}

}  // namespace
}  // namespace neuralmesh
