// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Patches against all triangulations of small rims, and what they make of meshes.
#include "vcg_core/topology/patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"
#include "vcg_core/mesh/boundary_loops.h"

namespace neuralmesh {
namespace {

using referee::network_of;

/// A network with holes, and what patches need.
struct Scene {
    explicit Scene(const shapes::Shape& shape, double noise = 0)
        : network(network_of(shape, noise)), surface(network), none(surface.face_count(), 0) {}
    Edges edges() const { return {network, surface, none}; }
    std::vector<Rim> rims() const { return boundary_loops(network.slot_count(), network.faces()); }

    Network network;
    Surface surface;
    PerFace<char> none;
};

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
            const std::vector<Triangle> patch = closing_patches({rim}, scene.edges());
            ASSERT_EQ(patch.size(), rim.size() - 2);
            EXPECT_NEAR(inner_edges(scene, patch), least_sum(scene, rim, 0, rim.size() - 1), 1e-4);
            ASSERT_TRUE(closed.can_exchange_faces({}, patch));
            closed.exchange_faces({}, patch);
        }
        EXPECT_EQ(closed.validate(), "");
        EXPECT_EQ(closed.boundary_loop_count(), 0);
        EXPECT_EQ(closed.genus(), 0);
    }
}

TEST(Patches, JoinTheEndsOfATubeToATorus) {
    for (const int around : {3, 4, 7, 24}) {
        SCOPED_TRACE(around);
        const Scene scene(shapes::tube(around, 5), 0.02);
        const auto rims = scene.rims();
        ASSERT_EQ(rims.size(), 2U);
        const std::vector<Triangle> patch = joining_patch({rims[0], rims[1]}, scene.edges());
        ASSERT_EQ(patch.size(), 2 * static_cast<std::size_t>(around));
        Network torus = scene.network;
        ASSERT_TRUE(torus.can_exchange_faces({}, patch));
        torus.exchange_faces({}, patch);
        EXPECT_EQ(torus.validate(), "");
        EXPECT_EQ(torus.boundary_loop_count(), 0);
        EXPECT_EQ(torus.genus(), 1);
    }
}

TEST(Patches, JoinTwoPartsWithRimsOfDifferentLengths) {
    shapes::Shape shape = shapes::tube(4, 3);
    shapes::append(shape, shapes::tube(9, 3), {0, 0, 4});
    const Scene scene(shape, 0.02);
    const auto rims = scene.rims();
    int joined = 0;
    for (std::size_t a = 0; a < rims.size(); ++a)
        for (std::size_t b = a + 1; b < rims.size(); ++b) {
            const std::vector<Triangle> patch = joining_patch({rims[a], rims[b]}, scene.edges());
            if (!scene.network.can_exchange_faces({}, patch)) continue;
            Network network = scene.network;
            network.exchange_faces({}, patch);
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
        const std::vector<Rim> rims = boundary_loops(network.slot_count(), network.faces());
        ASSERT_EQ(rims.size(), static_cast<std::size_t>(holes));
        const Surface surface(network);
        const PerFace<char> none(surface.face_count(), 0);
        const auto patch = joining_patch(rims, {network, surface, none});
        ASSERT_TRUE(network.can_exchange_faces({}, patch));
        network.exchange_faces({}, patch);
        EXPECT_EQ(network.validate(), "");
        EXPECT_EQ(network.boundary_loop_count(), 0);
        EXPECT_EQ(network.genus(), holes - 1);
    }
}

TEST(Patches, NeedNoEdgeThatExists) {
    // The rim of a half disc of two faces: its only diagonal is the edge between them.
    const Scene scene(shapes::fan(2));
    const auto rims = scene.rims();
    ASSERT_EQ(rims.size(), 1U);
    const std::vector<Triangle> patch = closing_patches({rims[0]}, scene.edges());
    Network closed = scene.network;
    ASSERT_TRUE(closed.can_exchange_faces({}, patch));
    closed.exchange_faces({}, patch);
    EXPECT_EQ(closed.validate(), "");
    EXPECT_EQ(closed.faces().size(), 4U);
}

// The ends of a tube: of a long rim only some turns are tried.
TEST(Patches, JoinLongRimsByTheShortestEdges) {
    for (const int around : {20, 60}) {
        const Scene scene(shapes::tube(around, 3));
        const auto rims = scene.rims();
        const std::vector<Triangle> patch = joining_patch({rims[0], rims[1]}, scene.edges());
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
    EXPECT_TRUE(closing_patches({rims[0]}, scene.edges()).empty());
    EXPECT_TRUE(joining_patch({rims[0], rims[1]}, scene.edges()).empty());
    EXPECT_TRUE(joining_patch({rims[0], rims[0]}, scene.edges()).empty());
    const Rim three(rims[0].begin(), rims[0].begin() + 3);
    EXPECT_TRUE(joining_patch({three, rims[1], three}, scene.edges()).empty());
    EXPECT_TRUE(joining_patch({rims[0], rims[1], {}}, scene.edges()).empty());
}

}  // namespace
}  // namespace neuralmesh
