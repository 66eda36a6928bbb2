// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The start mesh around clouds of known topology.
#include "vcg_core/start/shell.h"

#include "tests/unit/support/referee.h"
#include "tests/unit/support/shell_shapes.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh::shell_test {

StartMesh shell(const std::vector<vcg::Point3d>& cloud, const ShellOptions& options = {}) {
    const TargetSpace target = target_of(cloud);
    Surveys surveys(target.positions(), options.threads);
    return Shell(target.positions(), surveys, options, unwatched()).mesh(unwatched());
}

StartMesh shell_of_samples(const Shape& shape, std::size_t count, double noise = 0) {
    Random random(7);
    return shell(shell_shapes::sample(shape, count, random, noise));
}

bool warns_of(const StartMesh& mesh, const std::string& word) { return has_one(mesh.warnings, word); }

/// What holds for every start mesh, whatever the cloud.
void expect_sound(const StartMesh& mesh) {
    const Network network(mesh.positions, mesh.faces);
    EXPECT_EQ(topology_of(network), (Topology{mesh.components, mesh.genus, 0}));
    for (VertexId v = 0; v < network.vertex_count(); ++v) {
        EXPECT_GE(network.ring(v).valence, 3);
        EXPECT_LE(network.ring(v).valence, 12);
    }
    EXPECT_GT(enclosed_volume(mesh), 0);
}

/// \param most vertices: ShellOptions::max_vertices or, where parts are thin, most_vertices
void expect_topology(const StartMesh& mesh, int components, int genus, std::size_t most = 400) {
    expect_sound(mesh);
    EXPECT_EQ(mesh.components, components);
    EXPECT_EQ(mesh.genus, genus);
    EXPECT_LE(mesh.positions.size(), most);
}

TEST(Shell, Sphere) {
    for (const std::size_t count : {500U, 5000U, 50000U}) {
        const StartMesh mesh = shell_of_samples(shell_shapes::sphere(1), count);
        expect_topology(mesh, 1, 0);
        EXPECT_GT(mesh.confidence, 0.9);
        EXPECT_TRUE(mesh.warnings.empty());
    }
}

TEST(Shell, ThinWalledCupStaysOpen) {
    const StartMesh mesh = shell_of_samples(shell_shapes::cup(1, 2, 0.06), 20000);
    expect_topology(mesh, 1, 0);
    // In a frame of diagonal 1 a filled cup has a volume of 0.151, and more at the shell's distance.
    EXPECT_LT(enclosed_volume(mesh), 0.15);
}

TEST(Shell, EdgesAreNoLongerThanAWallIsThick) {
    const double wall = 0.1;
    Random random(7);
    ShellOptions options;
    options.most_vertices = 10000;
    const StartMesh mesh =
        shell(shell_shapes::sample(shell_shapes::cup(1, 2, wall), 200000, random), options);
    expect_topology(mesh, 1, 0, 10000);
    const double diagonal = 2 * std::sqrt(3.0);
    double sum = 0, edges = 0;
    for (const Triangle& f : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k, ++edges) {
            const auto at = [&](std::size_t i) { return mesh.positions[static_cast<std::size_t>(f[i % 3])]; };
            sum += static_cast<double>((at(k) - at(k + 1)).Norm());
        }
    EXPECT_LT(sum / edges, wall / diagonal);
    EXPECT_GT(sum / edges, wall / diagonal / 3);
}

TEST(Shell, TellsTheTwoSidesOfAThinWallFromASheet) {
    // The wall is four spacings thick, too thin for the lattice to show a space in it.
    const StartMesh cup = shell_of_samples(shell_shapes::cup(1, 2, 0.045), 200000);
    EXPECT_TRUE(cup.walled);
    EXPECT_TRUE(cup.encloses_space);
    EXPECT_FALSE(warns_of(cup, "enclose no space"));
}

/// A ball of radius 1 with a flange around its equator.
Shape ball_with_flange(double radius, double thickness) {
    constexpr double kQuarter = 1.5707963267948966;
    constexpr int kSteps = 24;
    const double half = thickness / 2, edge = std::asin(half);
    std::vector<std::array<double, 2>> profile;
    for (int i = 0; i <= kSteps; ++i) {
        const double v = -kQuarter + (kQuarter - edge) * i / kSteps;
        profile.push_back({std::cos(v), std::sin(v)});
    }
    profile.push_back({radius, -half});
    const std::vector<std::array<double, 2>> below = profile;
    for (auto p = below.rbegin(); p != below.rend(); ++p) profile.push_back({(*p)[0], -(*p)[1]});
    return shell_shapes::revolve(profile, 96, false);
}

TEST(Shell, ThinPartsOfABodyAreNoSheet) {
    // Four spacings thick, as in the test above, but a fifth of the surface.
    const StartMesh flange = shell_of_samples(ball_with_flange(1.25, 0.045), 200000);
    EXPECT_FALSE(flange.walled);
    EXPECT_LT(flange.sheet_share, kMostSheet);
    // The same flange of one layer.
    Random random(7);
    std::vector<vcg::Point3d> cloud = shell_shapes::sample(ball_with_flange(1.25, 0.045), 200000, random);
    shell_shapes::cut_off(cloud,
                          [](const vcg::Point3d& p) { return p[2] < 0 && p[0] * p[0] + p[1] * p[1] > 1; });
    EXPECT_GT(shell(cloud).sheet_share, kMostSheet);
}

