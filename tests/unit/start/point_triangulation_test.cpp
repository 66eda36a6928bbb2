// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The triangulation of points with normals, and what is cut from it.
#include "vcg_core/start/point_triangulation.h"

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/shapes.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/non_manifold_vertices.h"
#include "vcg_core/start/short_handles.h"

namespace neuralmesh::point_triangulation_test {

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
    EXPECT_EQ(topology_of(network), kDisc);
    for (const Triangle& f : network.faces()) {
        const auto at = [&](std::size_t k) { return network.position(f[k]); };
        EXPECT_GT(((at(1) - at(0)) ^ (at(2) - at(0)))[2], 0) << "faces the side of the normals";
    }
}

TEST(PointTriangulation, OfASphereIsClosed) {
    const Shape sphere = shapes::icosphere(4);
    Sample sample;
    for (const vcg::Point3d& p : sphere.positions)
        sample.add(Point3f::Construct(p), Point3f::Construct(p), 0.06F);
    std::vector<int> source;
    const Network network = network_of(sample, source, 3);
    EXPECT_EQ(network.vertex_count(), static_cast<int>(sphere.positions.size()));
    EXPECT_EQ(topology_of(network), kBall);
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

/// Joins two squares of \p side x \p side points, one after the other, along the square from \p low to \p
/// high.
void add_wall(IndexedMesh<float>& mesh, int side, int low, int high, bool turned) {
    std::vector<int> ring;
    for (int i = low; i < high; ++i) ring.push_back(i * side + low);
    for (int k = low; k < high; ++k) ring.push_back(high * side + k);
    for (int i = high; i > low; --i) ring.push_back(i * side + high);
    for (int k = high; k > low; --k) ring.push_back(low * side + k);
    const int above = side * side;
    for (std::size_t n = 0; n < ring.size(); ++n) {
        const int a = ring[n], b = ring[(n + 1) % ring.size()];
        for (Triangle face : {Triangle{a, b, b + above}, Triangle{a, b + above, a + above}}) {
            if (turned) std::swap(face[1], face[2]);
            mesh.faces.push_back(face);
        }
    }
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
    add_wall(mesh, side, low, high, true);
    return mesh;
}

/// Their outer boundaries joined by a wall, so that the tube is a handle.
IndexedMesh<float> closed_with_tube(int side, int hole) {
    IndexedMesh<float> mesh = joined_squares(side, hole);
    add_wall(mesh, side, 0, side - 1, false);
    return mesh;
}

TEST(ShortHandles, AreCutAndLongOnesStay) {
    for (const bool is_short : {true, false}) {
        IndexedMesh<float> mesh = closed_with_tube(24, is_short ? 1 : 6);
        std::vector<int> source(mesh.positions.size());
        drop_unused_vertices(mesh, source);
        const Network before(mesh.positions, mesh.faces);
        ASSERT_EQ(topology_of(before), kRing);
        // Around the tube leads a loop of four edges or 24; along it and back outside, always more.
        EXPECT_EQ(cut_short_handles(mesh, 8, source), is_short ? 1 : 0);
        const Network after(mesh.positions, mesh.faces);
        EXPECT_EQ(topology_of(after), (is_short ? Topology{1, 0, 2} : kRing));
        EXPECT_EQ(source.size(), mesh.positions.size());
    }
}

}  // namespace neuralmesh::point_triangulation_test
