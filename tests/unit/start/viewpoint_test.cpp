// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The sides that open start meshes face: by normals, by a sensor, or up.
#include "vcg_core/start/viewpoint.h"
#include "tests/unit/support/depth_camera.h"
#include "tests/unit/support/normal_clouds.h"
#include "vcg_core/mesh/triangle.h"
#include "vcg_core/start/orientation.h"

namespace neuralmesh::viewpoint_test {

using Pairs = std::vector<std::pair<int, int>>;
using vcg::Point3d;
using vcg::Point3f;

// Points turned to a sensor, or up.

const vcg::Point3f kFarAway(2000, 50000, 3);

/// Points with normals that agree within the parts of a surface.
struct Seen {
    ConsolidatedPoints points;
    Pairs neighbours;
    std::vector<int> parts;

    /// The vertices of \p shape, moved by up to \p noise. \p over: the first normal is turned over.
    Seen(const Shape& shape, bool over, double noise = 0) {
        const Network network = network_of(shape, noise);
        for (const VertexId v : network.vertices()) {
            const Ring& ring = network.ring(v);
            vcg::Point3f normal(0, 0, 0);
            for (int i = 0; i < ring.face_count(); ++i)
                normal += area_vector(network.position(v), network.position(ring[i]),
                                      network.position(ring.next(i)));
            add(network.position(v), normal.Normalize());
            for (const VertexId w : ring) neighbours.emplace_back(v, w);
        }
        orient(over);
    }
    void add(const vcg::Point3f& p, const vcg::Point3f& normal) {
        points.positions.push_back(p);
        points.normals.push_back(normal);
        points.radii.push_back(1);
    }
    void orient(bool over) {
        if (over) points.normals.front() = -points.normals.front();
        parts = orient_normals(points.positions, neighbours, {}, points.normals).parts;
    }
    bool turn_to(const vcg::Point3f& origin, const std::optional<vcg::Point3f>& sensor = {}) {
        return turn_to_viewer(neighbours, parts, origin, sensor, points).has_value();
    }

