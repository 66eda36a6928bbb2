// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/flips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"
#include "vcg_core/base/random.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {
namespace {

/// The smallest triangle_quality() of \p network.
float worst_quality(const Network& network) {
    float worst = 1;
    for (const auto& [a, b, c] : network.faces())
        worst = std::min(worst, triangle_quality(to_eigen(network.position(a)), to_eigen(network.position(b)),
                                                 to_eigen(network.position(c))));
    return worst;
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
    network.validate();
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
    freed.validate();
}

TEST(ShapeFlips, LeaveARegularMeshAlone) {
    Network network = referee::network_of(shapes::icosphere(2));
    EXPECT_EQ(flip_edges_for_shape(network, 1), 0);
}

TEST(ShapeFlips, EndOnAnyMesh) {
    Random random(7);
    for (int run = 0; run < 20; ++run) {
        Network network = referee::network_of(shapes::icosphere(2));
        for (const VertexId v : network.vertices()) {
            vcg::Point3f p = network.position(v);
            for (int k = 0; k < 3; ++k) p[k] += 0.3F * (random.unit() - 0.5F);
            network.set_position(v, p);
        }
        flip_edges_for_shape(network, 1);
        network.validate();
        EXPECT_EQ(network.genus(), 0);
    }
}

}  // namespace
}  // namespace neuralmesh
