// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Accepted and refused inputs, the frame, and the distribution of the samples.
#include "vcg_core/cloud/target_space.h"

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh::target_space_test {

using vcg::Point3d;

/// The message of the error that the cloud causes, empty if it causes none.
template <class Given>
std::string complaint(const Given& given) {
    return complaint_of([&] { target_of(given); });
}

void expect_complaint(const Cloud& cloud, const std::string& part) {
    EXPECT_NE(complaint(cloud).find(part), std::string::npos) << complaint(cloud);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(TargetSpace, RefusesAnEmptyCloud) { expect_complaint({}, "no points"); }

TEST(TargetSpace, CountsCoordinatesThatAreNotFinite) {
    Cloud cloud = shapes::sphere_cloud(100);
    cloud[3][0] = kNan;
    cloud[50][1] = kInfinity;
    cloud[99][2] = -kInfinity;
    expect_complaint(cloud, "3 of the 100 ");
    expect_complaint(Cloud(5, Point3d(kNan, kNan, kNan)), "5 of the 5 ");
}

TEST(TargetSpace, RefusesFewerThanFourDistinctPoints) {
    expect_complaint({{1, 2, 3}}, "at least 4");
    expect_complaint(Cloud(1000, Point3d(5, 5, 5)), "at least 4");
    expect_complaint({{0, 0, 0}, {1, 0, 0}}, "only 2 distinct points");
    Cloud cloud;
    for (int i = 0; i < 3000; ++i) cloud.emplace_back(i % 3 == 0 ? 1 : 0, i % 3 == 1 ? 1 : 0, 0);
    expect_complaint(cloud, "only 3 distinct points");
    cloud.emplace_back(1, 1, 0);
    EXPECT_EQ(complaint(cloud), "");
}

/// Positions and sizes of a cloud that double resolves at least as well as float resolves the frame of the
/// core.
struct Placement {
    Point3d offset;
    double scale;
};
const Placement kPlacements[] = {{{0, 0, 0}, 1},         {{1e7, -1e7, 1e7}, 1},   {{0, 0, 0}, 1e-9},
                                 {{0, 0, 0}, 1e9},       {{1e9, 1e9, -1e9}, 1e9}, {{1, 1, 1}, 1e-6},
                                 {{5e6, 4e5, 100}, 200}, {{0, 0, 0}, 1e100},      {{0, 0, 0}, 1e-100}};

Cloud placed(Cloud cloud, const Placement& place) {
    for (Point3d& p : cloud) p = p * place.scale + place.offset;
    return cloud;
}

TEST(TargetSpace, RefusesPointsOnALineWhereverItIs) {
    for (const Placement& place : kPlacements) {
        SCOPED_TRACE(testing::Message() << place.offset[0] << " scale " << place.scale);
        for (const Point3d& direction :
             {Point3d(1, 0, 0), Point3d(0, 0, 1), Point3d(1, 2, 3), Point3d(-3, 1e-3, 2)}) {
            Random random(1);
            Cloud cloud;
            for (int i = 0; i < 500; ++i) cloud.push_back(direction * shapes::signed_unit(random));
            expect_complaint(placed(cloud, place), "straight line");
        }
    }
}

TEST(TargetSpace, AcceptsPointsThatAreNotOnALine) {
    for (const Placement& place : kPlacements) {
        SCOPED_TRACE(testing::Message() << place.offset[0] << " scale " << place.scale);
        EXPECT_EQ(complaint(placed(shapes::sphere_cloud(100), place)), "");
        EXPECT_EQ(complaint(placed(shapes::plane_cloud(100), place)), "");
        EXPECT_EQ(complaint(placed({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, place)), "");
    }
    Cloud nearly;
    for (int i = 0; i < 100; ++i) nearly.emplace_back(i, 0, 0);
    nearly[60] = {60, 0.01, 0};
    EXPECT_EQ(complaint(nearly), "");
}

TEST(TargetSpace, RefusesABoxBeyondDoublePrecision) {
    expect_complaint(placed(shapes::sphere_cloud(50), {{0, 0, 0}, 1e308}), "scale it");
    expect_complaint(placed(shapes::sphere_cloud(50), {{0, 0, 0}, 1e-200}), "scale it");
}

TEST(TargetSpace, FrameIsCentredWithDiagonalOne) {
    for (const Placement& place : kPlacements) {
        const Cloud cloud = placed(shapes::box_cloud(2000, {1, 2, 3}), place);
        const TargetSpace target = target_of(cloud);
        vcg::Box3d box;
        for (const vcg::Point3f& p : target.positions()) box.Add(Point3d::Construct(p));
        EXPECT_NEAR((box.max - box.min).Norm(), 1, 1e-5);
        EXPECT_NEAR((box.max + box.min).Norm(), 0, 1e-6);
        ASSERT_EQ(target.positions().size(), cloud.size());
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            const Point3d back = target.frame().outside(target.positions()[i]);
            ASSERT_LT((back - cloud[i]).Norm(), 1e-7 * target.frame().diagonal);
            ASSERT_EQ(target.frame().inside(cloud[i]), target.positions()[i]);
        }
    }
}

/// Sum of (seen - expected)^2 / expected.
double chi_square(const std::vector<int>& seen, const std::vector<double>& expected) {
    double sum = 0;
    for (std::size_t i = 0; i < seen.size(); ++i)
        sum += (seen[i] - expected[i]) * (seen[i] - expected[i]) / expected[i];
    return sum;
}

/// The chi-square value that a uniform sample exceeds in one of ten thousand cases (approximation of Wilson
/// and Hilferty).
double limit(int degrees) {
    const double a = 2.0 / (9.0 * degrees);
    return degrees * std::pow(1 - a + 3.719 * std::sqrt(a), 3);
}

TEST(TargetSpace, DrawsEveryPointEquallyOften) {
    const int n = 500;
    const TargetSpace target = target_of(shapes::sphere_cloud(n));
    std::map<std::array<float, 3>, int> seen;
    Random random(1);
    for (int i = 0; i < 100 * n; ++i) {
        const vcg::Point3f p = target.sample(random);
        ++seen[{p[0], p[1], p[2]}];
    }
    ASSERT_EQ(seen.size(), static_cast<std::size_t>(n));
    std::vector<int> counts;
    for (const auto& entry : seen) counts.push_back(entry.second);
    EXPECT_LT(chi_square(counts, std::vector<double>(counts.size(), 100)), limit(n - 1));
}

TEST(TargetSpace, DrawsFromFacesInProportionToArea) {
    // Triangles side by side in a strip, of areas 1 to 60 and, every third, 0.
    Shape strip;
    std::vector<double> area;
    for (int i = 0; i < 60; ++i) {
        const int a = 3 * i;
        const double height = i % 3 == 2 ? 0 : i + 1;
        strip.positions.insert(strip.positions.end(),
                               {{i + 0.0, 0, 0}, {i + 0.9, 0, 0}, {i + 0.3, height, 0}});
        strip.faces.push_back({a, a + 1, a + 2});
        area.push_back(height);
    }
    const TargetSpace target = target_of(strip);
    double whole = 0;
    for (const double a : area) whole += a;
    std::vector<int> seen(60, 0);
    const int n = 200000;
    Random random(2);
    for (int i = 0; i < n; ++i)
        ++seen[static_cast<std::size_t>(target.frame().outside(target.sample(random))[0] + 1e-4)];
    std::vector<int> counts;
    std::vector<double> expected;
    for (std::size_t i = 0; i < area.size(); ++i) {
        if (area[i] == 0) {
            EXPECT_EQ(seen[i], 0) << i;
            continue;
        }
        counts.push_back(seen[i]);
        expected.push_back(n * area[i] / whole);
    }
    EXPECT_LT(chi_square(counts, expected), limit(static_cast<int>(counts.size()) - 1));
}

TEST(TargetSpace, DrawsUniformlyWithinATriangle) {
    const Shape triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}};
    const TargetSpace target = target_of(triangle);
    const int cells = 10;
    std::vector<int> seen(std::size_t{cells} * cells, 0);
    const int n = 100000;
    Random random(3);
    for (int i = 0; i < n; ++i) {
        const Point3d p = target.frame().outside(target.sample(random));
        ASSERT_NEAR(p[2], 0, 1e-6);
        const auto cell = [&](double x) {
            return std::min(cells - 1, std::max(0, static_cast<int>(x * cells)));
        };
        ASSERT_TRUE(p[0] > -1e-6 && p[0] < 1 + 1e-6 && p[1] > -1e-6 && p[1] < 1 + 1e-6);
        const int hit = cell(p[0]) * cells + cell(p[1]);
        ++seen[static_cast<std::size_t>(hit)];
    }
    EXPECT_LT(chi_square(seen, std::vector<double>(seen.size(), n / double(cells * cells))),
              limit(cells * cells - 1));
}

