// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Flips for valence and for shape.
#include "vcg_core/mesh/flips.h"
#include "tests/unit/support/network_starts.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh::flips_test {

bool always(const FlipNormals& /*normals*/) { return true; }

int irregularity(const Network& network) {
    int sum = 0;
    for (const VertexId v : network.vertices()) {
        const Ring& ring = network.ring(v);
        const int excess = ring.valence - (ring.open != 0 ? kRegularBoundaryValence : kRegularValence);
        sum += excess * excess;
    }
    return sum;
}

int highest_valence(const Network& network) {
    int highest = 0;
    for (const VertexId v : network.vertices()) highest = std::max<int>(highest, network.ring(v).valence);
    return highest;
}

/// Flips random edges, so that valences are irregular. Positions stay.
Network with_random_flips(Network network, int flips, std::uint64_t seed = 8) {
    Random random(seed);
    for (int i = 0; i < flips; ++i) {
        const auto v = any_slot(network, random);
        const VertexId w = network.ring(v)[static_cast<int>(random.below(network.ring(v).valence))];
        if (network.can_flip(v, w)) network.flip(v, w);
    }
    return network;
}

/// The least irregularity that one flip reaches, by trying them all; \p max_valence is not exceeded.
int best_of_all_flips(const Network& network, int max_valence) {
    int best = irregularity(network);
    for (const VertexId v : network.vertices())
        for (const VertexId w : network.ring(v)) {
            if (!network.can_flip(v, w)) continue;
            Network flipped = network;
            flipped.flip(v, w);
            if (highest_valence(flipped) <= std::max(max_valence, highest_valence(network)))
                best = std::min(best, irregularity(flipped));
        }
    return best;
}

TEST(ValenceFlips, LowerTheIrregularityUntilNoFlipDoes) {
    int flips = 0;
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        Network network = with_random_flips(network_of(start.shape), 200);
        const Census topology = census(network.faces());
        const auto positions = positions_of(network);
        for (int done = 1; done > 0; flips += done) {
            const int before = irregularity(network);
            done = flip_edges_for_valence(network, {always});
            EXPECT_LE(irregularity(network), before - 2 * done) << "every flip lowers it, and it stays even";
            expect_sound(network, topology);
            if (HasFatalFailure()) return;
        }
        EXPECT_EQ(best_of_all_flips(network, Ring::kMaxValence), irregularity(network));
        EXPECT_EQ(positions_of(network), positions);
    }
    EXPECT_GT(flips, 50);
}

TEST(ValenceFlips, OfOneVertexFlipItsEdgesOnly) {
    const Network before = with_random_flips(network_of(shapes::icosphere(2)), 400);
    int flips = 0;
    for (const VertexId v : before.vertices()) {
        Network network = before;
        const int done = flip_edges_for_valence(network, v, {always});
        EXPECT_EQ(network.ring(v).valence, before.ring(v).valence - done);
        EXPECT_EQ(network.validate(), "");
        flips += done;
    }
    EXPECT_GT(flips, 50);
}

TEST(ValenceFlips, KeepTheHighestValenceAllowed) {
    const Network before = with_random_flips(network_of(shapes::torus_grid(12, 10)), 600);
    Network network = before;
    ASSERT_GT(flip_edges_for_valence(network, {always, 6}), 0);
    for (const VertexId v : network.vertices())
        EXPECT_LE(network.ring(v).valence, std::max<int>(6, before.ring(v).valence));
}

bool stay_upright(const FlipNormals& normals) {
    return normals.after[0][2] > 1e-6F && normals.after[1][2] > 1e-6F;
}

/// True if all faces of a flat network are counter-clockwise seen from above.
bool upright(const Network& network) {
    const std::vector<Triangle> faces = network.faces();
    return std::all_of(faces.begin(), faces.end(), [&](const Triangle& f) {
        const vcg::Point3f a = network.position(f[0]);
        return ((network.position(f[1]) - a) ^ (network.position(f[2]) - a))[2] > 1e-6F;
    });
}

TEST(ValenceFlips, TurnNoFaceOverIfTheRuleForbidsIt) {
    Network network = network_of(shapes::grid(14, 14));
    for (int i = 0; i < 600; ++i) {
        const Network flipped = with_random_flips(network, 1, static_cast<std::uint64_t>(i));
        if (upright(flipped)) network = flipped;
    }
    Network careless = network;
    ASSERT_GT(flip_edges_for_valence(network, {stay_upright}), 10);
    EXPECT_TRUE(upright(network));
    flip_edges_for_valence(careless, {always});
    EXPECT_FALSE(upright(careless)) << "the test needs flips that the rule has to forbid";
}

/// A net of squares, cut along one diagonal each, that is bent by \p height and sheared by \p shear.
Network sheared_net(float shear, float height) {
    constexpr int kSide = 8;
    std::vector<vcg::Point3f> positions;
    std::vector<std::array<int, 3>> faces;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const auto u = static_cast<float>(x), v = static_cast<float>(y);
            positions.emplace_back(u + shear * v, v, height * u * v);
            if (x + 1 == kSide || y + 1 == kSide) continue;
            const int i = y * kSide + x;
            faces.push_back({i, i + 1, i + kSide + 1});
            faces.push_back({i, i + kSide + 1, i + kSide});
        }
    return Network(positions, faces);
}

TEST(ShapeFlips, MakeBetterFacesOfAFlatNet) {
    Network network = sheared_net(0.9F, 0);
    const float before = worst_quality(network);
    EXPECT_GT(flip_edges_for_shape(network, 1e-6F), 0);
    EXPECT_EQ(network.validate(), "");
    EXPECT_GT(worst_quality(network), 1.5F * before);
    EXPECT_EQ(flip_edges_for_shape(network, 1e-6F), 0);
}

TEST(ShapeFlips, ChangeTheSurfaceByNoMoreThanAllowed) {
    const Network network =
        sheared_net(0.9F, 0.01F);  // the diagonals of a quad are .01 apart, but for the slope
    Network held = network;
    EXPECT_EQ(flip_edges_for_shape(held, 0.002F), 0);
    Network freed = network;
    EXPECT_GT(flip_edges_for_shape(freed, 0.02F), 0);
    EXPECT_EQ(freed.validate(), "");
}

TEST(ShapeFlips, LeaveARegularMeshAlone) {
    Network network = network_of(shapes::icosphere(2));
    EXPECT_EQ(flip_edges_for_shape(network, 1), 0);
}

TEST(ShapeFlips, EndOnAnyMesh) {
    Random random(7);
    for (int run = 0; run < 20; ++run) {
        Network network = network_of(shapes::icosphere(2));
        for (const VertexId v : network.vertices()) {
            vcg::Point3f p = network.position(v);
            for (int k = 0; k < 3; ++k) p[k] += 0.3F * (random.unit() - 0.5F);
            network.set_position(v, p);
        }
        flip_edges_for_shape(network, 1);
        EXPECT_EQ(topology_of(network), kBall);
    }
}

}  // namespace neuralmesh::flips_test
