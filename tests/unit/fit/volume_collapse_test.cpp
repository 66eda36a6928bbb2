// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Collapses by volume: against costs computed anew, and what must stay as it is.
#include "vcg_core/fit/redistribute.h"

#include <Eigen/LU>

#include "tests/unit/support/network_starts.h"

namespace neuralmesh::volume_collapse_test {

PerVertex<char> nobody(const Network& network) { return PerVertex<char>(network.slot_count(), 0); }

void reduce(Network& network, int vertices) { collapse_by_volume(network, vertices, nobody(network)); }

/// The place of an edge and its cost by Lindstrom and Turk, from the faces of the mesh: the least sum of
/// squared volumes under the constraint that the volume stays, by the method of Lagrange. The weight of the
/// shape is that of the code.
std::pair<Eigen::Vector3d, double> place_of(const Network& network, VertexId a, VertexId b) {
    const auto at = [&](VertexId v) { return to_eigen(network.position(v)).cast<double>().eval(); };
    Eigen::Matrix4d system = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    std::vector<std::pair<Eigen::Vector3d, double>> planes;
    for (const Triangle& f : network.faces()) {
        if (std::none_of(f.begin(), f.end(), [&](VertexId v) { return v == a || v == b; })) continue;
        const Eigen::Vector3d normal = (at(f[1]) - at(f[0])).cross(at(f[2]) - at(f[0]));
        planes.emplace_back(normal, normal.dot(at(f[0])));
    }
    for (const auto& [normal, offset] : planes) {
        system.topLeftCorner<3, 3>() += normal * normal.transpose();
        right.head<3>() += offset * normal;
        system.topRightCorner<3, 1>() += normal;
        right[3] += offset;
    }
    system.bottomLeftCorner<1, 3>() = system.topRightCorner<3, 1>().transpose();
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    int neighbours = 0;
    for (const VertexId v : {a, b})
        for (const VertexId w : network.ring(v))
            if (w != a && w != b) {
                mean += at(w);
                ++neighbours;
            }
    const double shape = 1e-4 * system.topLeftCorner<3, 3>().trace();
    system.topLeftCorner<3, 3>() += shape * Eigen::Matrix3d::Identity();
    right.head<3>() += shape * mean / neighbours;
    const Eigen::Vector3d place = system.fullPivLu().solve(right).head<3>();
    double cost = 0;
    for (const auto& [normal, offset] : planes)
        cost += (normal.dot(place) - offset) * (normal.dot(place) - offset);
    return {place, cost};
}

/// What the length of an edge adds to that cost.
double cost_of_length(const Network& network, VertexId a, VertexId b, double short_length) {
    const double length =
        (to_eigen(network.position(a)) - to_eigen(network.position(b))).cast<double>().norm();
    return 0.01 * std::pow(short_length, 4) * std::pow(std::min(length, short_length), 2);
}

class VolumeCollapseWith : public testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(ShortLengths, VolumeCollapseWith, testing::Values(0, 0.3, 0.6));

TEST_P(VolumeCollapseWith, TakesTheEdgeOfLeastCostToItsPlace) {
    const double short_length = GetParam();
    Network network = network_of(shapes::icosphere(2), 0.05);
    for (int times = 0; times < 30; ++times) {
        const Network before = network;
        const auto cost_of = [&](VertexId a, VertexId b) {
            return place_of(before, a, b).second + cost_of_length(before, a, b, short_length);
        };
        const std::vector<DoneCollapse> done =
            collapse_by_volume(network, network.vertex_count() - 1, nobody(network), short_length);
        ASSERT_EQ(done.size(), 1U);
        const Eigen::Vector3d place = place_of(before, done[0].gone, done[0].into).first;
        const double cost = cost_of(done[0].gone, done[0].into);
        const vcg::Point3d where(place[0], place[1], place[2]);
        EXPECT_LE((vcg::Point3d::Construct(before.position(done[0].into)) - where).Norm(),
                  (vcg::Point3d::Construct(before.position(done[0].gone)) - where).Norm() + 1e-9);
        EXPECT_LT((to_eigen(network.position(done[0].into)).cast<double>() - place).norm(), 1e-5);
        int cheaper = 0;
        for (const VertexId v : before.vertices())
            for (const VertexId w : before.ring(v))
                cheaper += v < w && cost_of(v, w) < cost * (1 - 1e-6) ? 1 : 0;
        EXPECT_EQ(cheaper, 0);
    }
}

// The costs of edges are kept, and computed anew only around a collapse.
TEST_P(VolumeCollapseWith, ManyAtOnceAreThoseOneByOne) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        Network at_once = network_of(shapes::torus_grid(24, 12), 0.02, seed);
        Network one_by_one = at_once;
        collapse_by_volume(at_once, 40, nobody(at_once), GetParam());
        for (int vertices = one_by_one.vertex_count() - 1; vertices >= 40; --vertices)
            collapse_by_volume(one_by_one, vertices, nobody(one_by_one), GetParam());
        EXPECT_EQ(at_once.vertex_count(), 40);
        ASSERT_EQ(at_once.faces(), one_by_one.faces());
        for (const VertexId v : at_once.vertices()) EXPECT_EQ(at_once.position(v), one_by_one.position(v));
    }
}

