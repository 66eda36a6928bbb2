// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Meshes with fewer vertices, filled holes, and bodies within hollows.
#include "vcg_core/mesh/simplify.h"
#include "tests/unit/support/network_starts.h"
#include "vcg_core/mesh/boundary_loops.h"

namespace neuralmesh::simplify_test {

using vcg::Point3f;

/// Simplifies \p shape to each of the numbers of vertices and checks what simplify() promises.
void expect_simplified(const Shape& shape, const std::vector<int>& counts) {
    const Network before = network_of(shape);
    const Census topology = census(before.faces());
    const double volume = enclosed_volume(before);
    for (const int vertices : counts) {
        SCOPED_TRACE(testing::Message() << before.vertex_count() << " to " << vertices);
        Network network = before;
        simplify(network, vertices);
        ASSERT_EQ(network.validate(), "");
        const Census now = census(network.faces());
        EXPECT_EQ(now.breach, "");
        EXPECT_TRUE(now.same_topology(topology));
        EXPECT_EQ(network.vertex_count(), std::min(vertices, before.vertex_count()));
        EXPECT_LE(now.greatest_valence(), 12);
        if (vertices < 100) continue;
        EXPECT_NEAR(enclosed_volume(network), volume, 0.2 * volume);
    }
}

TEST(Simplify, GivesTheExactNumberOfVertices) {
    expect_simplified(shapes::icosphere(4), {12, 50, 100, 500, 2000, 2562, 5000});
}

TEST(Simplify, KeepsHandles) { expect_simplified(shapes::torus_grid(60, 30), {40, 100, 500, 1799}); }

TEST(Simplify, KeepsComponents) {
    expect_simplified(together(shapes::torus_grid(40, 20), shapes::icosphere(3), {4, 0, 0}), {80, 300, 1000});
}

TEST(Simplify, StopsWhereTheTopologyNeedsMoreVertices) {
    Network network = network_of(shapes::torus_grid(40, 20));
    simplify(network, 4);
    EXPECT_EQ(topology_of(network), kRing);
    EXPECT_GE(network.vertex_count(), 7) << "the smallest triangulation of a torus";
    EXPECT_LE(network.vertex_count(), 30);
}

/// Checks the lengths of the edges, and that a share of \p regular of the valences is 5, 6 or 7.
void expect_even(const Network& network, double regular) {
    double shortest = 1e30;
    double sum = 0;
    int ends = 0;
    int count = 0;
    for (const VertexId v : network.vertices()) {
        count += network.ring(v).valence >= 5 && network.ring(v).valence <= 7 ? 1 : 0;
        for (const VertexId w : network.ring(v)) {
            const auto length = static_cast<double>((network.position(v) - network.position(w)).Norm());
            shortest = std::min(shortest, length);
            sum += length;
            ++ends;
        }
    }
    EXPECT_GT(shortest, 0.3 * sum / ends);
    EXPECT_GE(count, regular * network.vertex_count());
}

TEST(Simplify, MakesEvenTrianglesOfLongOnes) {
    Network network = network_of(shapes::torus_grid(200, 12));
    simplify(network, 400);
    expect_even(network, 0.99);
}

TEST(Simplify, MakesEvenTrianglesOfRoughOnes) {
    Shape rough = shapes::icosphere(4);
    Random random(1);
    for (vcg::Point3d& p : rough.positions) p *= 1 + 0.1 * shapes::unit(random);
    Network network = network_of(rough);
    simplify(network, 500);
    expect_even(network, 0.98);
}

TEST(Simplify, MakesEdgesInProportionToTheLengthsAskedFor) {
    Network network = network_of(shapes::icosphere(5));
    PerVertex<float> lengths(network.slot_count(), 0.1F);
    for (const VertexId v : network.vertices())
        if (network.position(v)[0] > 0) lengths[v] = 0.3F;
    simplify(network, 1000, lengths);
    ASSERT_EQ(network.validate(), "");
    EXPECT_EQ(network.vertex_count(), 1000);
    int coarse = 0;
    for (const VertexId v : network.vertices()) coarse += network.position(v)[0] > 0 ? 1 : 0;
    // A ninth of the vertices of the other half, and those near the border.
    EXPECT_GT(coarse, 80);
    EXPECT_LT(coarse, 200);
}

IndexedMesh<float> mesh_of(const Network& network) { return {positions_of(network), network.faces()}; }

TEST(BoundaryLoops, AreFound) {
    const Network tube = network_of(shapes::tube(7, 3));
    const auto loops = boundary_loops(tube.slot_count(), tube.faces());
    ASSERT_EQ(loops.size(), 2U);
    for (const auto& loop : loops) {
        EXPECT_EQ(loop.size(), 7U);
        for (std::size_t i = 0; i < loop.size();
             ++i)  // the first of an open ring is the next on the boundary
            EXPECT_EQ(tube.ring(loop[i])[0], loop[(i + 1) % loop.size()]);
    }
    const Network sphere = network_of(shapes::icosphere(2));
    EXPECT_TRUE(boundary_loops(sphere.slot_count(), sphere.faces()).empty());
}

TEST(BoundaryLoops, AreMeasuredByTheSmallestSphere) {
    EXPECT_NEAR(smallest_sphere_diameter({{0, 0, 0}, {2, 0, 0}}), 2, 0.02);
    EXPECT_NEAR(smallest_sphere_diameter({{0, 0, 0}, {2, 0, 0}, {1, 0.3F, 0}}), 2, 0.02);
    EXPECT_NEAR(smallest_sphere_diameter({{1, 0, 0}, {-0.5F, 0.8660254F, 0}, {-0.5F, -0.8660254F, 0}}), 2,
                0.03);
    EXPECT_EQ(smallest_sphere_diameter({{3, 4, 5}}), 0);
}

TEST(BoundaryLoops, AreFilledToClosedManifolds) {
    for (const int around : {3, 4, 5, 12, 40}) {
        SCOPED_TRACE(around);
        const Network tube = network_of(shapes::tube(around, 4));
        IndexedMesh<float> mesh = mesh_of(tube);
        const auto loops = boundary_loops(tube.slot_count(), mesh.faces);
        HoleFiller filler(mesh, loops, 12);
        for (const auto& loop : loops) ASSERT_TRUE(filler.fill(loop));
        const Network closed(mesh.positions, mesh.faces);
        EXPECT_EQ(topology_of(closed), kBall);
        EXPECT_EQ(closed.vertex_count(), tube.vertex_count());
        for (const VertexId v : closed.vertices()) EXPECT_LE(closed.ring(v).valence, 12);
    }
}

TEST(BoundaryLoops, StayOpenWhereVerticesWouldGetTooManyNeighbours) {
    const Network tube = network_of(shapes::tube(12, 3));
    IndexedMesh<float> mesh = mesh_of(tube);
    const auto loops = boundary_loops(tube.slot_count(), mesh.faces);
    HoleFiller filler(mesh, loops, 4);
    EXPECT_FALSE(filler.fill(loops[0]));
    EXPECT_EQ(mesh.faces, tube.faces());
    EXPECT_EQ(static_cast<int>(mesh.positions.size()), tube.vertex_count());
}

// Bodies within hollows of bodies: depth and orientation of their surfaces.

/// Octahedra, each given by its centre and its radius; those with a negative radius are inside out.
struct Octahedron {
    Point3f centre;
    float radius;
};

Network octahedra(const std::vector<Octahedron>& all) {
    std::vector<Point3f> positions;
    std::vector<Triangle> faces;
    for (const Octahedron& each : all) {
        const int first = static_cast<int>(positions.size());
        for (int k = 0; k < 6; ++k) {
            Point3f p(0, 0, 0);
            p[k / 2] = k % 2 == 0 ? each.radius : -each.radius;
            positions.push_back(each.centre + p);
        }
        for (const int x : {0, 1})
            for (const int y : {2, 3})
                for (const int z : {4, 5}) {
                    const bool even = (x + y + z) % 2 == 0;
                    faces.push_back({first + x, first + (even ? y : z), first + (even ? z : y)});
                }
    }
    return {positions, faces};
}

double volume_of(const Network& network, int of) {
    const PerVertex<int> component = network.components();
    double volume = 0;
    for (const Triangle& f : network.faces()) {
        if (component[f[0]] != of) continue;
        const auto p = [&](std::size_t k) { return vcg::Point3d::Construct(network.position(f[k])); };
        volume += p(0) * (p(1) ^ p(2)) / 6;
    }
    return volume;
}

/// Whether each component is within an odd number of others, by how it is oriented.
std::vector<bool> hollows_of(Network network) {
    network.orient_outward();
    EXPECT_EQ(network.validate(), "");
    std::vector<bool> hollows;
    for (int i = 0; i < network.component_count(); ++i) hollows.push_back(volume_of(network, i) < 0);
    return hollows;
}

TEST(Nesting, IsFoundWhereRaysMeetEdgesAndVertices) {
    // The ray along x from a vertex of the inner octahedron meets the vertex, and from others the edges, of
    // the outer one.
    const Point3f o(0, 0, 0);
    for (const Point3f& at : {Point3f(-0.1F, 0, 0), Point3f(-0.1F, 0.2F, 0), Point3f(-0.1F, 0, -0.2F)})
        EXPECT_EQ(hollows_of(octahedra({{o, 1}, {at, 0.1F}})), (std::vector<bool>{false, true})) << at[1];
    EXPECT_EQ(hollows_of(octahedra({{o, 1}, {Point3f(-3, 0, 0), 0.1F}})), (std::vector<bool>{false, false}));
}

TEST(Nesting, IsThatOfMostOfAComponent) {
    // The first vertex of the inner surface sticks out of the outer one.
    const Point3f o(0, 0, 0);
    Network network = octahedra({{o, 2}, {o, 1}});
    network.set_position(6, Point3f(2.5F, 0, 0));
    EXPECT_EQ(hollows_of(network), (std::vector<bool>{false, true}));
}

TEST(Nesting, NothingIsWithinAnOpenSurface) {
    const Point3f o(0, 0, 0);
    Network network = octahedra({{o, 4}, {o, 1}});
    // A face of the outer one behind the inner one, from where no ray comes: rays still meet the others.
    const std::vector<Triangle> faces = network.faces();
    const auto behind = std::find_if(faces.begin(), faces.end(), [](const Triangle& f) {
        return std::find(f.begin(), f.end(), 1) != f.end();
    });
    network.exchange_faces({*behind}, {});
    EXPECT_FALSE(hollows_of(network)[1]);
}

TEST(Nesting, OrientsHollowsInward) {
    const Point3f o(0, 0, 0);
    for (const float sign : {1.0F, -1.0F})
        EXPECT_EQ(hollows_of(octahedra({{o, 4 * sign}, {o, 2 * sign}, {o, sign}, {Point3f(9, 0, 0), sign}})),
                  (std::vector<bool>{false, true, false, false}));
}

}  // namespace neuralmesh::simplify_test
