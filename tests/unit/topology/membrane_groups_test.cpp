// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Membranes by hand on a ball: which go together, and that they are taken apart.
#include "vcg_core/topology/membranes.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"

namespace neuralmesh {
namespace {

using targets::network_in_frame;
using targets::target_of;

/// A ball covered evenly, and the faces around its vertices as membranes.
struct Ball {
    Ball()
        : target(target_of(shapes::sphere_cloud(20000))),
          network(network_in_frame(target, shapes::icosphere(3))),
          surface(network) {
        Random random(1);
        ThreadTeam team(1);
        support = face_signals(network, surface, fair_sample(target, 20000, random), team);
    }
    Membrane around(VertexId v, float missing, bool certain = true) const {
        Membrane membrane;
        const auto faces = surface.faces_around(v);
        membrane.faces.assign(faces.begin(), faces.end());
        std::sort(membrane.faces.begin(), membrane.faces.end());
        EXPECT_TRUE(complete(surface, support, membrane));
        membrane.missing = missing;
        membrane.certain = certain;
        return membrane;
    }
    /// A vertex at so many edges from another, along its first neighbours.
    VertexId away(VertexId v, int edges) const {
        for (VertexId before = v; edges > 0; --edges) {
            VertexId next = network.ring(v)[0];
            float farthest = 0;
            for (const VertexId u : network.ring(v)) {
                const float far = (surface.positions[u] - surface.positions[before]).norm();
                if (far > farthest) farthest = far, next = u;
            }
            v = next;
        }
        return v;
    }

    TargetSpace target;
    Network network;
    Surface surface;
    FaceSignals support;
};

TEST(MembraneGroups, AreThreeAndMoreCertainOnesNearEachOther) {
    const Ball ball;
    const float edge = mean_edge_length(ball.surface);
    // 0, 4 and 8 edges from the first: each is near the next. The corner on the other side is near to none.
    std::vector<Membrane> membranes{ball.around(0, 5), ball.around(ball.away(0, 4), 9),
                                    ball.around(ball.away(0, 8), 7)};
    EXPECT_EQ(membrane_groups(ball.surface, membranes, edge, 5), (std::vector<std::vector<int>>{{1, 2, 0}}));
    EXPECT_TRUE(membrane_groups(ball.surface, membranes, edge, 2).empty());
    EXPECT_TRUE(membrane_groups(ball.surface, membranes, edge / 4, 5).empty());
    membranes[1].certain = false;
    EXPECT_TRUE(membrane_groups(ball.surface, membranes, edge, 5).empty());
}

TEST(MembraneGroups, AreTakenApartWhereTheyTouch) {
    const Ball ball;
    std::vector<Membrane> membranes{ball.around(0, 5), ball.around(ball.away(0, 2), 5)};
    const std::size_t before = membranes[1].faces.size();
    const std::vector<int> first = membranes[0].faces;
    ASSERT_TRUE(take_apart(ball.surface, ball.support, membranes));
    EXPECT_EQ(membranes[0].faces, first);
    EXPECT_LT(membranes[1].faces.size(), before);
    std::set<VertexId> seen;
    for (const Membrane& membrane : membranes)
        for (const Rim& rim : membrane.rims)
            for (const VertexId v : rim) EXPECT_TRUE(seen.insert(v).second);
    std::vector<Membrane> same{membranes[0], membranes[0]};
    EXPECT_FALSE(take_apart(ball.surface, ball.support, same));
}

}  // namespace
}  // namespace neuralmesh
