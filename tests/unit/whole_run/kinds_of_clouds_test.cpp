// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Kinds of clouds that reports say other methods fail on: few points, parts far apart, things that touch,
// regular grids, blades, sheets with two layers, uneven density, functions instead of points.
#include "tests/unit/support/crumpled.h"
#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"

namespace neuralmesh::kinds_of_clouds_test {

using vcg::Point3d;

/// Turned, so that nothing follows an axis; with -1 turned back.
Cloud turned(Cloud cloud, double turns = 1) {
    vcg::Matrix44d turn;
    turn.SetRotateRad(0.7 * turns, Point3d(1, 2, 3));
    for (Point3d& p : cloud) p = turn * p;
    return cloud;
}

void add(const Cloud& part, double factor, const Point3d& offset, Cloud& cloud) {
    for (const Point3d& p : part) cloud.push_back(p * factor + offset);
}

/// The corners of a box of 1 x 2 x 3, and \p between points on each edge.
Cloud frame_of_box(int between) {
    Cloud cloud;
    const Point3d size(1, 2, 3);
    for (int corner = 0; corner < 8; ++corner) {
        const Point3d p((corner & 1) * size[0], (corner >> 1 & 1) * size[1], (corner >> 2) * size[2]);
        cloud.push_back(p);
        for (int k = 0; k < 3; ++k)
            for (int i = 1; i <= between && (corner >> k & 1) == 0; ++i) {
                cloud.push_back(p);
                cloud.back()[k] += size[k] * i / (between + 1);
            }
    }
    return cloud;
}

/// 1 for an equilateral triangle, 0 for one without area.
double quality(const NeuralMesh& mesh, const Triangle& face) {
    double edges = 0;
    for (std::size_t k = 0; k < 3; ++k)
        edges += (corner(mesh, face, k + 1) - corner(mesh, face, k)).SquaredNorm();
    return edges > 0 ? 4 * std::sqrt(3.0) * area_of(mesh, face).Norm() / edges : 0;
}

NeuralMesh expect_well_shaped(const Cloud& cloud, int vertices) {
    SCOPED_TRACE(std::to_string(cloud.size()) + " points");
    const NeuralMesh mesh = learn_exactly(cloud, with_target(vertices));
    EXPECT_TRUE(has_warning(mesh, "carry about"));
    std::vector<Point3d> places = mesh.positions;
    std::sort(places.begin(), places.end(), [](const auto& p, const auto& q) {
        return std::tie(p[0], p[1], p[2]) < std::tie(q[0], q[1], q[2]);
    });
    EXPECT_TRUE(std::adjacent_find(places.begin(), places.end()) == places.end()) << "coincident vertices";
    for (const Triangle& face : mesh.faces) EXPECT_GE(quality(mesh, face), 0.01);
    return mesh;
}

TEST(FewPoints, OfASphereMakeWellShapedFaces) {
    for (const int count : {6, 50, 200, 255}) expect_well_shaped(shapes::sphere_cloud(count), 1000);
}

TEST(FewPoints, AreMoreThanTheVertices) {
    const NeuralMesh mesh = learn_exactly(shapes::box_cloud(100, {1, 2, 3}), with_target(50));
    EXPECT_EQ(mesh.report.boundary_loops, 0);
    EXPECT_NEAR(enclosed_volume(mesh), 6, 0.9);
}

TEST(FewPoints, OfABoxGiveTheBox) {
    for (const int between : {0, 1, 4})
        EXPECT_NEAR(enclosed_volume(expect_well_shaped(turned(frame_of_box(between)), 300)), 6, 0.03);
}

// The points of 64 at the base of a cone have a neighbour in common.
TEST(FewPoints, OfAConeGiveTheCone) {
    Cloud cloud = {{0, 0, 2}};
    for (int i = 0; i < 64; ++i) cloud.emplace_back(std::cos(i * M_PI / 32), std::sin(i * M_PI / 32), 0.0);
    EXPECT_NEAR(enclosed_volume(learn_exactly(cloud, with_target(500))), 2 * M_PI / 3, 0.02);
}

// 400 points carry 200 vertices; the half has a boundary.
TEST(FewPoints, MakeASmoothMeshOfAllVerticesAskedFor) {
    const NeuralMesh whole = learn_exactly(shapes::sphere_cloud(400), with_target(3000));
    EXPECT_EQ(whole.report.genus, 0);
    EXPECT_TRUE(has_warning(whole, "carry about 200 vertices"));
    EXPECT_LT(whole.report.signals, 300000);
    const NeuralMesh half = learn_exactly(open_shapes::sphere_below(0, 3000), with_target(4000));
    EXPECT_EQ(half.report.boundary_loops, 1);
    EXPECT_TRUE(has_warning(half, "carry about"));
    EXPECT_TRUE(cut_faces(network_of({half.positions, half.faces})).empty());
    for (const NeuralMesh* mesh : {&whole, &half})
        for (const Point3d& p : mesh->positions) EXPECT_NEAR(p.Norm(), 1, 0.03);
}

TEST(PartsFarApart, AreLearnedAtTheirOwnScale) {
    constexpr double kDistance = 10000;
    const Point3d there(kDistance, 0, 0);
    Cloud cloud = shapes::sphere_cloud(2000);
    add(shapes::sphere_cloud(8000, 0, 2), 2, there, cloud);
    const NeuralMesh mesh = learn_exactly(cloud, with_target(500));
    EXPECT_EQ(mesh.report.components, 2);
    int of_small = 0;
    for (const Point3d& p : mesh.positions) {
        const bool small = p[0] < kDistance / 2;
        of_small += small ? 1 : 0;
        EXPECT_NEAR(small ? p.Norm() : (p - there).Norm() / 2, 1, 0.04);
    }
    // A fifth of the area; the smaller one bends more.
    EXPECT_GE(of_small, 100);
    EXPECT_LE(of_small, 160);
}

TEST(ThingsThatTouch, HaveNoFalseHandles) {
    const Cloud slab = shapes::box_cloud(12000, {5, 5, 0.4});
    Cloud standing;
    for (const Point3d& p : shapes::torus_cloud(6000)) standing.emplace_back(p[0], p[2], p[1] + 1.6);
    add(slab, 1, {0, 0, 0}, standing);
    EXPECT_EQ(learn_exactly(turned(standing), with_target(800)).report.genus, 1) << "a ring on its edge";
    Cloud ball = slab;
    add(shapes::sphere_cloud(4000), 1, {0, 0, 1.2}, ball);
    EXPECT_EQ(learn_exactly(turned(ball), with_target(800)).report.genus, 0) << "a ball";
}

/// The points of a lattice on the surface of a cube with edges of so many steps.
Cloud grid(int steps) {
    Cloud cloud;
    for (int x = 0; x <= steps; ++x)
        for (int y = 0; y <= steps; ++y)
            for (int z = 0; z <= steps; ++z)
                if (x % steps == 0 || y % steps == 0 || z % steps == 0) cloud.emplace_back(x, y, z);
    return cloud;
}

TEST(RegularGrids, AreLearnedWithinATwentiethOfAStep) {
    constexpr int kSteps = 10;
    ASSERT_EQ(grid(kSteps).size(), 602U);
    for (const int vertices : {100, 200}) {
        SCOPED_TRACE(vertices);
        const NeuralMesh mesh = learn_exactly(turned(grid(kSteps)), with_target(vertices));
        EXPECT_NEAR(enclosed_volume(mesh), 1000, 10);
        EXPECT_EQ(mesh.report.genus, 0);
        EXPECT_LT(mesh.report.rms_error, 100 * 0.05 / (kSteps * std::sqrt(3)));
    }
}

TEST(RegularGrids, HaveStraightEdges) {
    constexpr int kSteps = 40;
    // Ten points for each vertex, which an edge of the shape needs.
    constexpr int kVertices = kSteps * kSteps * 6 / 10;
    const NeuralMesh mesh = learn_exactly(turned(grid(kSteps)), with_target(kVertices));
    int beside = 0;
    for (const Point3d& p : turned(mesh.positions, -1))
        for (int k = 0; k < 3; ++k) beside += p[k] < -0.1 || p[k] > kSteps + 0.1 ? 1 : 0;
    EXPECT_LE(beside, kVertices / 50) << "vertices stick out of the cube by a tenth of a step";
}

/// Uniform on the surface of a box, which shapes::box_cloud() is not if its sides differ.
Cloud blade(double thickness, double spacing) {
    const Point3d edges(1, 0.3, thickness);
    Random random(1);
    Cloud cloud;
    for (int k = 0; k < 3; ++k) {
        const double area = 2 * edges[(k + 1) % 3] * edges[(k + 2) % 3];
        for (int i = 0; i < static_cast<int>(area / (spacing * spacing)); ++i) {
            Point3d p = shapes::in_cube(random);
            p[k] = random.below(2) == 0 ? -1 : 1;
            for (int j = 0; j < 3; ++j) p[j] *= edges[j] / 2;
            cloud.push_back(p);
        }
    }
    return cloud;
}

TEST(Blades, AreAsThickAsTheirPoints) {
    constexpr double kThickness = 0.02;
    const NeuralMesh mesh = learn_exactly(turned(blade(kThickness, kThickness / 3)), with_target(500));
    EXPECT_NEAR(enclosed_volume(mesh) / (0.3 * kThickness), 1, 0.01);
    EXPECT_LT(mesh.report.rms_error, 1.05);
}

using OfPlace = std::function<double(double x, double y)>;

struct Sheet {
    const char* name;
    int genus;
    OfPlace keep;  ///< not 0
    OfPlace height;
};

/// Points (x, y, height(x, y)) of the unit square where keep(x, y).
std::vector<Sheet> sheets() {
    const auto all = [](double, double) { return 1; };
    const auto flat = [](double, double) { return 0.0; };
    const auto disc = [](double x, double y) { return x * x + y * y < 0.25; };
    const auto holed = [](double x, double y) {
        const double a = (x + 0.2) * (x + 0.2) + (y + 0.2) * (y + 0.2);
        const double b = (x - 0.2) * (x - 0.2) + (y - 0.15) * (y - 0.15);
        return a > 0.015 && b > 0.022;
    };
    // A wave of a thousandth, by a polynomial, because transcendental functions differ between machines.
    const auto wave = [](double x, double y) { return 0.03 * x * y * (1 - 4 * x * x) * (1 - 4 * y * y); };
    const auto arch = [](double x, double) { return 0.4 * x * x; };
    return {{"square", 0, all, flat},
            {"disc", 0, disc, flat},
            {"square with two holes", 2, holed, flat},
            {"wavy square", 0, all, wave},
            {"arch", 0, all, arch}};
}

// Points that enclose no space: the mesh surrounds them with two layers.
TEST(Sheets, AreClosedOnBothSidesWithEveryVertexOnThem) {
    bool few = false;
    for (const Sheet& sheet : sheets()) {
        few = !few;
        Cloud cloud;
        vcg::Box3d box;
        for (const Point3d& p : shapes::plane_cloud(8000)) {
            if (sheet.keep(p[0], p[1]) == 0) continue;
            cloud.emplace_back(p[0], p[1], sheet.height(p[0], p[1]));
            box.Add(cloud.back());
        }
        Settings settings = with_target(few ? 250 : 1000);
        SCOPED_TRACE(testing::Message() << sheet.name << ", " << settings.target_vertices);
        settings.surface = kClosedSurface;
        const NeuralMesh mesh = learn_exactly(cloud, settings);
        EXPECT_EQ(topology_of(mesh), (Topology{1, sheet.genus, 0}));
        EXPECT_TRUE(has_warning(mesh, "closed around both of their sides"));
        EXPECT_FALSE(has_warning(mesh, "forced"));
        EXPECT_LT(mesh.report.rms_error, 1);
        for (const Point3d& p : mesh.positions) {
            const auto nearer = [&](const Point3d& a, const Point3d& b) {
                return (a - p).SquaredNorm() < (b - p).SquaredNorm();
            };
            const Point3d nearest = *std::min_element(cloud.begin(), cloud.end(), nearer);
            EXPECT_LT(100 * (nearest - p).Norm() / box.Diag(), 1.5);
        }
    }
}

// The unit sphere's upper half has a twentieth of the points.
TEST(EvenSampling, SpreadsTheVerticesEvenlyUnlessSignalsAreCounted) {
    const Cloud many = shapes::uneven_sphere_cloud(20000, 20), few = shapes::uneven_sphere_cloud(5000, 20);
    Settings on = with_target(500), off = on;
    off.even_sampling = false;
    const auto upper = [](const NeuralMesh& mesh) {
        return std::count_if(mesh.positions.begin(), mesh.positions.end(),
                             [](const Point3d& p) { return p[2] > 0; });
    };
    EXPECT_NEAR(static_cast<double>(upper(learn(many, on))), 250, 40);
    EXPECT_LT(upper(learn(many, off)), 190);
    on.utility_counter = off.utility_counter = kSignalCount;
    EXPECT_EQ(learn(few, on).positions, learn(few, off).positions);
}

/// Zero on a torus of radii 1 and .4 around the z axis; elsewhere the distance from it.
double distance_from_torus(const Point3d& p) {
    const double rim = std::sqrt(p[0] * p[0] + p[1] * p[1]) - 1;
    return std::sqrt(rim * rim + p[2] * p[2]) - 0.4;
}

/// A random point of a thin layer around that surface, moved onto it along the gradient by central
/// differences.
Point3d on_torus(Random& random) {
    constexpr double kStep = 1e-6;
    for (;;) {
        Point3d p = shapes::in_cube(random);
        p = Point3d(1.5 * p[0], 1.5 * p[1], 0.5 * p[2]);
        if (!(std::abs(distance_from_torus(p)) < 0.1)) continue;
        Point3d gradient;
        for (int k = 0; k < 3; ++k) {
            Point3d ahead = p, behind = p;
            ahead[k] += kStep;
            behind[k] -= kStep;
            gradient[k] = (distance_from_torus(ahead) - distance_from_torus(behind)) / (2 * kStep);
        }
        return p - gradient * distance_from_torus(p);
    }
}

TEST(Sampler, LearnsAnImplicitSurface) {
    const NeuralMesh mesh = learn_exactly(TargetSpace::drawn_by(on_torus, 30000), with_target(1500));
    EXPECT_EQ(topology_of(mesh), kRing);
    EXPECT_EQ(mesh.report.outliers, 0);
    for (const Point3d& p : mesh.positions) EXPECT_LT(std::abs(distance_from_torus(p)), 0.01);
}

/// Signals are not repeated: far more distinct ones than the points drawn first.
TEST(Sampler, DrawsANewPointForEverySignal) {
    const TargetSpace target = TargetSpace::drawn_by(on_torus, 100);
    Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const vcg::Point3f p = target.sample(random);
        EXPECT_EQ(std::count(target.positions().begin(), target.positions().end(), p), 0);
        EXPECT_LT(std::abs(distance_from_torus(target.frame().outside(p))), 1e-4);
    }
}

}  // namespace neuralmesh::kinds_of_clouds_test
