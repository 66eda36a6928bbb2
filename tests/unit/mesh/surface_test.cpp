// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The copy of a network's geometry; nearest points of triangles and faces, against samples and a look at
// every face.
#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/mesh/face_tree.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh::surface_test {

// The nearest point of a triangle against a dense sampling of the triangle.

Vector3 in_cube(Random& random) { return to_eigen(vcg::Point3f::Construct(shapes::in_cube(random))); }

/// The least squared distance of \p p from a lattice of points on the triangle.
double sampled_squared_distance(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c,
                                int steps) {
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
            const float s = static_cast<float>(i) / static_cast<float>(steps);
            const float t = static_cast<float>(j) / static_cast<float>(steps);
            const Vector3 q = a + s * (b - a) + t * (c - a);
            least = std::min(least, static_cast<double>((p - q).squaredNorm()));
        }
    return least;
}

void expect_foot(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c, double tolerance) {
    constexpr int kSteps = 100;
    const Foot foot = foot_on_triangle(p, a, b, c);
    const auto& w = foot.weights;
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-5);
    for (float weight : w) EXPECT_GE(weight, -1e-6F);
    const Vector3 q = w[0] * a + w[1] * b + w[2] * c;
    EXPECT_NEAR((p - q).norm(), std::sqrt(foot.squared_distance), tolerance);
    const double sampled = std::sqrt(sampled_squared_distance(p, a, b, c, kSteps));
    const double spacing =
        static_cast<double>(std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()})) / kSteps;
    const double found = std::sqrt(static_cast<double>(foot.squared_distance));
    EXPECT_LE(found, sampled + tolerance);
    EXPECT_GE(found, sampled - spacing);
}

TEST(FootOnTriangle, IsTheNearestOfManySamples) {
    Random random(1);
    for (int i = 0; i < 500; ++i)
        expect_foot(2 * in_cube(random), in_cube(random), in_cube(random), in_cube(random), 1e-5);
}

// The corners of a needle lie on a line only up to rounding.
TEST(FootOnTriangle, IsRightOnDegenerateTriangles) {
    Random random(2);
    for (int i = 0; i < 100; ++i) {
        const Vector3 a = in_cube(random);
        const Vector3 b = in_cube(random);
        expect_foot(2 * in_cube(random), a, b, 0.25F * a + 0.75F * b, 1e-3);
        expect_foot(2 * in_cube(random), a, b, b, 1e-3);
        expect_foot(2 * in_cube(random), a, a, a, 1e-5);
    }
}

// Callers tell the inside from the border by weights of exactly 0.
TEST(FootOnTriangle, GivesCornersWithoutAPartTheWeightZero) {
    const Vector3 a(0, 0, 0);
    const Vector3 b(1, 0, 0);
    const Vector3 c(0, 1, 0);
    EXPECT_EQ(foot_on_triangle(Vector3(-1, -1, 1), a, b, c).weights, (std::array<float, 3>{1, 0, 0}));
    EXPECT_EQ(foot_on_triangle(Vector3(2, -1, 1), a, b, c).weights, (std::array<float, 3>{0, 1, 0}));
    EXPECT_EQ(foot_on_triangle(Vector3(0.5F, -1, 0), a, b, c).weights[2], 0);
    EXPECT_EQ(foot_on_triangle(Vector3(-1, 0.5F, 0), a, b, c).weights[1], 0);
    EXPECT_EQ(foot_on_triangle(Vector3(1, 1, 0), a, b, c).weights[0], 0);
}

/// Of a lattice of few places, so that triangles may be degenerate, and points lie on borders of regions.
Vector3 on_lattice(Random& random) {
    const auto coordinate = [&] { return 0.25F * static_cast<float>(random.below(5)) - 0.5F; };
    const float x = coordinate(), y = coordinate();
    return {x, y, coordinate()};
}

