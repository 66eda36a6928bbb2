// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Neighbours of points, and steps of their depth.
#include "tests/unit/support/depth_camera.h"
#include "vcg_core/cloud/depth_steps.h"
#include "vcg_core/cloud/nearest_points.h"

namespace neuralmesh::neighbours_test {

using FloatCloud = std::vector<vcg::Point3f>;
using Neighbours = std::vector<NearestPoints::Neighbour>;
using vcg::Point3f;

// The index of a cloud against looking at every point.

FloatCloud cube(std::size_t count, float side, const vcg::Point3f& corner, Random& random) {
    FloatCloud cloud;
    for (std::size_t i = 0; i < count; ++i)
        cloud.push_back(corner + vcg::Point3f(random.unit(), random.unit(), random.unit()) * side);
    return cloud;
}

void append(FloatCloud& cloud, const FloatCloud& more) {
    cloud.insert(cloud.end(), more.begin(), more.end());
}

/// Every kind of density that a scan may have, and worse.
std::vector<FloatCloud> clouds() {
    Random random(1);
    std::vector<FloatCloud> all = {cube(700, 1, {-0.5F, -0.5F, -0.5F}, random)};
    FloatCloud uneven = cube(300, 1, {0, 0, 0}, random);
    append(uneven, cube(300, 1e-3F, {0.3F, 0.3F, 0.3F}, random));
    append(uneven, cube(300, 1e-6F, {0.7F, 0.2F, 0.1F}, random));
    all.push_back(uneven);
    FloatCloud with_far = cube(500, 1e-5F, {0, 0, 0}, random);
    with_far.emplace_back(1.0F, 0.0F, 0.0F);
    all.push_back(with_far);
    FloatCloud repeated = cube(100, 1, {0, 0, 0}, random);
    for (int i = 0; i < 2; ++i) append(repeated, FloatCloud(repeated));
    all.push_back(repeated);
    FloatCloud line;
    for (int i = 0; i < 400; ++i) line.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
    all.push_back(line);
    all.push_back({{0, 0, 0}});
    all.push_back(FloatCloud(40, {1, 2, 3}));
    return all;
}

Neighbours by_looking_at_all(const NearestPoints& index, NearestPoints::Place place, int k) {
    Neighbours all;
    for (NearestPoints::Place p = 0; p < index.size(); ++p)
        if (p != place) all.push_back({(index.point(p) - index.point(place)).SquaredNorm(), p});
    std::sort(all.begin(), all.end());
    all.resize(std::min(all.size(), static_cast<std::size_t>(k)));
    return all;
}

TEST(NearestPoints, AreThoseOfABruteForceSearch) {
    for (const FloatCloud& cloud : clouds()) {
        const NearestPoints index(cloud);
        Neighbours found;
        for (NearestPoints::Place p = 0; p < index.size(); p += 3)
            for (const int k : {1, 10, 48}) {
                index.nearest(p, k, found);
                const Neighbours expected = by_looking_at_all(index, p, k);
                ASSERT_EQ(found.size(), expected.size());
                for (std::size_t i = 0; i < found.size(); ++i) {
                    ASSERT_EQ(found[i].squared_distance, expected[i].squared_distance);
                    ASSERT_EQ(found[i].place, expected[i].place) << "ties go to the lower place";
                }
            }
    }
}

TEST(NearestPoints, AnyWithinAgreesWithBruteForce) {
    for (const FloatCloud& cloud : clouds()) {
        const NearestPoints index(cloud);
        const auto counts = [](NearestPoints::Place q) { return q % 5 == 0; };
        for (NearestPoints::Place p = 0; p < index.size(); p += 7)
            for (const float radius : {0.0F, 1e-6F, 1e-3F, 0.05F, 0.4F, 3.0F}) {
                bool expected = false;
                for (NearestPoints::Place q = 0; q < index.size(); ++q)
                    expected = expected || (counts(q) && (index.point(q) - index.point(p)).SquaredNorm() <=
                                                             radius * radius);
                ASSERT_EQ(index.any_within(index.point(p), radius, counts), expected) << p << ' ' << radius;
            }
    }
}

TEST(NearestPoints, EveryPointHasOnePlaceAndCellsAscend) {
    for (const FloatCloud& cloud : clouds()) {
        const NearestPoints index(cloud);
        std::vector<int> seen(cloud.size());
        for (NearestPoints::Place p = 0; p < index.size(); ++p) ++seen[index.index(p)];
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(cloud.size()));
        for (const int level : {1, 4, 9})
            for (NearestPoints::Place p = 1; p < index.size(); ++p)
                ASSERT_LE(index.cell(p - 1, level), index.cell(p, level));
    }
}

