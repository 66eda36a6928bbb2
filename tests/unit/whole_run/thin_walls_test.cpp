// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Walls thinner than the edges of the mesh are long: both of their sides are learned, and do not cross.
#include "tests/unit/support/crumpled.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::thin_walls_test {

constexpr double kWall = 0.03;

/// Of exactly that many vertices, whose faces do not go through each other.
NeuralMesh uncut_mesh(const Cloud& cloud, int vertices) {
    NeuralMesh mesh = learn_exactly(cloud, with_target(vertices));
    EXPECT_TRUE(cut_faces(network_of({mesh.positions, mesh.faces})).empty());
    return mesh;
}

/// A random point of the surface of the box around the origin with the given \p edges, or nothing: of a side
/// of the area \p largest always a point, of smaller ones as much more seldom.
std::optional<vcg::Point3d> point_of_box(const vcg::Point3d& edges, double largest, Random& random) {
    vcg::Point3d p = shapes::in_cube(random);
    const int k = static_cast<int>(random.below(3));
    const double area = edges[(k + 1) % 3] * edges[(k + 2) % 3];
    if (shapes::unit(random) > area / largest) return {};
    p[k] = p[k] < 0 ? -1 : 1;
    for (int i = 0; i < 3; ++i) p[i] *= edges[i] / 2;
    return p;
}

/// A box with four walls and a floor, open at the top.
Cloud open_box(int count) {
    Cloud cloud;
    Random random(3);
    const vcg::Point3d outside(1, 0.8, 0.6), inside(1 - 2 * kWall, 0.8 - 2 * kWall, 0.6);
    while (static_cast<int>(cloud.size()) < count) {
        // The surface of the outside, or that of the inside, which is open at the top.
        const bool outer = random.below(2) == 0;
        std::optional<vcg::Point3d> p = point_of_box(outer ? outside : inside, 0.8, random);
        if (!p) continue;
        if (!outer) (*p)[2] += kWall;
        const bool at_top = (*p)[2] > 0.6 / 2 - 1e-9;
        const bool over_opening = std::abs((*p)[0]) < 0.5 - kWall && std::abs((*p)[1]) < 0.4 - kWall;
        if (at_top && (over_opening || !outer)) continue;
        cloud.push_back(*p);
    }
    return cloud;
}

/// \p count points of the surface of the box around the origin with the given \p edges.
void add_box(const vcg::Point3d& edges, std::size_t count, Random& random, Cloud& cloud) {
    for (const std::size_t end = cloud.size() + count; cloud.size() < end;)
        if (const auto p = point_of_box(edges, edges[0] * edges[1], random)) cloud.push_back(*p);
}

/// How far \p p is from the surface of the box around the origin with the given \p edges.
double distance_from_box(const vcg::Point3d& p, const vcg::Point3d& edges) {
    vcg::Point3d outside;
    double depth = -HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
        outside[k] = std::max(0.0, std::abs(p[k]) - edges[k] / 2);
        depth = std::max(depth, std::abs(p[k]) - edges[k] / 2);
    }
    return depth > 0 ? outside.Norm() : -depth;
}

// Of cloud 4 the inner box was filled, because the wall has as many places of contact with it as with the
// outside: the mean distance was .0146. Of cloud 9 points along the edges of the inner box were told as of
// the outer one, and vertices went over to the other box while they landed: .00095.
TEST(ThinWalls, OfNestedBoxesKeepTheirSides) {
    constexpr std::size_t kPoints = 40000;  // four spacings through the wall
    const vcg::Point3d outer(1, 0.8, 0.6), inner(0.92, 0.72, 0.52);
    Cloud cloud;
    Random random(4);
    add_box(outer, kPoints, random, cloud);
    add_box(inner, kPoints, random, cloud);
    const NeuralMesh mesh = uncut_mesh(cloud, 2000);
    EXPECT_EQ(topology_of(mesh), (Topology{2, 0, 0}));
    double sum = 0;
    for (const auto& position : mesh.positions) {
        const auto p = vcg::Point3d::Construct(position);
        const double distance = std::min(distance_from_box(p, outer), distance_from_box(p, inner));
        sum += distance * distance;
    }
    EXPECT_LT(std::sqrt(sum / static_cast<double>(mesh.positions.size())), 0.0006);
}

// Without thicker walls while learning, 199 of the 2,996 faces cut others.
TEST(ThinWalls, OfAnOpenBoxDoNotCross) {
    constexpr int kPoints = 40000;  // their spacing is a third of the wall, whose thickness is half an edge
    const NeuralMesh mesh = uncut_mesh(open_box(kPoints), 1500);
    EXPECT_EQ(topology_of(mesh), kBall);
    EXPECT_LT(mesh.report.rms_error, 100 * kWall / 10);
}

}  // namespace neuralmesh::thin_walls_test