TEST(SquaredDistanceToTriangle, HasTheBitsOfTheFoot) {
    Random random(11);
    for (int run = 0; run < 20000; ++run) {
        const auto place = [&] { return run % 2 == 0 ? on_lattice(random) : in_cube(random); };
        const Vector3 ab = place(), ac = place();
        std::array<Vector3, 8> points;
        EightVectors lanes;
        for (std::size_t i = 0; i < points.size(); ++i) {
            points[i] = place();
            lanes.x[i] = points[i][0];
            lanes.y[i] = points[i][1];
            lanes.z[i] = points[i][2];
        }
        Eight squared;
        squared_distance_to_triangle(ab, ac, lanes, squared);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const float expected = foot_on_triangle(ab, ac, points[i]).squared_distance;
            ASSERT_TRUE(squared[i] == expected || (std::isnan(squared[i]) && std::isnan(expected)))
                << squared[i] << " for " << expected << ", run " << run;
        }
    }
}

/// 1 + 1 is even in the last place of 2^24 and 2^53; 1 alone is rounded off.
TEST(Triangle, AddsTheLastTwoOfThreeTermsFirstOnEveryProcessor) {
    const Eigen::Vector3f floats(0x1p24F, 1, 1);
    EXPECT_EQ(floats.dot(Eigen::Vector3f::Ones()), 0x1p24F + 2);
    const Eigen::Vector3d doubles(0x1p53, 1, 1);
    EXPECT_EQ(doubles.dot(Eigen::Vector3d::Ones()), 0x1p53 + 2);
}

// The copy of a network's geometry, and searches for nearest faces against a look at every face.

Network network_with_free_slots() {
    Network network = network_of(shapes::icosphere(2), 0.02);
    Random random(4);
    for (int i = 0; i < 40; ++i) {
        const auto gone = any_slot(network, random);
        if (network.alive(gone) && network.can_collapse(gone, network.ring(gone)[0]))
            network.collapse(gone, network.ring(gone)[0]);
    }
    return network;
}

/// The nearest of \p faces by looking at all.
Hit nearest_of(const Surface& surface, const std::vector<int>& faces, const Vector3& p) {
    std::vector<Triangle> corners;
    for (const int f : faces) corners.push_back(surface.faces[f]);
    Hit hit = nearest_face(p, surface.positions, corners);
    hit.face = faces.at(static_cast<std::size_t>(hit.face));
    return hit;
}

std::vector<int> every(int step, const Surface& surface) {
    std::vector<int> faces;
    for (int f = 0; f < surface.face_count(); f += step) faces.push_back(f);
    return faces;
}

bool boxes_touch(const Surface& surface, int f, int g) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const auto range = [&](int face) {
            return std::minmax({surface.corner(face, 0)[axis], surface.corner(face, 1)[axis],
                                surface.corner(face, 2)[axis]});
        };
        if (range(f).first > range(g).second || range(g).first > range(f).second) return false;
    }
    return true;
}

TEST(Surface, HasTheFacesOfTheNetworkAroundEveryVertex) {
    const Network network = network_with_free_slots();
    ASSERT_LT(network.vertex_count(), network.slot_count());
    const Surface surface(network);
    EXPECT_EQ(surface.faces.vector(), network.faces());
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        const Span<const int> around = surface.faces_around(v);
        EXPECT_EQ(around.size(), network.ring(v).face_count());
        EXPECT_TRUE(std::is_sorted(around.begin(), around.end()));
        for (int f : around) {
            const Triangle& face = surface.faces[f];
            EXPECT_TRUE(std::find(face.begin(), face.end(), v) != face.end());
        }
    }
}

