// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The winner search against a linear search, while vertices move, are added and are removed.
#include "vcg_core/engine/winner_search.h"

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"

namespace neuralmesh::winner_search_test {

/// Linear search: the nearest vertex, the smaller id among equally near ones.
VertexId nearest_by_linear_search(const Network& network, const vcg::Point3f& s) {
    VertexId best = -1;
    float least = std::numeric_limits<float>::infinity();
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.alive(v)) continue;
        const vcg::Point3f d = network.position(v) - s;
        const float squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        if (squared >= least) continue;
        least = squared;
        best = v;
    }
    return best;
}

/// The shape as a network inside the core's frame, with a bounding-box diagonal of about 1.
Network in_frame(const Shape& shape, double scale = 0.28) { return network_of(shapes::scaled(shape, scale)); }

vcg::Point3f random_point(Random& random, float reach) {
    const float x = 2 * random.unit() - 1;
    const float y = 2 * random.unit() - 1;
    return {reach * x, reach * y, reach * (2 * random.unit() - 1)};
}

VertexId random_vertex(const Network& network, Random& random) {
    for (;;) {
        const auto v = any_slot(network, random);
        if (network.alive(v)) return v;
    }
}

/// On a vertex, midway between two vertices, anywhere in or out of the frame, or near the mesh.
vcg::Point3f random_signal(const Network& network, Random& random) {
    const vcg::Point3f p = network.position(random_vertex(network, random));
    switch (random.below(6)) {
        case 0: return p;
        case 1: return (p + network.position(random_vertex(network, random))) / 2;
        case 2: return random_point(random, 0.5F);
        case 3: return random_point(random, 3.5F);
        default: return p + random_point(random, 0.02F);
    }
}

void expect_exact(const Network& network, const WinnerSearch& search, Random& random, int signals) {
    for (int i = 0; i < signals; ++i) {
        const vcg::Point3f s = random_signal(network, random);
        ASSERT_EQ(search.winner(s), nearest_by_linear_search(network, s))
            << "signal " << s[0] << ' ' << s[1] << ' ' << s[2];
    }
}

void split_somewhere(Network& network, WinnerSearch& search, Random& random) {
    const VertexId v = random_vertex(network, random);
    const int k = network.ring(v).valence;
    const int first = static_cast<int>(random.below(static_cast<std::uint32_t>(k)));
    const int count = k / 2 + 1;
    if (!network.can_split(v, first, count)) return;
    search.add(
        network.split(v, first, count, (network.position(v) + network.position(network.ring(v)[first])) / 2));
    search.rebuild_if_outgrown();
}

void collapse_somewhere(Network& network, WinnerSearch& search, Random& random) {
    const VertexId v = random_vertex(network, random);
    const VertexId w = network.ring(v)[0];
    if (!network.can_collapse(v, w)) return;
    search.remove(v);
    network.collapse(v, w);
    search.rebuild_if_outgrown();
}

TEST(WinnerSearch, IsLinearSearchOnAMeshAtRest) {
    Random random(1);
    for (Network network : {in_frame(shapes::tetrahedron()), in_frame(shapes::icosphere(1)),
                            in_frame(shapes::icosphere(4)), in_frame(shapes::torus_grid(40, 20)),
                            in_frame(shapes::grid(30, 30)), in_frame(shapes::icosphere(3), 0.002)}) {
        const WinnerSearch search(network);
        expect_exact(network, search, random, 3000);
    }
}

TEST(WinnerSearch, IsLinearSearchWhileVerticesMoveAndChange) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        Random random(seed);
        Network network = in_frame(shapes::icosphere(3));
        WinnerSearch search(network);
        for (int step = 0; step < 6000; ++step) {
            const VertexId v = random_vertex(network, random);
            switch (random.below(8)) {
                case 0: search.move(v, random_point(random, 0.5F)); break;  // anywhere
                case 1: split_somewhere(network, search, random); break;
                case 2: collapse_somewhere(network, search, random); break;
                default: search.move(v, network.position(v) + random_point(random, 0.01F));
            }
            expect_exact(network, search, random, 2);
            if (HasFatalFailure()) FAIL() << "at step " << step << ", seed " << seed;
        }
    }
}

