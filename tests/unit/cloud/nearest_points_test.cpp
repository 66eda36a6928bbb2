// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The index of a cloud against looking at every point.
#include "vcg_core/cloud/nearest_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

using FloatCloud = std::vector<vcg::Point3f>;
using Neighbours = std::vector<NearestPoints::Neighbour>;

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
                ASSERT_EQ(index.any_within(p, radius, counts), expected) << p << ' ' << radius;
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

}  // namespace
}  // namespace neuralmesh