/// Steps, and the points around each place on which they are judged.
class Steps {
public:
    explicit Steps(const std::vector<Point3f>& points) : cloud_(points), steps_(cloud_) {}

    /// Of points that are \p spacing apart.
    float deviation(const Point3f& p, const Point3f& normal, float spacing) const {
        constexpr float kSpacings = 3;
        std::vector<Point3f> near;
        cloud_.within(p, kSpacings * spacing, 100, near);
        return steps_.deviation(p, normal, spacing, near);
    }

private:
    NearestPoints cloud_;
    DepthSteps steps_;
};

TEST(DepthSteps, GrowWithTheDepth) {
    const std::vector<Point3f> points = shapes::in_float(sensors::frame_of_steps(240));
    const Steps steps(points);
    constexpr float kSpacing = 0.012F;
    int none = 0, all = 0;
    for (std::size_t i = 0; i < points.size(); i += 97) {
        const double z = static_cast<double>(points[i][2]), step = z * z / 351;
        const float found = steps.deviation(points[i], {0, 0, 1}, kSpacing);
        ++all;
        // The first and the last value, the row in the middle, whose y are all 0, and ends of terraces.
        if (found == 0) {
            ++none;
            continue;
        }
        // Of points that are dithered between two steps.
        EXPECT_NEAR(static_cast<double>(found) * std::sqrt(6), step, 0.02 * step) << z;
        EXPECT_NEAR(steps.deviation(points[i], {0.8F, 0, 0.6F}, kSpacing) / found, 0.6F, 1e-3F);
        EXPECT_EQ(steps.deviation(points[i], {1, 0, 0}, kSpacing), 0);
        EXPECT_EQ(steps.deviation(points[i], {0, 0, 1}, 0.06F), 0) << "a spacing is longer";
    }
    EXPECT_LT(none, all / 10);
}

/// How many of some of the points have steps along z, or along their way from the origin.
int places_with_steps(const std::vector<Point3f>& points, float spacing, bool round) {
    const Steps steps(points);
    int found = 0;
    for (std::size_t i = 0; i < points.size(); i += 97) {
        Point3f normal = round ? points[i] : Point3f(0, 0, 1);
        found += steps.deviation(points[i], normal.Normalize(), spacing) > 0 ? 1 : 0;
    }
    return found;
}

TEST(DepthSteps, AreNoneOnGridsOnStairsAndWithoutRounding) {
    std::vector<Point3f> grid, stairs, random;
    Random numbers(1);
    for (int i = 0; i < 40000; ++i) {
        grid.emplace_back(static_cast<float>(i % 200), static_cast<float>(i / 200 % 200),
                          std::floor(0.3F * static_cast<float>(i % 200)));
        stairs.emplace_back(numbers.unit(), numbers.unit(), static_cast<float>(i % 10));
        random.emplace_back(numbers.unit(), numbers.unit(), numbers.unit());
    }
    EXPECT_EQ(places_with_steps(grid, 1, false), 0);
    EXPECT_EQ(places_with_steps(stairs, 0.01F, false), 0);
    EXPECT_EQ(places_with_steps(random, 0.01F, false), 0);
}

TEST(DepthSteps, AreNoneOnTheRingsOfALathe) {
    constexpr int kRings = 100;
    std::vector<Point3f> ball;
    for (int ring = 1; ring < kRings; ++ring) {
        const double polar = shapes::kPi * ring / kRings;
        const int points = static_cast<int>(2 * kRings * std::sin(polar)) + 3;
        for (int i = 0; i < points; ++i) {
            const double turn = 2 * shapes::kPi * i / points;
            ball.push_back(Point3f::Construct(vcg::Point3d(
                std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar))));
        }
    }
    // But for a place or two near the poles.
    EXPECT_LE(places_with_steps(ball, 0.03F, true), 2);
}

}  // namespace neuralmesh::neighbours_test
