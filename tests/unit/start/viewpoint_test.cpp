// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Points turned to a sensor, or up.
#include "vcg_core/start/viewpoint.h"

#include <gtest/gtest.h>

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/mesh/triangle.h"
#include "vcg_core/start/normal_orientation.h"

namespace neuralmesh {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

const vcg::Point3f kFarAway(2000, 50000, 3);

/// Points with normals that agree within the parts of a surface.
struct Seen {
    ConsolidatedPoints points;
    Pairs neighbours;
    std::vector<int> parts;

    /// The vertices of \p shape, moved by up to \p noise. \p over: the first normal is turned over.
    Seen(const shapes::Shape& shape, bool over, double noise = 0) {
        const Network network = referee::network_of(shape, noise);
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
shapes::Shape tilted(double degrees) {
    const double turn = degrees * shapes::kPi / 180;
    shapes::Shape sheet = shapes::grid(30, 30);
    for (vcg::Point3d& p : sheet.positions) p = {p[0], p[1] * std::cos(turn), p[1] * std::sin(turn)};
    return sheet;
}

struct TiltedSheet {
    double tilt, noise;
};

class ViewOfSheets : public testing::TestWithParam<TiltedSheet> {};

TEST_P(ViewOfSheets, IsFromAbove) {
    for (const bool over : {false, true}) {
        Seen seen(tilted(GetParam().tilt), over, GetParam().noise);
        EXPECT_TRUE(seen.turn_to(kFarAway));
        EXPECT_GT(seen.turned_to({0, 0, 1}, true), 0.85);
    }
}

INSTANTIATE_TEST_SUITE_P(TiltsAndNoise, ViewOfSheets,
                         testing::Values(TiltedSheet{0, 0}, TiltedSheet{0, 0.01}, TiltedSheet{30, 0},
                                         TiltedSheet{30, 0.01}, TiltedSheet{60, 0}, TiltedSheet{60, 0.005},
                                         TiltedSheet{85, 0}));

/// What a sensor at the origin sees along z, \p distance away, with two more squares to the sides of the
/// first and half as far again behind it. From above, which is along z as well, all are single-valued, too.
shapes::Shape frame(double distance) {
    shapes::Shape seen;
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
    for (const shapes::Shape& shape : {open_shapes::open_sphere(), shapes::tube(24, 8), shapes::icosphere(2)})
        for (const vcg::Point3f& origin : {vcg::Point3f(0, 0, 0), vcg::Point3f(0, -5, 0.5F), kFarAway})
            for (const bool over : {false, true}) {
                Seen seen(shape, over);
                const auto normals = seen.points.normals;
                EXPECT_FALSE(seen.turn_to(origin));
                EXPECT_EQ(seen.points.normals, normals);
            }
}

}  // namespace
}  // namespace neuralmesh
