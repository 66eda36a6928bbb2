// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/half_edge_queue.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "tests/unit/support/network_starts.h"
#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

using Collapses = std::vector<std::pair<VertexId, VertexId>>;

/// Many lengths are equal, as on a grid.
float coarse_length(const Network& network, VertexId a, VertexId b) {
    return std::round(20 * (network.position(a) - network.position(b)).Norm());
}

/// The answer changes from time to time, and with the neighbours that go.
bool may_collapse(const Network& network, VertexId gone, VertexId kept) {
    const int phase = network.vertex_count() / 8;
    return (gone + 2 * kept + phase) % 3 == 0 && network.can_collapse(gone, kept);
}

bool exists(const Network& network, VertexId a, VertexId b) {
    return network.alive(a) && network.adjacent(a, b);
}

Collapses by_queue(Network& network, int vertices) {
    Collapses done;
    HalfEdgeQueue queue(network, [&](VertexId a, VertexId b) { return coarse_length(network, a, b); });
    while (network.vertex_count() > vertices && !queue.empty()) {
        const auto [length, gone, kept] = queue.take();
        if (!exists(network, gone, kept) || !may_collapse(network, gone, kept)) continue;
        queue.collapse(gone, kept);
        done.emplace_back(gone, kept);
    }
    return done;
}

/// All half-edges wait in a set. After each collapse all at the vertex that is left wait again.
Collapses by_set(Network& network, int vertices) {
    Collapses done;
    std::set<std::pair<float, std::pair<VertexId, VertexId>>> waiting;
    const auto wait = [&](VertexId a, VertexId b) { waiting.insert({coarse_length(network, a, b), {a, b}}); };
    for (const VertexId v : network.vertices())
        for (const VertexId w : network.ring(v)) wait(v, w);
    while (network.vertex_count() > vertices && !waiting.empty()) {
        const auto [gone, kept] = waiting.begin()->second;
        waiting.erase(waiting.begin());
        if (!exists(network, gone, kept) || !may_collapse(network, gone, kept)) continue;
        network.collapse(gone, kept);
        for (const VertexId w : network.ring(kept)) {
            wait(kept, w);
            wait(w, kept);
        }
        done.emplace_back(gone, kept);
    }
    return done;
}

TEST(HalfEdgeQueue, TakesThemAsIfAllWaitedAgain) {
    for (const shapes::Shape& shape : {shapes::torus_grid(40, 20), shapes::icosphere(3)}) {
        Network network = referee::network_of(shape), same = network;
        const int vertices = network.vertex_count() / 8;
        const Collapses done = by_queue(network, vertices);
        EXPECT_EQ(done, by_set(same, vertices));
        EXPECT_EQ(network.validate(), "");
        EXPECT_GT(done.size(), static_cast<std::size_t>(network.vertex_count()));
    }
}

TEST(HalfEdgeQueue, IsEmptyWhenAllAreTaken) {
    Network network = referee::network_of(shapes::icosphere(1));
    HalfEdgeQueue queue(network, [&](VertexId a, VertexId b) { return coarse_length(network, a, b); });
    int taken = 0;
    float last = 0;
    for (; !queue.empty(); ++taken) {
        const QueuedHalfEdge next = queue.take();
        EXPECT_GE(next.length, last);
        last = next.length;
    }
    EXPECT_EQ(taken, 2 * 120) << "each of the edges in both directions";
}

}  // namespace
}  // namespace neuralmesh
