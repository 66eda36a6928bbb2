// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Small networks of several topologies, random operations on them, and checks against the referee.
#pragma once

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"

namespace neuralmesh {

inline Shape together(Shape a, const Shape& b, const vcg::Point3d& shift) {
    shapes::append(a, b, shift);
    return a;
}

/// A mesh and its topology.
struct Start {
    const char* name;
    Shape shape;
    int euler;
    int loops;
    int components;
    int genus;
};

inline std::vector<Start> starts() {
    return {
        {"tetrahedron", shapes::tetrahedron(), 2, 0, 1, 0},
        {"octahedron", shapes::bipyramid(4), 2, 0, 1, 0},
        {"cube", shapes::cube(), 2, 0, 1, 0},
        {"apexes of greatest valence", shapes::bipyramid(15), 2, 0, 1, 0},
        {"icosphere", shapes::icosphere(1), 2, 0, 1, 0},
        {"smallest grid torus", shapes::torus_grid(3, 3), 0, 0, 1, 1},
        {"torus", shapes::torus_grid(6, 4), 0, 0, 1, 1},
        {"triangle", shapes::fan(1), 1, 1, 1, 0},
        {"two triangles", shapes::fan(2), 1, 1, 1, 0},
        {"boundary vertex of greatest valence", shapes::fan(14), 1, 1, 1, 0},
        {"disk", shapes::grid(4, 5), 1, 1, 1, 0},
        {"tube of three corners", shapes::tube(3, 2), 0, 2, 1, 0},
        {"tube", shapes::tube(5, 3), 0, 2, 1, 0},
        {"torus and disk", together(shapes::torus_grid(3, 4), shapes::grid(3, 3), {3, 0, 0}), 1, 1, 2, 1},
    };
}

/// The network is valid, has the expected topology, and its counts are those of the referee.
inline void expect_sound(const Network& network, const Census& expected_topology) {
    ASSERT_EQ(network.validate(), "");
    const Census now = census(network.faces());
    ASSERT_EQ(now.breach, "");
    EXPECT_EQ(now.vertices, network.vertex_count());
    EXPECT_EQ(now.edges, network.edge_count());
    EXPECT_EQ(now.faces, network.face_count());
    EXPECT_EQ(now.components, network.component_count());
    EXPECT_EQ(now.loops, network.boundary_loop_count());
    EXPECT_TRUE(now.same_topology(expected_topology));
    EXPECT_LE(now.greatest_valence(), Ring::kMaxValence);
    for (const auto& entry : now.valence) EXPECT_EQ(entry.second, network.ring(entry.first).valence);
}

/// A random operation, if it is legal. Below \p least vertices a split, above \p most a collapse.
inline void random_operation(Network& network, Random& random, int least, int most) {
    VertexId v = 0;
    do v = any_slot(network, random);
    while (!network.alive(v));
    const Ring ring = network.ring(v);
    const int i = static_cast<int>(random.below(ring.valence));
    const VertexId w = ring[i];
    const std::uint32_t dice = random.below(4);
    if (dice == 0 || network.vertex_count() <= least) {
        const int count = 1 + static_cast<int>(random.below(ring.valence));
        const vcg::Point3f where = (network.position(v) + network.position(w)) / 2;
        if (network.can_split(v, i, count)) network.split(v, i, count, where);
    } else if (dice == 1 || network.vertex_count() >= most) {
        if (network.can_collapse(v, w)) network.collapse(v, w);
    } else if (network.can_flip(v, w)) {
        network.flip(v, w);
    }
}

}  // namespace neuralmesh
