// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Patches against all triangulations of small rims, and what they make of meshes.
#include "vcg_core/topology/patches.h"

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/mesh/boundary_loops.h"

namespace neuralmesh::patches_test {

/// A network with holes, and the patches of some of them.
struct Scene {
    explicit Scene(Network given)
        : network(std::move(given)), surface(network), none(surface.face_count(), 0) {}
    explicit Scene(const Shape& shape, double noise = 0) : Scene(network_of(shape, noise)) {}
    std::vector<Rim> rims() const { return boundary_loops(network.slot_count(), network.faces()); }
    std::vector<Triangle> closing(const Rim& rim) const {
        return closing_patches({rim}, {network, surface, none});
    }
    std::vector<Triangle> joining(const std::vector<Rim>& rims) const {
        return joining_patch(rims, {network, surface, none});
    }

    Network network;
    Surface surface;
    PerFace<char> none;
};

Network with_patch(Network network, const std::vector<Triangle>& patch) {
    EXPECT_TRUE(network.can_exchange_faces({}, patch));
    network.exchange_faces({}, patch);
    return network;
}

float squared(const Scene& scene, VertexId a, VertexId b) {
    return (scene.surface.positions[a] - scene.surface.positions[b]).squaredNorm();
}

/// The sum over the inner edges of a patch, each of which two faces share.
float inner_edges(const Scene& scene, const std::vector<Triangle>& patch) {
    float sum = 0;
    for (const Triangle& f : patch)
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = f[k], b = f[(k + 1) % 3];
            const bool shared = std::any_of(patch.begin(), patch.end(), [&](const Triangle& g) {
                return (g[0] == b && g[1] == a) || (g[1] == b && g[2] == a) || (g[2] == b && g[0] == a);
            });
            if (shared) sum += squared(scene, a, b) / 2;
        }
    return sum;
}

/// The least sum over the inner edges of all triangulations of the rim from corner i to corner j.
float least_sum(const Scene& scene, const Rim& rim, std::size_t i, std::size_t j) {
    if (j - i < 2) return 0;
    float least = std::numeric_limits<float>::max();
    const auto inner = [&](std::size_t a, std::size_t b) {
        return b - a < 2 ? 0.0F : squared(scene, rim[a], rim[b]);
    };
    for (std::size_t k = i + 1; k < j; ++k)
        least = std::min(
            least, least_sum(scene, rim, i, k) + least_sum(scene, rim, k, j) + inner(i, k) + inner(k, j));
    return least;
}

TEST(Patches, CloseRimsWithTheLeastEdges) {
    for (const int around : {4, 5, 8, 11}) {
        SCOPED_TRACE(around);
        const Scene scene(shapes::tube(around, 4), 0.1);
        Network closed = scene.network;
        for (const Rim& rim : scene.rims()) {
            const std::vector<Triangle> patch = scene.closing(rim);
            ASSERT_EQ(patch.size(), rim.size() - 2);
            EXPECT_NEAR(inner_edges(scene, patch), least_sum(scene, rim, 0, rim.size() - 1), 1e-4);
            closed = with_patch(closed, patch);
        }
        EXPECT_EQ(topology_of(closed), kBall);
    }
}

TEST(Patches, JoinTheEndsOfATubeToATorus) {
    for (const int around : {3, 4, 7, 24}) {
        SCOPED_TRACE(around);
        const Scene scene(shapes::tube(around, 5), 0.02);
        ASSERT_EQ(scene.rims().size(), 2U);
        const std::vector<Triangle> patch = scene.joining(scene.rims());
        ASSERT_EQ(patch.size(), 2 * static_cast<std::size_t>(around));
        EXPECT_EQ(topology_of(with_patch(scene.network, patch)), kRing);
    }
}

TEST(Patches, JoinTwoPartsWithRimsOfDifferentLengths) {
    Shape shape = shapes::tube(4, 3);
    shapes::append(shape, shapes::tube(9, 3), {0, 0, 4});
    const Scene scene(shape, 0.02);
    const auto rims = scene.rims();
    int joined = 0;
    for (std::size_t a = 0; a < rims.size(); ++a)
        for (std::size_t b = a + 1; b < rims.size(); ++b) {
            const std::vector<Triangle> patch = scene.joining({rims[a], rims[b]});
            if (!scene.network.can_exchange_faces({}, patch)) continue;
            const Network network = with_patch(scene.network, patch);
            EXPECT_EQ(network.validate(), "");
            EXPECT_EQ(network.boundary_loop_count(), 2);
            joined += network.component_count() == 1 ? 1 : 0;
        }
    EXPECT_GT(joined, 0);
}

TEST(Patches, JoinThreeRimsAndMore) {
    for (const int holes : {3, 4, 5}) {
        SCOPED_TRACE(holes);
        Network network = network_of(shapes::icosphere(2), 0.02);
        for (VertexId corner = 0; corner < holes; ++corner) {  // of the icosahedron, far from each other
            std::vector<Triangle> around;
            for (const Triangle& f : network.faces())
                if (std::find(f.begin(), f.end(), corner) != f.end()) around.push_back(f);
            network.exchange_faces(around, {});
        }
        const Scene scene(network);
        ASSERT_EQ(scene.rims().size(), static_cast<std::size_t>(holes));
        EXPECT_EQ(topology_of(with_patch(network, scene.joining(scene.rims()))), (Topology{1, holes - 1, 0}));
    }
}

TEST(Patches, NeedNoEdgeThatExists) {
    // The rim of a half disc of two faces: its only diagonal is the edge between them.
    const Scene scene(shapes::fan(2));
    ASSERT_EQ(scene.rims().size(), 1U);
    const Network closed = with_patch(scene.network, scene.closing(scene.rims()[0]));
    EXPECT_EQ(closed.validate(), "");
    EXPECT_EQ(closed.faces().size(), 4U);
}

// The ends of a tube: of a long rim only some turns are tried.
TEST(Patches, JoinLongRimsByTheShortestEdges) {
    for (const int around : {20, 60}) {
        const Scene scene(shapes::tube(around, 3));
        const auto rims = scene.rims();
        const std::vector<Triangle> patch = scene.joining(rims);
        ASSERT_EQ(patch.size(), 2U * static_cast<std::size_t>(around));
        float longest = 0, least = std::numeric_limits<float>::max();
        for (const Triangle& f : patch)
            for (std::size_t k = 0; k < 3; ++k)
                longest = std::max(longest, squared(scene, f[k], f[(k + 1) % 3]));
        for (const VertexId v : rims[1]) least = std::min(least, squared(scene, rims[0][0], v));
        const float step = squared(scene, rims[0][0], rims[0][1]);
        EXPECT_LT(longest, 1.01F * (least + step)) << around;
    }
}

TEST(Patches, AreRefusedForLongRimsAndRimsThatTouch) {
    const Scene scene(shapes::tube(kLongestRim + 1, 3));
    const auto rims = scene.rims();
    EXPECT_TRUE(scene.closing(rims[0]).empty());
    const Rim three(rims[0].begin(), rims[0].begin() + 3);
    for (const std::vector<Rim>& refused :
         {rims, {rims[0], rims[0]}, {three, rims[1], three}, {rims[0], rims[1], {}}})
        EXPECT_TRUE(scene.joining(refused).empty());
}

}  // namespace neuralmesh::patches_test