    /// The share of the normals that point to \p viewpoint; with \p far the direction of one.
    double turned_to(const vcg::Point3f& viewpoint, bool far = false) const {
        int count = 0;
        for (std::size_t i = 0; i < points.positions.size(); ++i)
            count += points.normals[i] * (far ? viewpoint : viewpoint - points.positions[i]) > 0 ? 1 : 0;
        return static_cast<double>(count) / points.size();
    }
};

/// A square, turned about the x axis by so many degrees.
Shape tilted(double degrees) {
    const double turn = degrees * shapes::kPi / 180;
    Shape sheet = shapes::grid(30, 30);
    for (vcg::Point3d& p : sheet.positions) p = {p[0], p[1] * std::cos(turn), p[1] * std::sin(turn)};
    return sheet;
}

TEST(ViewOfSheets, IsFromAbove) {
    using TiltAndNoise = std::pair<double, double>;
    for (const auto& [tilt, noise] :
         {TiltAndNoise(0, 0), TiltAndNoise(0, 0.01), TiltAndNoise(30, 0), TiltAndNoise(30, 0.01),
          TiltAndNoise(60, 0), TiltAndNoise(60, 0.005), TiltAndNoise(85, 0)})
        for (const bool over : {false, true}) {
            Seen seen(tilted(tilt), over, noise);
            EXPECT_TRUE(seen.turn_to(kFarAway)) << tilt << ' ' << noise;
            EXPECT_GT(seen.turned_to({0, 0, 1}, true), 0.85) << tilt << ' ' << noise;
        }
}

/// What a sensor at the origin sees along z, \p distance away, with two more squares to the sides of the
/// first and half as far again behind it. From above, which is along z as well, all are single-valued, too.
Shape frame(double distance) {
    Shape seen;
    for (const double side : {-1.0, 0.0, 1.0})
        shapes::append(seen, shapes::grid(10, 10), {side, 0, distance * (side == 0 ? 1 : 1.5)});
    return seen;
}

TEST(Viewpoint, OfAFrameInItsSensorsCoordinatesIsTheSensor) {
    for (const double distance : {1.0, 5.0})
        for (const bool over : {false, true}) {
            Seen seen(frame(distance), over);
            EXPECT_TRUE(seen.turn_to({0, 0, 0}));
            EXPECT_EQ(seen.turned_to({0, 0, 0}), 1) << distance;
        }
}

TEST(Viewpoint, IsASensorThatSeesAllRatherThanTheOrigin) {
    for (const bool over : {false, true}) {
        Seen seen(frame(1), over);
        EXPECT_TRUE(seen.turn_to({0, 0, 0}, vcg::Point3f(0, 0, 2)));
        EXPECT_EQ(seen.turned_to({0, 0, 2}), 1);
        EXPECT_TRUE(seen.turn_to({0, 0, 0}, vcg::Point3f(0, 0, 1.2F)));  // between the squares
        EXPECT_EQ(seen.turned_to({0, 0, 1.2F}), 1);
    }
}

TEST(Viewpoint, TellsADepthStepFromTheSidesOfAWall) {
    // Links across the step alone say that the squares face away from each other.
    Seen seen(shapes::grid(10, 10), false);
    const int first = seen.points.size();
    for (int i = 0; i < first; ++i) {
        seen.add(seen.points.positions[static_cast<std::size_t>(i)] + vcg::Point3f(0, 0, 0.1F), {0, 0, 1});
        seen.neighbours.emplace_back(i, first + i);
        if (i % 10 != 0) seen.neighbours.emplace_back(first + i, first + i - 1);
        if (i >= 10) seen.neighbours.emplace_back(first + i, first + i - 10);
    }
    seen.orient(false);
    ASSERT_EQ(seen.turned_to({0, 0, 1}, true), 0.5);
    EXPECT_TRUE(seen.turn_to(kFarAway));
    EXPECT_EQ(seen.turned_to({0, 0, 1}, true), 1);
}

TEST(Viewpoint, TurnsAWallByAllOfItsPoints) {
    // Of stairs, the tread is seen well and the wall, below its edge, at an angle of 20 to 30 degrees. Links
    // between the two would have its back seen.
    constexpr int kAcross = 10;
    Seen seen(shapes::grid(kAcross, kAcross), false);
    const int first = seen.points.size();
    for (int i = 0; i < kAcross; ++i) {
        seen.neighbours.emplace_back(first - kAcross + i, first + i);
        for (int down = 0; down < kAcross; ++down) {
            const int own = first + down * kAcross + i;
            if (i > 0) seen.neighbours.emplace_back(own, own - 1);
            if (down > 0) seen.neighbours.emplace_back(own, own - kAcross);
        }
    }
    for (int down = 1; down <= kAcross; ++down)
        for (int i = 0; i < kAcross; ++i)
            seen.add(
                {0.5F + 0.1F, static_cast<float>(i) / (kAcross - 1) - 0.5F, -0.1F * static_cast<float>(down)},
                {1, 0, 0});
    seen.orient(false);
    const vcg::Point3f sensor(-3, 0, 8);
    ASSERT_EQ(seen.turned_to(sensor), 0.5);
    EXPECT_TRUE(seen.turn_to(kFarAway, sensor));
    EXPECT_EQ(seen.turned_to(sensor), 1);
}

TEST(Viewpoint, IsAboveWhereTheOriginIsNoSensor) {
    // Among the points, beside them, and as far away as that of a country's coordinates.
    for (const vcg::Point3f& origin :
         {vcg::Point3f(0, 0, 0), vcg::Point3f(0, 0, -0.1F), vcg::Point3f(0, 0, -30)})
        for (const bool over : {false, true}) {
            Seen seen(tilted(10), over);
            EXPECT_TRUE(seen.turn_to(origin));
            EXPECT_EQ(seen.turned_to({0, 0, 1}, true), 1);
        }
}

TEST(Viewpoint, IsNowhereIfNobodySeesAllOfTheSurface) {
    for (const Shape& shape : {open_shapes::open_sphere(), shapes::tube(24, 8), shapes::icosphere(2)})
        for (const vcg::Point3f& origin : {vcg::Point3f(0, 0, 0), vcg::Point3f(0, -5, 0.5F), kFarAway})
            for (const bool over : {false, true}) {
                Seen seen(shape, over);
                const auto normals = seen.points.normals;
                EXPECT_FALSE(seen.turn_to(origin));
                EXPECT_EQ(seen.points.normals, normals);
            }
}

// Start meshes turned by normals.

/// Twice the signed volume of the fans from the origin of the input: positive if it faces away from there.
double facing_away(const Network& network, const TargetSpace& target, VertexId first, VertexId end) {
    double sum = 0;
    for (const Triangle& f : network.faces()) {
        if (f[0] < first || f[0] >= end) continue;
        const auto at = [&](int k) {
            return target.frame().outside(network.position(f[static_cast<std::size_t>(k)]));
        };
        sum += at(0) * (at(1) ^ at(2));
    }
    return sum;
}

TEST(Facing, OfAnOpenMeshFollowsMostNormals) {
    const Cloud cloud = bowl(8000);
    for (const bool in : {false, true}) {
        const TargetSpace target = target_of(cloud, flipped(in ? inward(cloud) : outward(cloud), 5));
        Network network = network_in_frame(target, open_shapes::open_sphere());
        ASSERT_EQ(network.boundary_loop_count(), 1);
        orient_convex_side_outward(network);
        EXPECT_GT(facing_away(network, target, 0, network.slot_count()), 0);
        const OrientationVote before = orientation_votes(network, target).front();
        EXPECT_NEAR(before.share_along(), in ? 0.2 : 0.8, 0.05);
        EXPECT_EQ(orient_by_normals(network, target), 1);
        EXPECT_EQ(facing_away(network, target, 0, network.slot_count()) < 0, in);
        EXPECT_NEAR(orientation_votes(network, target).front().share_along(), 0.8, 0.05);
        EXPECT_EQ(network.validate(), "");
    }
}

TEST(Facing, OfAnOpenMeshStaysWhereNormalsDisagreeOrAreMissing) {
    const Cloud cloud = bowl(8000);
    const TargetSpace disagreeing = target_of(cloud, flipped(inward(cloud), 2));
    const TargetSpace without = target_of(cloud);
    for (const TargetSpace* target : {&disagreeing, &without}) {
        Network network = network_in_frame(*target, open_shapes::open_sphere());
        const auto faces = network.faces();
        EXPECT_EQ(orient_by_normals(network, *target), 0);
        EXPECT_EQ(network.faces(), faces);
    }
}

TEST(Facing, OfEveryComponentIsItsOwn) {
    // Two bowls side by side, whose normals point in and out.
    Shape both = open_shapes::open_sphere();
    const auto first = static_cast<VertexId>(both.positions.size());
    shapes::append(both, open_shapes::open_sphere(), {3, 0, 0});
    Cloud cloud = bowl(8000);
    std::vector<PackedNormal> normals = outward(cloud);
    for (const vcg::Point3d& p : bowl(8000)) {
        cloud.push_back(p + vcg::Point3d(3, 0, 0));
        normals.push_back(opposite(packed_point(p)));
    }
    const TargetSpace target = target_of(cloud, normals);
    Network network = network_in_frame(target, both);
    EXPECT_EQ(orient_by_normals(network, target), 2);
    const std::vector<OrientationVote> votes = orientation_votes(network, target);
    ASSERT_EQ(votes.size(), 2U);
    for (const OrientationVote& vote : votes) EXPECT_GT(vote.share_along(), 0.99);
    EXPECT_GT(facing_away(network, target, 0, first), 0);
    EXPECT_EQ(network.validate(), "");
}

// The place of the camera of one frame, found from its points; none where there was no single camera.

/// A frame whose camera stands at \p camera and looks along x.
Cloud frame_from(const Point3d& camera, unsigned seed) {
    Cloud cloud = sensors::depth_frame(200, seed);
    for (Point3d& p : cloud) p = camera + Point3d(p[2], p[0], p[1]);
    return cloud;
}

std::optional<Point3f> found(const Cloud& cloud) {
    const std::vector<vcg::Point3f> points = shapes::in_float(cloud);  // which the surveys refer to
    Surveys surveys(points, 1);
    return sensor_place(surveys.points().cloud, surveys.surface().places());
}

TEST(SensorPlace, IsThatOfTheCamera) {
    for (const unsigned seed : {1U, 2U, 3U})
        for (const Point3d& camera : {Point3d(0, 0, 0), Point3d(-2, 3, 1), Point3d(20, 4, -7)}) {
            const std::optional<Point3f> place = found(frame_from(camera, seed));
            ASSERT_TRUE(place) << seed;
            EXPECT_LT((Point3d::Construct(*place) - camera).Norm(), 0.4) << seed;  // the scene is 4 wide
        }
}

TEST(SensorPlace, IsNoneForTwoCameras) {
    Cloud cloud = frame_from({0, 0, 0}, 1);
    for (const Point3d& p : sensors::depth_frame(200, 2)) cloud.emplace_back(6 - p[2], p[0], p[1]);
    EXPECT_FALSE(found(cloud));
}

TEST(SensorPlace, IsNoneForEvenPoints) {
    EXPECT_FALSE(found(shapes::plane_cloud(20000)));
    EXPECT_FALSE(found(sensors::aerial_scan(20000, 10)));
    EXPECT_FALSE(found(shapes::sphere_cloud(20000)));
    EXPECT_FALSE(found(shapes::plane_cloud(30)));
    Cloud repeated = shapes::plane_cloud(8000);
    repeated.resize(8200, Point3d(0.2, 0.3, 0.2));
    EXPECT_FALSE(found(repeated));
}

}  // namespace neuralmesh::viewpoint_test
