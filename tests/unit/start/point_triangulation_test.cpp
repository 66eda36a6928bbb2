// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The triangulation of points with normals, and what is cut from it.
#include "vcg_core/start/point_triangulation.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "tests/unit/support/shapes.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/pinched_vertices.h"
#include "vcg_core/start/short_handles.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

struct Sample {
    std::vector<Point3f> positions, normals;
    std::vector<float> radii;

    void add(const Point3f& p, const Point3f& n, float radius) {
        positions.push_back(p);
        normals.push_back(n);
        radii.push_back(radius);
    }
};

Network network_of(const Sample& sample, std::vector<int>& source, int threads = 1) {
    ThreadTeam team(threads);
    const IndexedMesh<float> mesh =
        triangulation(sample.positions, sample.normals, sample.radii, team, source);
    const Network network(mesh.positions, mesh.faces);
    EXPECT_EQ(network.validate(), "");
    return network;
}

/// A square of \p side x \p side points one apart, shaken by \p shake, at height \p z.
void add_square(Sample& sample, int side, float shake, float z) {
    Random random(1);
    const auto shaken = [&](int i) { return static_cast<float>(i) + shake * (random.unit() - 0.5F); };
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) sample.add({shaken(i), shaken(k), z}, {0, 0, 1}, 1);
}

TEST(PointTriangulation, OfASquareIsADisc) {
    Sample square;
    add_square(square, 30, 0.4F, 0);
    std::vector<int> source;
    const Network network = network_of(square, source);
    EXPECT_EQ(network.vertex_count(), 900);
    EXPECT_EQ(network.component_count(), 1);
    EXPECT_EQ(network.boundary_loop_count(), 1);
    EXPECT_EQ(network.genus(), 0);
    for (const Triangle& f : network.faces()) {
        const auto at = [&](std::size_t k) { return network.position(f[k]); };
        EXPECT_GT(((at(1) - at(0)) ^ (at(2) - at(0)))[2], 0) << "faces the side of the normals";
    }
}

TEST(PointTriangulation, OfASphereIsClosed) {
    const shapes::Shape sphere = shapes::icosphere(4);
    Sample sample;
    for (const vcg::Point3d& p : sphere.positions)
        sample.add(Point3f::Construct(p), Point3f::Construct(p), 0.06F);
    std::vector<int> source;
    const Network network = network_of(sample, source, 3);
    EXPECT_EQ(network.vertex_count(), static_cast<int>(sphere.positions.size()));
    EXPECT_EQ(network.boundary_loop_count(), 0);
    EXPECT_EQ(network.genus(), 0);
    EXPECT_EQ(network.faces(), network_of(sample, source, 1).faces()) << "with any number of threads";
}

TEST(PointTriangulation, LeavesGapsAndKeepsLayersApart) {
    Sample sample;
    add_square(sample, 12, 0.3F, 0);
    add_square(sample, 12, 0.3F, 2.5F);
    std::vector<int> source;
    EXPECT_EQ(network_of(sample, source).component_count(), 2);
    Sample gap;
    add_square(gap, 12, 0, 0);
    for (const Point3f& p : std::vector<Point3f>(gap.positions)) gap.add(p + Point3f(15, 0, 0), {0, 0, 1}, 1);
    EXPECT_EQ(network_of(gap, source).component_count(), 2);
}

/// Two squares with a square hole each, one above the other, the holes joined by a tube of four sides.
IndexedMesh<float> joined_squares(int side, int hole) {
    IndexedMesh<float> mesh;
    const auto id = [&](int i, int k, int layer) { return (layer * side + i) * side + k; };
    for (int layer = 0; layer < 2; ++layer)
        for (int i = 0; i < side; ++i)
            for (int k = 0; k < side; ++k)
                mesh.positions.emplace_back(static_cast<float>(i), static_cast<float>(k),
                                            static_cast<float>(layer));
    const int low = (side - hole) / 2, high = low + hole;
    const auto add = [&](int a, int b, int c, bool turned) {
        if (turned) std::swap(b, c);
        mesh.faces.push_back({a, b, c});
    };
    for (int layer = 0; layer < 2; ++layer)
        for (int i = 0; i + 1 < side; ++i)
            for (int k = 0; k + 1 < side; ++k) {
                if (i >= low && i < high && k >= low && k < high) continue;
                add(id(i, k, layer), id(i + 1, k, layer), id(i + 1, k + 1, layer), layer == 0);
                add(id(i, k, layer), id(i + 1, k + 1, layer), id(i, k + 1, layer), layer == 0);
            }
    std::vector<std::array<int, 2>> ring;
    for (int i = low; i < high; ++i) ring.push_back({i, low});
    for (int k = low; k < high; ++k) ring.push_back({high, k});
    for (int i = high; i > low; --i) ring.push_back({i, high});
    for (int k = high; k > low; --k) ring.push_back({low, k});
    for (std::size_t n = 0; n < ring.size(); ++n) {
        const auto &a = ring[n], &b = ring[(n + 1) % ring.size()];
        add(id(a[0], a[1], 0), id(b[0], b[1], 0), id(b[0], b[1], 1), true);
        add(id(a[0], a[1], 0), id(b[0], b[1], 1), id(a[0], a[1], 1), true);
    }
    return mesh;
}

/// Their outer boundaries joined by a wall, so that the tube is a handle.
IndexedMesh<float> closed_with_tube(int side, int hole) {
    IndexedMesh<float> mesh = joined_squares(side, hole);
    const auto id = [&](int i, int k, int layer) { return (layer * side + i) * side + k; };
    std::vector<std::array<int, 2>> ring;
    const int last = side - 1;
    for (int i = 0; i < last; ++i) ring.push_back({i, 0});
    for (int k = 0; k < last; ++k) ring.push_back({last, k});
    for (int i = last; i > 0; --i) ring.push_back({i, last});
    for (int k = last; k > 0; --k) ring.push_back({0, k});
    for (std::size_t n = 0; n < ring.size(); ++n) {
        const auto &a = ring[n], &b = ring[(n + 1) % ring.size()];
        mesh.faces.push_back({id(a[0], a[1], 0), id(b[0], b[1], 0), id(b[0], b[1], 1)});
        mesh.faces.push_back({id(a[0], a[1], 0), id(b[0], b[1], 1), id(a[0], a[1], 1)});
    }
    return mesh;
}

TEST(ShortHandles, AreCutAndLongOnesStay) {
    for (const bool is_short : {true, false}) {
        IndexedMesh<float> mesh = closed_with_tube(24, is_short ? 1 : 6);
        std::vector<int> source(mesh.positions.size());
        drop_unused_vertices(mesh, source);
        const Network before(mesh.positions, mesh.faces);
        ASSERT_EQ(before.validate(), "");
        ASSERT_EQ(before.genus(), 1);
        // Around the tube leads a loop of four edges or 24; along it and back outside, always more.
        EXPECT_EQ(cut_short_handles(mesh, 8, source), is_short ? 1 : 0);
        const Network after(mesh.positions, mesh.faces);
        EXPECT_EQ(after.validate(), "");
        EXPECT_EQ(after.genus(), is_short ? 0 : 1);
        EXPECT_EQ(source.size(), mesh.positions.size());
    }
}

}  // namespace
}  // namespace neuralmesh