TEST(Surface, KnowsTheNormalsOfNeighbouringFacesAndItsBoundary) {
    EXPECT_FALSE(Surface(network_of(shapes::icosphere(1))).has_boundary());
    const Network network = network_of(shapes::grid(4, 4), 0.01);
    const Surface surface(network);
    int boundary_edges = 0;
    for (int f = 0; f < surface.face_count(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = surface.faces[f][k], b = surface.faces[f][(k + 1) % 3];
            Vector3 expected = Vector3::Zero();
            for (int g = 0; g < surface.face_count(); ++g)
                for (std::size_t j = 0; j < 3; ++j)
                    if (surface.faces[g][j] == b && surface.faces[g][(j + 1) % 3] == a)
                        expected = unit_normal(surface, g);
            EXPECT_LT((normal_beyond(surface, a, b) - expected).norm(), 1e-6);
            const bool on_boundary = expected.isZero();
            boundary_edges += on_boundary ? 1 : 0;
            EXPECT_EQ(surface.on_boundary(f, k), on_boundary);
            Foot middle = foot_on_triangle((surface.positions[a] + surface.positions[b]) / 2,
                                           surface.corner(f, 0), surface.corner(f, 1), surface.corner(f, 2));
            middle.weights[(k + 2) % 3] = 0;
            EXPECT_EQ(is_beyond_boundary(surface, {f, middle}), on_boundary);
        }
    EXPECT_EQ(boundary_edges, 2 * network.edge_count() - 3 * surface.face_count());
}

TEST(Surface, HasAMeanEdgeLength) {
    const double diagonal = std::sqrt(2.0);  // of a cube's side, of whose 18 edges 12 have length 1
    EXPECT_NEAR(mean_edge_length(Surface(network_of(shapes::cube()))), (12 + 6 * diagonal) / 18, 1e-6);
}

TEST(Surface, SpreadsValuesOverRings) {
    const Network network = network_of(shapes::icosphere(2));
    PerVertex<float> values(network.slot_count(), 0);
    values[5] = 1;
    spread_over_rings(network, values, 1);
    for (VertexId v : network.vertices()) EXPECT_EQ(values[v], v == 5 || network.adjacent(5, v) ? 1 : 0);
    PerVertex<float> ones(network.slot_count(), 1);
    spread_over_rings(network, ones, 2);
    for (VertexId v : network.vertices()) {
        float expected = static_cast<float>(network.ring(v).valence + 1);
        for (VertexId u : network.ring(v)) expected += static_cast<float>(network.ring(u).valence + 1);
        EXPECT_EQ(ones[v], expected);
    }
}

void expect_same(const Hit& found, const Hit& expected) {
    EXPECT_EQ(found.face, expected.face);
    EXPECT_EQ(found.foot.squared_distance, expected.foot.squared_distance);
    EXPECT_EQ(found.foot.weights, expected.foot.weights);
}

TEST(FaceTree, FindsTheNearestFace) {
    const Surface surface(network_of(shapes::torus_grid(20, 10), 0.05));
    Random random(5);
    ThreadTeam team(1);
    for (int step : {1, 3, 5, 50, 120, 399}) {  // leaves of 1 to 4 faces, on one or two levels
        const std::vector<int> faces = every(step, surface);
        const FaceTree tree(surface, faces, team);
        for (int i = 0; i < 300; ++i) {
            const Vector3 p = 1.5F * in_cube(random);
            expect_same(tree.nearest(p), nearest_of(surface, faces, p));
        }
    }
}

TEST(FaceTree, DoesNotDependOnTheNumberOfThreads) {
    const Surface surface(network_of(shapes::torus_grid(90, 60), 0.01));
    ThreadTeam one(1), three(3);
    const FaceTree tree(surface, one), same(surface, three);
    ASSERT_EQ(tree.group_count(), same.group_count());
    for (int i = 0; i < tree.group_count(); ++i) {
        std::vector<std::pair<int, int>> pairs, same_pairs;
        tree.for_overlapping_pairs(i, [&](int f, int g) { pairs.emplace_back(f, g); });
        same.for_overlapping_pairs(i, [&](int f, int g) { same_pairs.emplace_back(f, g); });
        ASSERT_EQ(pairs, same_pairs);
    }
}

/// Near the surface, on its vertices, where several faces are equally near, and far away.
std::vector<Vector3> probes(const Surface& surface, std::size_t count, Random& random) {
    std::vector<Vector3> points = surface.positions.vector();
    while (points.size() < count) {
        const auto v =
            static_cast<VertexId>(random.below(static_cast<std::uint32_t>(surface.positions.size())));
        points.push_back(surface.positions[v] + 0.05F * in_cube(random));
        if (points.size() % 9 == 0) points.back() = 3 * in_cube(random);
    }
    return points;
}

// Points beside the edges of flat squares: rounding decides which of two faces is nearer, and a box may seem
// farther than the face in it.
TEST(FaceTree, FindsTheNearestFaceWhereRoundingDecides) {
    Random random(9);
    const Surface surface(network_of(shapes::cube()));
    const FaceTree tree(surface, one_thread());
    const std::vector<Vector3> points = probes(surface, 4000, random);
    const std::vector<Hit> hits = tree.nearest(points, one_thread());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Hit expected = nearest_of(surface, every(1, surface), points[i]);
        expect_same(tree.nearest(points[i]), expected);
        expect_same(hits[i], expected);
    }
}