TEST(TargetSpace, MovesWhatItDraws) {
    const auto moved = [](const vcg::Point3f& p) { return p * 1.25F; };
    const auto on_sphere = [](Random& random) {
        const Point3d p = shapes::in_ball(random);
        return p / p.Norm();
    };
    for (const TargetSpace& target : {target_of(shapes::cube()), TargetSpace::drawn_by(on_sphere, 1000)}) {
        const TargetSpace other = target.moved(moved);
        EXPECT_EQ(other.frame().diagonal, target.frame().diagonal);
        Random random(4), again(4);
        for (int i = 0; i < 1000; ++i) ASSERT_EQ(other.sample(again), moved(target.sample(random)));
        EXPECT_EQ(other.positions(), target.positions());
    }
}

TEST(TargetSpace, MovesItsPointsInBatches) {
    const TargetSpace target = target_of(shapes::sphere_cloud(250000));
    int batches = 0;
    const TargetSpace other = target.moved_in_batches([&](Span<vcg::Point3f> batch) {
        ++batches;
        for (vcg::Point3f& p : batch) p *= 1.25F;
    });
    EXPECT_GT(batches, 1);
    EXPECT_EQ(other.frame().diagonal, target.frame().diagonal);
    ASSERT_EQ(other.positions().size(), target.positions().size());
    for (std::size_t i = 0; i < target.positions().size(); ++i)
        ASSERT_EQ(other.positions()[i], target.positions()[i] * 1.25F);
    Random random(4), again(4);
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(other.sample(again), target.sample(random) * 1.25F);
}

