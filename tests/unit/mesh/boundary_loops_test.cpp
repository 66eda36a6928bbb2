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

std::vector<int> valences_of(const Network& network) {
    std::vector<int> valences;
    for (const VertexId v : network.vertices()) valences.push_back(network.ring(v).valence);
    return valences;
}

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
    for (const int around : {3, 4, 5, 12}) {
        SCOPED_TRACE(around);
        const Network tube = network_of(shapes::tube(around, 4));
        std::vector<Triangle> faces = tube.faces();
        std::vector<int> neighbours = valences_of(tube);
        for (const auto& loop : boundary_loops(tube.slot_count(), tube.faces()))
            ASSERT_TRUE(fill_hole(loop, positions_of(tube), 12, neighbours, faces));
        const Network closed(positions_of(tube), faces);
        EXPECT_EQ(closed.validate(), "");
        EXPECT_EQ(closed.boundary_loop_count(), 0);
        EXPECT_EQ(closed.genus(), 0);
        EXPECT_EQ(valences_of(closed), neighbours);
        EXPECT_LE(*std::max_element(neighbours.begin(), neighbours.end()), 12);
    }
}

TEST(BoundaryLoops, StayOpenWhereFillingWouldBreakTheManifold) {
    // The loop around a single triangle could only be filled by its other side.
    const std::vector<vcg::Point3f> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    std::vector<Triangle> faces = {{0, 1, 2}};
    std::vector<int> neighbours = {2, 2, 2};
    const auto loops = boundary_loops(3, faces);
    ASSERT_EQ(loops.size(), 1U);
    EXPECT_FALSE(fill_hole(loops[0], positions, 12, neighbours, faces));
    EXPECT_EQ(faces.size(), 1U);
    EXPECT_EQ(neighbours, std::vector<int>({2, 2, 2}));

    const Network tube = network_of(shapes::tube(12, 3));
    faces = tube.faces();
    neighbours = valences_of(tube);
    EXPECT_FALSE(
        fill_hole(boundary_loops(tube.slot_count(), faces)[0], positions_of(tube), 4, neighbours, faces));
    EXPECT_EQ(faces.size(), tube.faces().size());
}

}  // namespace
}  // namespace neuralmesh