TEST(FaceTree, FindsNothingWithoutFaces) {
    const Surface surface(network_of(shapes::cube()));
    const FaceTree tree(surface, {}, one_thread());
    EXPECT_EQ(tree.nearest({0, 0, 0}).face, -1);
    EXPECT_EQ(tree.nearest({{0, 0, 0}}, one_thread()).at(0).face, -1);
    tree.for_overlapping(surface, 0, [](int) { ADD_FAILURE(); });
}

TEST(FaceTree, FindsAllPairsOfOverlappingBoxesOnce) {
    const Surface surface(network_of(shapes::icosphere(2), 0.1));
    std::set<std::pair<int, int>> expected;
    for (int f = 0; f < surface.face_count(); ++f)
        for (int g = f + 1; g < surface.face_count(); ++g)
            if (boxes_touch(surface, f, g)) expected.emplace(f, g);
    ThreadTeam team(1);
    const FaceTree tree(surface, team);
    std::set<std::pair<int, int>> found;
    for (int i = 0; i < tree.group_count(); ++i)
        tree.for_overlapping_pairs(i, [&](int f, int g) {
            EXPECT_TRUE(found.emplace(std::min(f, g), std::max(f, g)).second) << "twice";
        });
    EXPECT_EQ(found, expected);
    for (int f = 0; f < surface.face_count(); f += 7) {
        std::set<int> overlapping;
        tree.for_overlapping(surface, f, [&](int g) { overlapping.insert(g); });
        for (int g = 0; g < surface.face_count(); ++g)
            EXPECT_EQ(overlapping.count(g) == 1, boxes_touch(surface, f, g));
    }
}

// The walk looks at few faces: on a smooth surface, from a start near by, it finds the nearest of all.
TEST(FaceWalk, FindsTheNearestFaceOfASmoothSurface) {
    const Network network = network_of(shapes::torus_grid(40, 20), 0.002);
    const Surface surface(network);
    const std::vector<int> faces = every(1, surface);
    for (const vcg::Point3d& point : shapes::torus_cloud(400, 0.01)) {
        const Vector3 p = to_eigen(vcg::Point3f::Construct(point));
        const Hit exact = nearest_of(surface, faces, p);
        const WalkStart there = walk_start_of(surface, exact);
        EXPECT_EQ(surface.faces_around(there.vertex)[there.turn], exact.face);
        for (const WalkStart start :
             {there, WalkStart{there.vertex, 99}, WalkStart{network.ring(there.vertex)[0], 1}})
            EXPECT_EQ(walk_to_nearest(surface, p, start).foot.squared_distance, exact.foot.squared_distance);
    }
}

// From anywhere it ends at a face that is no further than those around its start.
TEST(FaceWalk, NeverEndsFurtherThanItBegan) {
    const Surface surface(network_of(shapes::torus_grid(20, 10), 0.1));
    Random random(6);
    for (int i = 0; i < 500; ++i) {
        const Vector3 p = 1.5F * in_cube(random);
        const auto v =
            static_cast<VertexId>(random.below(static_cast<std::uint32_t>(surface.positions.size())));
        const Span<const int> around = surface.faces_around(v);
        const Hit at_start = nearest_of(surface, {around.begin(), around.end()}, p);
        EXPECT_LE(walk_to_nearest(surface, p, {v, 0}).foot.squared_distance, at_start.foot.squared_distance);
    }
}

}  // namespace neuralmesh::surface_test
