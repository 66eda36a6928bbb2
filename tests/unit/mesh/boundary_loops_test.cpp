// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/boundary_loops.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh {
namespace {

using referee::network_of;

std::vector<vcg::Point3f> positions_of(const Network& network) {
    std::vector<vcg::Point3f> positions;
    for (const VertexId v : network.vertices()) positions.push_back(network.position(v));
    return positions;
}

IndexedMesh<float> mesh_of(const Network& network) { return {positions_of(network), network.faces()}; }

TEST(BoundaryLoops, AreFound) {
    const Network tube = network_of(shapes::tube(7, 3));
    const auto loops = boundary_loops(tube.slot_count(), tube.faces());
    ASSERT_EQ(loops.size(), 2U);
    for (const auto& loop : loops) {
        EXPECT_EQ(loop.size(), 7U);
        for (std::size_t i = 0; i < loop.size();
             ++i)  // the first of an open ring is the next on the boundary
            EXPECT_EQ(tube.ring(loop[i])[0], loop[(i + 1) % loop.size()]);
    }
    const Network sphere = network_of(shapes::icosphere(2));
    EXPECT_TRUE(boundary_loops(sphere.slot_count(), sphere.faces()).empty());
}

TEST(BoundaryLoops, AreMeasuredByTheSmallestSphere) {
    EXPECT_NEAR(smallest_sphere_diameter({{0, 0, 0}, {2, 0, 0}}), 2, 0.02);
    EXPECT_NEAR(smallest_sphere_diameter({{0, 0, 0}, {2, 0, 0}, {1, 0.3F, 0}}), 2, 0.02);
    EXPECT_NEAR(smallest_sphere_diameter({{1, 0, 0}, {-0.5F, 0.8660254F, 0}, {-0.5F, -0.8660254F, 0}}), 2,
                0.03);
    EXPECT_EQ(smallest_sphere_diameter({{3, 4, 5}}), 0);
}

TEST(BoundaryLoops, AreFilledToClosedManifolds) {
    for (const int around : {3, 4, 5, 12, 40}) {
        SCOPED_TRACE(around);
        const Network tube = network_of(shapes::tube(around, 4));
        IndexedMesh<float> mesh = mesh_of(tube);
        const auto loops = boundary_loops(tube.slot_count(), mesh.faces);
        HoleFiller filler(mesh, loops, 12);
        for (const auto& loop : loops) ASSERT_TRUE(filler.fill(loop));
        const Network closed(mesh.positions, mesh.faces);
        EXPECT_EQ(closed.validate(), "");
        EXPECT_EQ(closed.boundary_loop_count(), 0);
        EXPECT_EQ(closed.genus(), 0);
        EXPECT_EQ(closed.vertex_count(), tube.vertex_count());
        for (const VertexId v : closed.vertices()) EXPECT_LE(closed.ring(v).valence, 12);
    }
}

TEST(BoundaryLoops, AreFilledIfNarrowAcross) {
    // One end of a tube squeezed to a crack, about 2 long.
    const Network tube = network_of(shapes::tube(40, 3));
    IndexedMesh<float> mesh = mesh_of(tube);
    const auto loops = boundary_loops(tube.slot_count(), mesh.faces);
    for (const VertexId v : loops[0]) mesh.positions[static_cast<std::size_t>(v)][0] *= 0.01F;
    HoleFiller filler(mesh, loops, 12);
    EXPECT_FALSE(filler.fill(loops[1], 0.5F));  // round, of diameter 2
    EXPECT_EQ(mesh.faces, tube.faces());
    EXPECT_FALSE(filler.fill(loops[0], 0.01F));
    EXPECT_EQ(mesh.faces, tube.faces());
    EXPECT_TRUE(filler.fill(loops[0], 0.5F));
    EXPECT_TRUE(filler.fill(loops[1], 3));
    EXPECT_EQ(Network(mesh.positions, mesh.faces).validate(), "");
}

TEST(BoundaryLoops, StayOpenWhereVerticesWouldGetTooManyNeighbours) {
    const Network tube = network_of(shapes::tube(12, 3));
    IndexedMesh<float> mesh = mesh_of(tube);
    const auto loops = boundary_loops(tube.slot_count(), mesh.faces);
    HoleFiller filler(mesh, loops, 4);
    EXPECT_FALSE(filler.fill(loops[0]));
    EXPECT_EQ(mesh.faces, tube.faces());
    EXPECT_EQ(static_cast<int>(mesh.positions.size()), tube.vertex_count());
}

}  // namespace
}  // namespace neuralmesh