TEST(VolumeCollapse, KeepsTopologyAndVolume) {
    for (const Shape& shape : {shapes::icosphere(3), shapes::torus_grid(40, 20)}) {
        Network network = network_of(shape, 0.005);
        const Census before = census(network.faces());
        const double volume = enclosed_volume(network);
        for (const int vertices : {400, 200, 100}) {
            reduce(network, vertices);
            EXPECT_EQ(network.vertex_count(), vertices);
            expect_sound(network, before);
            EXPECT_NEAR(enclosed_volume(network), volume, 1e-5 * volume);
        }
        EXPECT_GE(worst_quality(network), 0.1F);
    }
}

TEST(VolumeCollapse, LeavesTheCornersOfACube) {
    Network network = network_of(shapes::fine_cube(3));
    ASSERT_EQ(network.vertex_count(), 386);
    reduce(network, 8);
    EXPECT_EQ(network.vertex_count(), 8);
    for (const VertexId v : network.vertices())
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::abs(network.position(v)[k]), 0.5, 1e-3);
}

// Beside a sharp edge the fitted vertices are close together and a little off it.
TEST(VolumeCollapse, TakesShortEdgesBesideACreaseBeforeFlatOnes) {
    const Shape cube = shapes::fine_cube(3);
    Network network = network_of(cube);
    VertexId middle = -1;
    for (const VertexId v : network.vertices())
        if (network.position(v) == vcg::Point3f(0, 0.5F, 0.5F)) middle = v;
    ASSERT_GE(middle, 0);
    const int along = network.ring(middle).find_existing([&] {
        for (const VertexId w : network.ring(middle))
            if (network.position(w)[1] == 0.5F && network.position(w)[2] == 0.5F) return w;
        return VertexId{-1};
    }());
    const VertexId added = network.split(middle, along == 0 ? network.ring(middle).valence - 1 : along - 1, 3,
                                         {0.01F, 0.502F, 0.5F});
    ASSERT_EQ(network.validate(), "");
    Network flat_first = network;
    reduce(flat_first, flat_first.vertex_count() - 1);
    EXPECT_TRUE(flat_first.alive(added) && flat_first.alive(middle));
    collapse_by_volume(network, network.vertex_count() - 1, nobody(network), 0.125);
    EXPECT_NE(network.alive(added), network.alive(middle));
}

TEST(VolumeCollapse, LeavesBoundariesAndBarredVertices) {
    Network network = network_of(shapes::grid(12, 12), 0.01);
    const Network before = network;
    PerVertex<char> barred = nobody(network);
    int inner = 0;
    for (const VertexId v : network.vertices())
        if (network.ring(v).open == 0) barred[v] = ++inner % 3 == 0 ? 1 : 0;
    collapse_by_volume(network, 4, barred);
    EXPECT_EQ(network.validate(), "");
    EXPECT_LT(network.vertex_count(), before.vertex_count());
    for (const VertexId v : before.vertices()) {
        if (before.ring(v).open == 0 && barred[v] == 0) continue;
        ASSERT_TRUE(network.alive(v));
        EXPECT_EQ(network.position(v), before.position(v));
    }
}

TEST(VolumeCollapse, StopsWhereTheTopologyWouldChange) {
    Network network = network_of(shapes::torus_grid(20, 10));
    reduce(network, 4);
    EXPECT_GE(network.vertex_count(), 7) << "a triangulated torus has at least seven";
    EXPECT_EQ(topology_of(network), kRing);
}

}  // namespace neuralmesh::volume_collapse_test
