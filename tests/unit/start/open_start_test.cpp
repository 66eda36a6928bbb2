// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Open start meshes, and those of the user: topology, place, orientation, and what is refused.
#include "vcg_core/start/open_start.h"
#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"
#include "vcg_core/start/given_start.h"

namespace neuralmesh::open_start_test {

using open_shapes::Case;

// The open start mesh: topology, place, orientation, and what it refuses.

OpenStart start_of(const Cloud& cloud, const OpenStartOptions& options = {}) {
    const TargetSpace target = target_of(cloud);
    Random random(1);
    Surveys surveys(target.positions(), options.threads);
    return open_start(target, target.positions(), surveys, options, random, unwatched());
}

bool warns(const OpenStart& start, const std::string& words) { return has_one(start.warnings, words); }

TEST(OpenStart, IsSmallWhereFewVerticesAreWanted) {
    OpenStartOptions options;
    options.wanted_vertices = 40;
    options.target_vertices = 20;
    const OpenStart start = start_of(shapes::plane_cloud(3000), options);
    EXPECT_LE(start.positions.size(), 40U);
    EXPECT_GT(start.positions.size(), 20U);
    EXPECT_EQ(start.fewest_vertices, 20);
    EXPECT_EQ(start.loops, 1);
}

TEST(OpenStart, TurnsItsConvexSideOutward) {
    const Cloud cap =
        open_shapes::cut(shapes::sphere_cloud(20000), [](const vcg::Point3d& p) { return p[2] > 0.3; });
    const OpenStart start = start_of(cap);
    std::size_t outward = 0;
    for (const Triangle& f : start.faces) outward += area_of(start, f)[2] > 0 ? 1 : 0;
    EXPECT_GT(outward, start.faces.size() * 98 / 100);
}

TEST(OpenStart, ClosesHolesUpToTheDiameterAskedFor) {
    const Case holed = open_shapes::cases()[6];
    OpenStartOptions options;
    options.close_holes_up_to = 0.25;  // the holes' diameter is .24 / sqrt(2), about .17
    EXPECT_EQ(start_of(holed.cloud, options).loops, 1);
    EXPECT_TRUE(start_of(holed.cloud).outliers.empty());
    EXPECT_TRUE(start_of(holed.cloud).warnings.empty());
    options.close_holes_up_to = 0.1;
    EXPECT_EQ(start_of(holed.cloud, options).loops, 3);
    options.close_holes_up_to = 0;
    EXPECT_EQ(start_of(holed.cloud, options).loops, 3);
}

TEST(OpenStart, HasNoCrackAlongASharpEdge) {
    // Two sides of a wedge of 45 degrees, a square each.
    Cloud wedge;
    for (const vcg::Point3d& p : shapes::plane_cloud(4000, 1)) wedge.emplace_back(p[0], p[1], 0);
    const double half = std::sqrt(0.5);
    double lowest = 0;
    for (const vcg::Point3d& p : wedge) lowest = std::min(lowest, p[1]);
    for (const vcg::Point3d& p : shapes::plane_cloud(4000, 2))
        wedge.emplace_back(p[0], lowest + half * (p[1] - lowest), half * (p[1] - lowest));
    const OpenStart start = start_of(wedge);
    EXPECT_EQ(start.components, 1);
    EXPECT_EQ(start.loops, 1);
}

TEST(OpenStart, FollowsTheDensityOfTheCloud) {
    // A square of ten times as many points on one half as on the other.
    Random random(1);
    const Cloud cloud = open_shapes::cut(
        shapes::plane_cloud(60000), [&](const vcg::Point3d& p) { return p[0] < 0 || random.below(10) == 0; });
    const OpenStart start = start_of(cloud);
    EXPECT_EQ(start.components, 1);
    EXPECT_EQ(start.loops, 1);
    const auto all = [](const auto&, const auto&) { return true; };
    EXPECT_NEAR(areas_of(start, all).first, 0.5, 0.05);
}

TEST(OpenStart, CutsAMoebiusStripAndSaysWhere) {
    const OpenStart start = start_of(open_shapes::band(10000, 1));
    EXPECT_EQ(Network(start.positions, start.faces).validate(), "");
    EXPECT_EQ(start.components, 1);
    EXPECT_EQ(start.loops, 1);
    EXPECT_EQ(start.genus, 0);  // a disc
    EXPECT_TRUE(warns(start, "cut there, near ("));
}

TEST(OpenStart, LeavesOutSpecks) {
    Cloud cloud = shapes::plane_cloud(5000);
    for (int i = 0; i < 30; ++i) cloud.emplace_back(0.01 * (i % 6), 0.01 * (i / 6), 0.6);
    const OpenStart start = start_of(cloud);
    EXPECT_EQ(start.components, 1);
    ASSERT_EQ(start.outliers.size(), cloud.size());
    EXPECT_EQ(std::count(start.outliers.begin(), start.outliers.end(), 1), 30);
    EXPECT_EQ(std::count(start.outliers.end() - 30, start.outliers.end(), 1), 30);
    EXPECT_TRUE(warns(start, "30 of 5030 points (0.6 %) show no surface"));
}

TEST(OpenStart, TakesManyReadingsOfOnePlaceForNoPart) {
    // A tenth of the points, as a disc that is narrower than the others are apart.
    Cloud cloud = shapes::plane_cloud(5000);
    for (const vcg::Point3d& p : shapes::plane_cloud(500))
        cloud.push_back(p * 0.01 + vcg::Point3d(0, 0, 0.6));
    const OpenStart start = start_of(cloud);
    EXPECT_EQ(start.components, 1);
    EXPECT_FALSE(start.misses_surface);
    EXPECT_EQ(std::count(start.outliers.end() - 500, start.outliers.end(), 1), 500);
}

TEST(OpenStart, SaysIfItMissesTheNarrowSidesOfASlab) {
    EXPECT_TRUE(start_of(shapes::box_cloud(3000, {1, 0.7, 0.1})).misses_surface);
    EXPECT_FALSE(start_of(shapes::box_cloud(12000, {1, 0.7, 0.1})).misses_surface);
    EXPECT_FALSE(start_of(shapes::plane_cloud(5000)).misses_surface);
}

TEST(OpenStart, RefusesWhatIsNoSurface) {
    const auto refusal = [](const Cloud& cloud) { return complaint_of([&] { start_of(cloud); }); };
    Cloud scattered;
    Random random(1);
    for (int i = 0; i < 5000; ++i) scattered.push_back(shapes::in_cube(random));
    EXPECT_NE(refusal(scattered).find("scattered"), std::string::npos);
    EXPECT_NE(refusal(open_shapes::helix(2000)).find("on curves"), std::string::npos);
    EXPECT_NE(refusal(shapes::plane_cloud(99)).find("too few"), std::string::npos);
}

TEST(OpenStart, KeepsWhatIsFoundInPointsThatShowLittle) {
    // A square: three quarters of it are noisier than the survey looks far, and the mesh is found all the
    // same.
    Cloud cloud = shapes::plane_cloud(20000);
    Random random(1);
    for (vcg::Point3d& p : cloud)
        if (p[0] < 0.25) p[2] += 0.05 * shapes::normal(random);
    const TargetSpace target = target_of(cloud);
    Surveys surveys(target.positions(), 1);
    EXPECT_GT(surveys.surface().clutter(), 0.5);
    const OpenStart start = start_of(cloud);
    EXPECT_LT(start.left_out, 0.1);
    EXPECT_EQ(start.components, 1);
}

TEST(OpenStart, EndsAPartWhereItsPointsEnd) {
    // The boundary of a part is no hole in it, though it is as narrow as one: a small square beside half a
    // sphere, and half a sphere so noisy that six radii reach across it.
    Cloud islands = open_shapes::sphere_below(0, 40000);
    for (const vcg::Point3d& p : shapes::plane_cloud(60)) islands.push_back(p * 0.2 + vcg::Point3d(0, 0, 1));
    EXPECT_EQ(start_of(islands).components, 2);
    EXPECT_EQ(start_of(islands).loops, 2);
    EXPECT_EQ(start_of(open_shapes::sphere_below(0, 8000, 0.25)).loops, 1);
    // A hole in a sphere is filled.
    EXPECT_EQ(start_of(open_shapes::sphere_below(0.95, 1000)).loops, 0);
}

TEST(OpenStart, KeepsASmallSheetButNoClump) {
    // Half a sphere, and apart from it .7 % of the points: on a small square, or in a ball.
    Cloud half = open_shapes::sphere_below(0, 40000);
    Cloud sheet = half, clump = half;
    Random random(1);
    for (const vcg::Point3d& p : shapes::plane_cloud(140)) sheet.push_back(p * 0.3 + vcg::Point3d(0, 0, 1));
    for (int i = 0; i < 140; ++i) clump.push_back(shapes::in_ball(random) * 0.05 + vcg::Point3d(0, 0, 1));
    EXPECT_EQ(start_of(sheet).components, 2);
    EXPECT_TRUE(start_of(sheet).outliers.empty());
    EXPECT_EQ(start_of(clump).components, 1);
    OpenStartOptions few;
    few.target_vertices = 40;  // of which the square would get a quarter of one
    EXPECT_EQ(start_of(sheet, few).components, 1);
}

TEST(OpenStart, KeepsASmallSheetUnderNoise) {
    // Noise about as wide as the points are apart, on half a sphere and on a square with .7 % of the points.
    Cloud sheet = open_shapes::sphere_below(0, 200000, 0.007);
    Random random(2);
    for (const vcg::Point3d& p : shapes::plane_cloud(700))
        sheet.push_back(p * 0.2 + vcg::Point3d(0, 0, 1 + 0.007 * shapes::signed_unit(random)));
    EXPECT_EQ(start_of(sheet).components, 2);
}

// A start mesh of the user's: what is refused, with which remedy, and what stays.

const TargetSpace& ball() {
    static const TargetSpace target = target_of(shapes::sphere_cloud(4000));
    return target;
}

std::string complaint(const Shape& shape) {
    return complaint_of([&] { given_start(shape, ball()); });
}

void expect_remedy(const Shape& shape, const std::string& breach, const std::string& filter) {
    const std::string sentence = complaint(shape);
    EXPECT_NE(sentence.find(breach), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("filter '" + filter), std::string::npos) << sentence;
}

TEST(GivenStart, NamesTheFirstBreachAndTheRemedy) {
    EXPECT_EQ(complaint(shapes::icosphere(1)), "");
    EXPECT_NE(complaint({shapes::icosphere(1).positions, {}}).find("has no faces"), std::string::npos);

    Shape shape = shapes::icosphere(1);
    shape.faces.push_back({3, 3, 4});
    expect_remedy(shape, "faces with a corner twice (1)", "Remove Zero Area Faces");

    shape.faces.back() = {shape.faces[5][1], shape.faces[5][0], shape.faces[5][2]};
    shape.faces.push_back(shape.faces[7]);
    expect_remedy(shape, "faces that repeat others (2)", "Remove Duplicate Faces");

    shape = shapes::icosphere(1);
    shape.positions.emplace_back(0, 0, 1.5);
    shape.faces.push_back({shape.faces[0][0], shape.faces[0][1], 42});
    expect_remedy(shape, "edges with more than two faces (1)", "Repair non Manifold Edges");

    shape = shapes::icosphere(1);
    std::swap(shape.faces[0][0], shape.faces[0][1]);
    expect_remedy(shape, "edges whose two faces have opposite orientations (3)",
                  "Re-Orient all faces coherently");

    shape = shapes::tetrahedron();
    shape.positions.insert(shape.positions.end(), {{2, 0, 0}, {2, 1, 0}, {2, 0, 1}});
    shape.faces.insert(shape.faces.end(), {{0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}});
    expect_remedy(shape, "vertices where parts of the surface only touch (1)",
                  "Repair non Manifold Vertices by splitting");
}

/// Two fans of one face each are open, which must not hide that they only touch.
TEST(GivenStart, FindsVerticesWhereOpenPartsTouch) {
    Shape shape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
    expect_remedy(shape, "vertices where parts of the surface only touch (1)",
                  "Repair non Manifold Vertices by splitting");
}

/// As an STL file is read: every face has vertices of its own.
TEST(GivenStart, FindsVerticesThatAreNotMerged) {
    const Shape sphere = shapes::icosphere(1);
    Shape soup;
    for (const auto& face : sphere.faces) {
        for (const int v : face) soup.positions.push_back(sphere.positions[static_cast<std::size_t>(v)]);
        const int n = static_cast<int>(soup.positions.size());
        soup.faces.push_back({n - 3, n - 2, n - 1});
    }
    expect_remedy(soup, "of which no two share a vertex", "Merge Close Vertices");
}

/// The boxes of a plane and of points on it are flat.
TEST(GivenStart, TakesAPlaneOfPointsInItsPlane) {
    const TargetSpace plane = target_of(shapes::plane_cloud(1000));
    EXPECT_EQ(given_start(shapes::grid(5, 5), plane).positions.size(), 25U);
}

/// Two poles of a hundred neighbours, and the middle of an open fan of sixty faces.
TEST(GivenStart, SplitsVerticesWithTooManyNeighbours) {
    for (const Shape& shape : {shapes::bipyramid(100), shapes::fan(60)}) {
        const auto before = census(shape.faces);
        const IndexedMesh<float> start = given_start(shape, ball());
        const auto after = census(start.faces);
        EXPECT_EQ(after.breach, "");
        EXPECT_LE(after.greatest_valence(), Ring::kMaxValence);
        EXPECT_EQ(after.euler(), before.euler());
        EXPECT_EQ(after.loops, before.loops);
        EXPECT_LT(after.vertices, 2 * before.vertices);
        EXPECT_EQ(Network(start.positions, start.faces).validate(), "");
    }
}

}  // namespace neuralmesh::open_start_test