TEST(Shell, PartsThatShowNoSurfaceAreNoSheet) {
    // A ball on a pin, which is as thick as two points are apart: no place of it shows a surface.
    constexpr double kHalf = 1.5707963267948966, kPin = 0.07;
    std::vector<std::array<double, 2>> profile{{0, -3}, {kPin, -3}};
    for (double v = -kHalf + kPin; v < kHalf - kPin / 2; v += (kHalf - kPin) / 24)
        profile.push_back({std::cos(v), std::sin(v)});
    profile.insert(profile.end(), {{kPin, 3}, {0, 3}});
    const StartMesh pin = shell_of_samples(shell_shapes::revolve(profile, 96, false), 4000);
    EXPECT_TRUE(pin.encloses_space);
    EXPECT_LT(pin.sheet_share, kMostSheet);
}

TEST(Shell, NoiseDoesNotMakeHandles) {
    const double diagonal = 2 * std::sqrt(1.3 * 1.3 * 2 + 0.3 * 0.3);
    for (const double noise : {0.001, 0.003, 0.006})
        expect_topology(shell_of_samples(shell_shapes::torus(1, 0.3), 20000, noise * diagonal), 1, 1);
}

TEST(Shell, NoiseDoesNotJoinLinks) {
    const Shape chain = shell_shapes::chain(4, 1, 0.2, 1.3);
    expect_topology(shell_of_samples(chain, 200000, 0.001 * 6.9), 4, 4);
}

TEST(Shell, NestedSpheresComeAsTheOuterOne) {
    Shape both = shell_shapes::sphere(1);
    shapes::append(both, shell_shapes::sphere(0.4), {0, 0, 0});
    expect_topology(shell_of_samples(both, 20000), 1, 0);
}

TEST(Shell, PiecesOfASparseCloudAreNoComponents) {
    for (const int count : {400, 800, 2000}) {
        Random random(16);
        const StartMesh mesh = shell(
            shell_shapes::sample(shell_shapes::torus(1, 0.35), static_cast<std::size_t>(count), random));
        expect_topology(mesh, 1, 1);
        EXPECT_EQ(mesh.ignored_points, 0);
    }
}

TEST(Shell, VerticesFollowTheBudget) {
    Random random(2);
    const auto cloud = shell_shapes::sample(shell_shapes::torus(1, 0.4), 20000, random);
    ShellOptions options;
    for (const int target : {100, 400, 1000}) {
        options.target_vertices = target;
        EXPECT_EQ(shell(cloud, options).positions.size(), static_cast<std::size_t>(target / 4));
    }
}

/// Only where parts nearly touch, as the points of a sparse cloud do, does the shell use threads.
TEST(Shell, SparseCloudSameBytesForAnyNumberOfThreads) {
    Random random(16);
    const auto cloud = shell_shapes::sample(shell_shapes::torus(1, 0.35), 800, random);
    ShellOptions alone, together;
    alone.threads = 1;
    together.threads = 3;
    const StartMesh one = shell(cloud, alone), three = shell(cloud, together);
    EXPECT_TRUE(one.positions == three.positions);
    EXPECT_EQ(one.faces, three.faces);
}

/// Spheres of the given radii about one centre, with \p count points on all.
std::vector<vcg::Point3d> spheres(const std::vector<double>& radii, std::size_t count, double noise = 0) {
    Random random(7);
    double area = 0;
    for (const double r : radii) area += r * r;
    std::vector<vcg::Point3d> cloud;
    for (const double r : radii) {
        const auto share = static_cast<std::size_t>(static_cast<double>(count) * r * r / area);
        const auto part = shell_shapes::sample(shell_shapes::sphere(r), share, random, noise);
        cloud.insert(cloud.end(), part.begin(), part.end());
    }
    return cloud;
}

TEST(Shell, HollowsAreKept) {
    // Walls of 4, 6, 12 and 40 spacings of the points.
    for (const double inner : {0.93, 0.9, 0.8, 0.4}) {
        const StartMesh mesh = shell(spheres({1, inner}, 50000));
        EXPECT_EQ(mesh.components, 2) << inner;
        EXPECT_EQ(mesh.genus, 0) << inner;
        EXPECT_EQ(Network(mesh.positions, mesh.faces).validate(), "");
        EXPECT_TRUE(mesh.encloses_space);
    }
}

TEST(Shell, BodiesInHollowsAreKept) { expect_topology(shell(spheres({1, 0.8, 0.5}, 50000)), 3, 0); }

TEST(Shell, LayersThatDoNotMeetEncloseNoHollow) {
    // Two views of a sphere, shifted by 5 spacings: in front and behind one layer is before the other.
    std::vector<vcg::Point3d> cloud = spheres({1}, 25000);
    for (const vcg::Point3d& p : spheres({1}, 25000)) cloud.push_back({-p[1], p[2], p[0] + 0.1});
    const StartMesh mesh = shell(cloud);
    EXPECT_EQ(mesh.components, 1);
    // A sphere within noise of its own, and one with a few points inside.
    expect_topology(shell(spheres({1}, 50000, 0.01)), 1, 0);
    std::vector<vcg::Point3d> dirty = spheres({1}, 50000);
    for (const vcg::Point3d& p : spheres({0.5}, 300)) dirty.push_back(p);
    EXPECT_EQ(shell(dirty).components, 1);
}

}  // namespace neuralmesh::shell_test