TEST(TargetSpace, RefusesFacesWithoutArea) {
    Shape flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 1}, {2, 3, 3}}};
    EXPECT_NE(complaint(flat).find("no area"), std::string::npos);
}

/// The new frame equals that of the cloud without the far point.
TEST(TargetSpace, LeavesAFarPointOutOfTheFrame) {
    Cloud cloud = shapes::sphere_cloud(1000);
    const TargetSpace alone = target_of(cloud);
    cloud.emplace_back(3e5, -1e5, 7e5);
    std::vector<std::uint8_t> left_out(1001, 0);
    left_out.back() = 1;
    const std::optional<TargetSpace> rest = target_of(cloud).without(left_out);
    ASSERT_TRUE(rest.has_value());
    EXPECT_NEAR(rest->frame().diagonal, alone.frame().diagonal, 1e-6);
    for (std::size_t i = 0; i < 1000; ++i)
        ASSERT_LT((rest->frame().outside(rest->positions()[i]) - cloud[i]).Norm(), 1e-6) << i;
}

TEST(TargetSpace, ExplainsThatFarPointsHideTheRest) {
    Cloud cloud = shapes::sphere_cloud(1000);
    cloud.emplace_back(1e30, 0, 0);
    expect_complaint(cloud, "delete the few that lie far away");
}

TEST(TargetSpace, RefusesToLeaveNoSurface) {
    Cloud line;
    for (int i = 0; i < 30; ++i) line.emplace_back(i, 0, 0);
    line.emplace_back(15, 10, 0);
    std::vector<std::uint8_t> left_out(31, 0);
    left_out[30] = 1;
    EXPECT_FALSE(target_of(line).without(left_out).has_value());
    EXPECT_FALSE(target_of(line).without(std::vector<std::uint8_t>(31, 1)).has_value());
}

/// The positions of each_place_once(), empty if it returns nothing.
std::vector<vcg::Point3f> without_duplicates(const Cloud& cloud) {
    const std::optional<TargetSpace> once = target_of(cloud).each_place_once();
    return once ? once->positions() : std::vector<vcg::Point3f>();
}

TEST(TargetSpace, KeepsAFewDuplicates) {
    Cloud cloud = shapes::sphere_cloud(1000);
    for (int i = 0; i < 100; ++i) cloud.push_back(cloud[static_cast<std::size_t>(i)]);
    EXPECT_TRUE(without_duplicates(cloud).empty());
    EXPECT_TRUE(without_duplicates(shapes::sphere_cloud(300000)).empty());
}