TEST(WinnerSearch, IsLinearSearchOverManyRebuilds) {
    Random random(4);
    Network network = in_frame(shapes::tetrahedron(), 0.1);
    WinnerSearch search(network);
    for (const int goal : {5000, 10, 800, 4}) {
        for (int tries = 0; network.vertex_count() != goal && tries < 200000; ++tries) {
            if (network.vertex_count() < goal) {
                split_somewhere(network, search, random);
            } else {
                collapse_somewhere(network, search, random);
            }
            const VertexId v = random_vertex(network, random);
            search.move(v, network.position(v) + random_point(random, 0.02F));
            if (tries % 50 == 0) expect_exact(network, search, random, 1);
            if (HasFatalFailure()) return;
        }
        expect_exact(network, search, random, 500);
    }
    EXPECT_EQ(network.validate(), "");
}

TEST(WinnerSearch, ResolvesTiesToTheSmallerId) {
    Random random(5);
    Network network = in_frame(shapes::torus_grid(20, 10));
    WinnerSearch search(network);
    // Few places on a lattice, with many vertices in each, in changing order in their lists.
    for (int step = 0; step < 4000; ++step) {
        const auto coordinate = [&] { return (static_cast<float>(random.below(3)) - 1) / 8; };
        const float x = coordinate();
        const float y = coordinate();
        search.move(random_vertex(network, random), {x, y, coordinate()});
        if (step % 4 == 0) expect_exact(network, search, random, 1);
        const float u = coordinate() / 2;
        const vcg::Point3f between(u, coordinate() / 2, coordinate() / 2);
        ASSERT_EQ(search.winner(between), nearest_by_linear_search(network, between));
    }
    for (VertexId v = network.slot_count(); v-- > 0;) search.move(v, {0.1F, 0.1F, 0.1F});
    EXPECT_EQ(search.winner({0.4F, -0.3F, 0}), 0);
    search.remove(0);
    network.collapse(0, network.ring(0)[0]);
    EXPECT_EQ(search.winner({0.4F, -0.3F, 0}), 1);
}

TEST(WinnerSearch, IsExactWhereAllVerticesCrowdTogetherButOne) {
    for (const float size : {1e-2F, 1e-4F, 1e-6F}) {
        SCOPED_TRACE(size);
        Random random(6);
        Network network = in_frame(shapes::icosphere(3));
        const vcg::Point3f crowd(0.4F, -0.3F, 0.21F);
        for (VertexId v = 1; v < network.slot_count(); ++v)
            network.set_position(v, crowd + random_point(random, size));
        network.set_position(0, {-0.4F, 0.3F, -0.2F});
        WinnerSearch search(network);
        expect_exact(network, search, random, 1000);
        for (int i = 0; i < 2000; ++i) {
            search.move(random_vertex(network, random), crowd + random_point(random, size));
            const vcg::Point3f s = crowd + random_point(random, 2 * size);
            ASSERT_EQ(search.winner(s), nearest_by_linear_search(network, s));
        }
    }
}

// A vertex just within half a cell of the signal may lie outside the eight cells searched first, as their
// borders are rounded. Then one on the other side, hardly further away, must not win.
TEST(WinnerSearch, IsExactBesideRoundedCellBorders) {
    for (const double scale : {1e-7, 2e-5}) {
        SCOPED_TRACE(scale);
        Network network = in_frame(shapes::tetrahedron(), scale);
        WinnerSearch search(network);
        const float edge = std::max(1e-5F, 1.3F * (network.position(0) - network.position(1)).Norm());
        Random random(7);
        for (int i = 0; i < 300000; ++i) {
            const vcg::Point3f s = random_point(random, 0.5F);
            vcg::Point3f axis(0, 0, 0);
            axis[static_cast<int>(random.below(3))] = random.below(2) == 0 ? edge : -edge;
            const float near = 0.47F + 0.0289F * random.unit();
            search.move(0, s + axis * near);
            search.move(1, s - axis * (near + (0.4989F - near) * random.unit()));
            ASSERT_EQ(search.winner(s), nearest_by_linear_search(network, s)) << "at step " << i;
        }
    }
}

TEST(WinnerSearch, IsExactForVerticesAndSignalsOutsideTheFrame) {
    Random random(8);
    Network network = in_frame(shapes::icosphere(2));
    WinnerSearch search(network);
    for (int i = 0; i < 3000; ++i) {
        search.move(random_vertex(network, random), random_point(random, i % 2 == 0 ? 20.0F : 0.5F));
        const vcg::Point3f s = random_point(random, i % 3 == 0 ? 30.0F : 6.0F);
        ASSERT_EQ(search.winner(s), nearest_by_linear_search(network, s)) << "at step " << i;
    }
}

}  // namespace neuralmesh::winner_search_test
