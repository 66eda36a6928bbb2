// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The boundary in the fit: where the points end, notches, and whole fits of sheets and half spheres.
#include "vcg_core/fit/boundary.h"
#include "tests/unit/fit/fit_scene.h"
#include "tests/unit/support/open_shapes.h"
#include "vcg_core/fit/fit.h"

namespace neuralmesh::boundary_test {

/// A flat grid of 8 x 8 unit squares around the origin, z = 0.
Shape sheet() { return shapes::scaled(shapes::grid(9, 9), 8); }

/// Points spread evenly over a square of that half width.
Cloud square(int count, double half) {
    Random random(5);
    Cloud cloud;
    for (int i = 0; i < count; ++i)
        cloud.emplace_back(half * shapes::signed_unit(random), half * shapes::signed_unit(random), 0);
    return cloud;
}

struct Boundary {
    double length = 0;
    double mean_distance = 0;  ///< of its vertices
    double most = 0;           ///< largest distance
};

/// \p distance(p): from the true boundary.
template <class Distance>
Boundary boundary_of(const Network& network, const Distance& distance) {
    Boundary result;
    int count = 0;
    for (const VertexId v : network.vertices()) {
        if (network.ring(v).open == 0) continue;
        const vcg::Point3d p = vcg::Point3d::Construct(network.position(v));
        result.length += (vcg::Point3d::Construct(network.position(network.ring(v)[0])) - p).Norm();
        result.mean_distance += distance(p);
        result.most = std::max(result.most, distance(p));
        ++count;
    }
    result.mean_distance /= std::max(count, 1);
    return result;
}

/// The sheet is 8 wide, the points reach \p half far, which is less or more.
void expect_targets_at(double half) {
    const FitScene scene(network_of(sheet()), square(20000, half));
    const std::vector<BoundaryTarget> targets =
        find_boundary_targets(scene.network, scene.surface, scene.points);
    EXPECT_EQ(targets.size(), 32U);
    double sum = 0;
    int count = 0;
    for (const BoundaryTarget& target : targets) {
        EXPECT_EQ(target.parts, BoundaryTarget::kMostParts);
        EXPECT_EQ(target.weight, 1);
        for (int i = 0; i < target.parts; ++i) {
            const Vector3& a = scene.surface.positions[target.a];
            const Vector3& b = scene.surface.positions[target.b];
            const Vector3 at = (1 - target.share(i)) * a + target.share(i) * b;
            // At the corners the points of the other side may be missing.
            if (std::min(std::abs(at[0]), std::abs(at[1])) > 3) continue;
            EXPECT_GT(target.outward.dot(at), 0);
            EXPECT_NEAR(target.offset(i), half - 4, 0.12);
            sum += static_cast<double>(target.offset(i));
            ++count;
        }
    }
    EXPECT_NEAR(sum / count, half - 4, 0.015);  // a strip of that width holds .8 points in front of a part
}

TEST(BoundaryTargets, LieWhereThePointsEnd) {
    for (const double half : {3.7, 3.9, 4.0, 4.1, 4.3}) expect_targets_at(half);
}

// Of points in rows as many are last at once; short edges have few in front of them.
TEST(BoundaryTargets, DoNotReachFarBeyondRows) {
    for (const int rows : {18, 30, 60}) {
        const double spacing = 8.0 / (rows - 1);
        Cloud cloud;
        for (int i = 0; i < rows * rows; ++i)
            cloud.emplace_back(spacing * (i % rows) - 4, spacing * (i / rows) - 4, 0);
        const FitScene scene(network_of(sheet()), cloud);
        const auto targets = find_boundary_targets(scene.network, scene.surface, scene.points);
        EXPECT_FALSE(targets.empty());
        for (const BoundaryTarget& target : targets)
            for (int i = 0; i < target.parts; ++i) EXPECT_LT(target.offset(i), 0.5 * spacing) << rows;
    }
}

TEST(BoundaryTargets, StopAtAGap) {
    Cloud cloud = square(20000, 3.8);
    for (int i = 0; i < 20; ++i) cloud.emplace_back(4.5, 0.05 * i, 0);  // outliers beyond
    const FitScene scene(network_of(sheet()), cloud);
    for (const BoundaryTarget& target : find_boundary_targets(scene.network, scene.surface, scene.points))
        for (int i = 0; i < target.parts; ++i) EXPECT_LT(target.offset(i), 0);
}

TEST(BoundaryTargets, AreNoneOnClosedSurfaces) {
    const FitScene scene(network_of(shapes::icosphere(2)), shapes::sphere_cloud(2000));
    EXPECT_TRUE(find_boundary_targets(scene.network, scene.surface, scene.points).empty());
    EXPECT_TRUE(find_notches(scene.network, scene.surface, scene.points).empty());
}

// A face at the boundary is missing.
TEST(Notches, AreFilledWhereTheyHoldPoints) {
    Shape shape = sheet();
    const Network whole = network_of(shape);
    // A face with a boundary edge and an inner vertex opposite.
    const auto removed = std::find_if(shape.faces.begin(), shape.faces.end(), [&](const Triangle& f) {
        int open = 0;
        for (VertexId v : f) open += whole.ring(v).open;
        const Ring& a = whole.ring(f[0]);
        const Ring& b = whole.ring(f[1]);
        const Ring& c = whole.ring(f[2]);
        return open == 2 && a.valence > 3 && b.valence > 3 && c.valence > 3;
    });
    ASSERT_NE(removed, shape.faces.end());
    const Triangle face = *removed;
    shape.faces.erase(removed);
    const Network notched = network_of(shape);
    const FitScene full(notched, square(20000, 4));
    const std::vector<VertexId> notches = find_notches(full.network, full.surface, full.points);
    ASSERT_EQ(notches.size(), 1U);
    EXPECT_NE(std::find(face.begin(), face.end(), notches[0]), face.end());
    Network network = notched;
    PerVertex<char> barred(network.slot_count(), 0);
    EXPECT_EQ(fill_notches(network, notches, barred), 1);
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(canonical(network.faces()), canonical(whole.faces()));
    network = notched;
    barred[face[0]] = 1;
    EXPECT_EQ(fill_notches(network, notches, barred), 0);

    // Points only away from the notch: it stays.
    Cloud rest;
    const vcg::Point3f p = notched.position(notches[0]);
    for (const vcg::Point3d& q : square(20000, 4))
        if ((q - vcg::Point3d::Construct(p)).Norm() > 1.1) rest.push_back(q);
    const FitScene empty(notched, rest);
    EXPECT_TRUE(find_notches(empty.network, empty.surface, empty.points).empty());
}

void fit(Network& network, const Cloud& cloud) {
    const TargetSpace target = target_of(cloud);
    // The core's frame of the cloud.
    for (const VertexId v : network.vertices())
        network.set_position(v, target.frame().inside(vcg::Point3d::Construct(network.position(v))));
    fit_to_points(network, target, FitOptions(), 1, 3, unwatched());
    EXPECT_EQ(network.validate(), "");
    for (const VertexId v : network.vertices())
        network.set_position(v, vcg::Point3f::Construct(target.frame().outside(network.position(v))));
}

// The mesh begins too small or too large, and rough.
TEST(FitOfABoundary, BringsASheetToTheEndOfItsPoints) {
    Random random(9);
    for (const double size : {0.8, 1.08, 0.8, 1.08, 0.8, 1.08}) {
        Shape shape = sheet();
        for (vcg::Point3d& p : shape.positions) p = p * size + shapes::in_ball(random) * 0.15;
        Network network = network_of(shape);
        fit(network, square(20000, 4));
        const Boundary boundary = boundary_of(network, [](const vcg::Point3d& p) {
            return std::abs(std::max(std::abs(p[0]), std::abs(p[1])) - 4);
        });
        EXPECT_NEAR(boundary.length, 32, 1) << size;
        EXPECT_LT(boundary.mean_distance, 0.1) << size;  // of an edge; .32 at the start
        EXPECT_LT(boundary.most, 0.5) << size;           // at corners
    }
}

TEST(FitOfABoundary, BringsHalfASphereToTheEndOfItsPoints) {
    const Shape half =
        open_shapes::cut(shapes::icosphere(3), [](const vcg::Point3d& p) { return p[2] >= -0.01; });
    Cloud cloud;
    for (const vcg::Point3d& p : shapes::sphere_cloud(40000))
        if (p[2] > -0.1) cloud.push_back(p / p.Norm());
    Network network = network_of(half, 0.03);
    fit(network, cloud);
    const Boundary boundary =
        boundary_of(network, [](const vcg::Point3d& p) { return std::abs(p[2] + 0.1); });
    EXPECT_NEAR(boundary.length, 2 * shapes::kPi * std::sqrt(0.99), 0.12);
    EXPECT_LT(boundary.mean_distance, 0.01);
    EXPECT_LT(boundary.most, 0.07);  // half an edge
}

/// How many faces are opened of a sheet whose points have x < \p end, but for every \p stray-th one; its own
/// ends at 4.
int webs_of_sheet(float end, int count, char barred = 0, int stray = 1 << 30) {
    Cloud cloud;
    int i = 0;
    for (const vcg::Point3d& p : square(count, 4))
        if (p[0] < static_cast<double>(end) || ++i % stray == 0) cloud.push_back(p);
    FitScene scene(network_of(sheet()), cloud);
    const PerVertex<char> none(scene.network.slot_count(), barred);
    const Network before = scene.network;
    const int opened = open_webs(scene.network, scene.surface, scene.points, none);
    EXPECT_EQ(scene.network.validate(), "");
    EXPECT_EQ(scene.network.face_count(), before.face_count() - opened);
    EXPECT_EQ(topology_of(scene.network), kDisc);
    const std::vector<Triangle> gone = new_faces(scene.network, before);
    EXPECT_EQ(static_cast<int>(gone.size()), opened);
    for (const Triangle& f : gone)
        for (const VertexId v : f) EXPECT_GT(before.position(v)[0], end - 0.01F);
    return opened;
}

/// The sheet without the quarter where x and y are positive.
Shape three_quarters() {
    const auto index = [](int x, int y) { return y <= 0 ? 9 * (y + 4) + x + 4 : 45 + 5 * (y - 1) + x + 4; };
    Shape shape;
    for (int y = -4; y <= 4; ++y)
        for (int x = -4; x <= (y <= 0 ? 4 : 0); ++x) shape.positions.emplace_back(x, y, 0);
    for (int y = -4; y < 4; ++y)
        for (int x = -4; x < (y < 0 ? 4 : 0); ++x) {
            shape.faces.push_back({index(x, y), index(x + 1, y), index(x + 1, y + 1)});
            shape.faces.push_back({index(x, y), index(x + 1, y + 1), index(x, y + 1)});
        }
    return shape;
}

TEST(FindCollapses, CountsWhatReachesBeyondTheBoundary) {
    const Cloud cloud =
        open_shapes::cut(square(20000, 4), [](const vcg::Point3d& p) { return p[0] < 0 || p[1] < 0; });
    const FitScene scene(network_of(three_quarters()), cloud);
    const std::vector<Collapse> collapses = collapses_of(scene);
    const auto corner = std::find_if(collapses.begin(), collapses.end(), [&](const Collapse& c) {
        return scene.network.position(c.gone) == vcg::Point3f(0, 0, 0);
    });
    ASSERT_NE(corner, collapses.end());
    ASSERT_GE(corner->into, 0);
    // Along the boundary the corner would be spanned. The integral of min(x, y)^2 over the triangle (0, 0),
    // (1, 0), (0, 1) is 1 / 48.
    const double expected = static_cast<double>(cloud.size()) / 48 / 48;
    EXPECT_NEAR(static_cast<double>(corner->cost), expected, expected / 4);
}

TEST(FindCollapses, TakeAnEarWithoutArea) {
    Network network = network_of(sheet());
    VertexId ear = -1;
    for (const VertexId v : network.vertices())
        if (network.ring(v).valence == 2) ear = v;
    ASSERT_GE(ear, 0);
    const Ring ring = network.ring(ear);
    network.set_position(ear, (network.position(ring[0]) + network.position(ring[1])) / 2);
    const FitScene scene(network, square(20000, 3.5));
    const std::vector<Collapse> collapses = collapses_of(scene);
    const auto of_ear =
        std::find_if(collapses.begin(), collapses.end(), [&](const Collapse& c) { return c.gone == ear; });
    ASSERT_NE(of_ear, collapses.end());
    EXPECT_GE(of_ear->into, 0);
    EXPECT_EQ(of_ear->cost, 0);
}

TEST(Webs, AreOpenedWhereThePointsEnd) {
    EXPECT_GE(webs_of_sheet(1, 20000), 14);  // of 48 faces without points and 21 inner vertices
}

TEST(Webs, AreOpenedAlthoughStrayPointsLieOnThem) {
    EXPECT_GE(webs_of_sheet(1, 20000, 0, 50), 14);  // three on each face, where 156 are expected
}

TEST(Webs, AreNotThereWhereThePointsReachTheEnd) { EXPECT_EQ(webs_of_sheet(4, 20000), 0); }

TEST(Webs, AreNotToldFromFewPoints) { EXPECT_EQ(webs_of_sheet(1, 500), 0); }

TEST(Webs, StayAtBarredVertices) { EXPECT_EQ(webs_of_sheet(1, 20000, 1), 0); }

}  // namespace neuralmesh::boundary_test