TEST(TargetSpace, RemovesManyDuplicates) {
    Cloud cloud = shapes::sphere_cloud(1000);
    cloud[0] = {0.0, 0.5, 0.5};
    for (int i = 0; i < 112; ++i) cloud.push_back(cloud[static_cast<std::size_t>(i)]);
    EXPECT_EQ(without_duplicates(cloud).size(), 1000U);
}

/// A number in every normal: a digit to the base of 100 in each coordinate.
PackedNormal numbered(std::size_t i) {
    return {static_cast<std::int8_t>(i % 100 + 1), static_cast<std::int8_t>(i / 100 % 100),
            static_cast<std::int8_t>(i / 10000)};
}

std::size_t number_of(const PackedNormal& n) {
    return static_cast<std::size_t>(n[0] - 1 + 100 * n[1] + 10000 * n[2]);
}

/// Every point of \p target has the normal and the colour of its place in \p cloud.
void expect_carried(const TargetSpace& target, const Cloud& cloud) {
    ASSERT_EQ(target.normals().size(), target.positions().size());
    ASSERT_EQ(target.colors().size(), target.positions().size());
    for (std::size_t i = 0; i < target.positions().size(); ++i) {
        const std::size_t given = number_of(target.normals()[i]);
        const Point3d place = target.frame().outside(target.positions()[i]);
        ASSERT_LT((place - cloud[given]).Norm(), 1e-6) << i;
        EXPECT_EQ(target.colors()[i][0], given % 256);
    }
}

TargetSpace with_numbers(const Cloud& cloud) {
    TargetSpace target = target_of(cloud);
    std::vector<PackedNormal> normals;
    std::vector<Color> colors;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        normals.push_back(numbered(i));
        colors.push_back({static_cast<unsigned char>(i % 256), 0, 0});
    }
    target.set_normals(normals);
    target.set_colors(colors);
    return target;
}

TEST(TargetSpace, CarriesNormalsThroughWhatLeavesOutAndReorders) {
    Cloud cloud = shapes::uneven_sphere_cloud(10000, 10);
    const TargetSpace target = with_numbers(cloud);
    expect_carried(target, cloud);
    std::vector<std::uint8_t> out(cloud.size(), 0);
    for (std::size_t i = 0; i < out.size(); i += 3) out[i] = 1;
    const std::optional<TargetSpace> rest = target.without(out);
    ASSERT_TRUE(rest);
    EXPECT_EQ(rest->positions().size(), cloud.size() * 2 / 3);
    for (const PackedNormal& n : rest->normals()) EXPECT_NE(number_of(n) % 3, 0U);
    expect_carried(*rest, cloud);
    const std::optional<TargetSpace> even = target.evenly(CloudSurvey(target.positions(), 1));
    ASSERT_TRUE(even);
    expect_carried(*even, cloud);
}

TEST(TargetSpace, KeepsTheFirstNormalOfRepeatedPoints) {
    Cloud cloud = shapes::sphere_cloud(5000);
    cloud.insert(cloud.end(), cloud.begin(), cloud.begin() + 2500);
    const std::optional<TargetSpace> once = with_numbers(cloud).each_place_once();
    ASSERT_TRUE(once);
    EXPECT_EQ(once->positions().size(), 5000U);
    expect_carried(*once, cloud);
    for (const PackedNormal& n : once->normals()) EXPECT_LT(number_of(n), 5000U);
}

TEST(TargetSpace, HasNoNormalsIfAllAreZero) {
    TargetSpace target = target_of(shapes::sphere_cloud(100));
    EXPECT_FALSE(target.has_normals());
    target.set_normals(std::vector<PackedNormal>(100, kNoNormal));
    EXPECT_FALSE(target.has_normals());
    std::vector<PackedNormal> one(100, kNoNormal);
    one[7] = {0, 0, 127};
    target.set_normals(one);
    EXPECT_TRUE(target.has_normals());
}

TEST(TargetSpace, DrawsManyPointsAsOneByOne) {
    const TargetSpace target = target_of(shapes::sphere_cloud(1000));
    Random one(3), many(3);
    std::vector<vcg::Point3f> samples;
    target.sample(many, 77, samples);
    ASSERT_EQ(samples.size(), 77U);
    for (const vcg::Point3f& p : samples) EXPECT_EQ(p, target.sample(one));
}

}  // namespace neuralmesh::target_space_test
