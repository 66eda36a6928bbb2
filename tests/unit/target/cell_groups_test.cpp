// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which cells are connected, against the comparison of all points of all cells.
#include "vcg_core/target/cell_groups.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "tests/unit/support/shapes.h"
#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

using FloatCloud = std::vector<vcg::Point3f>;
using Place = NearestPoints::Place;

std::array<int, 3> coordinates(std::uint64_t code, int level) {
    std::array<int, 3> result{};
    for (int bit = 0; bit < 3 * level; ++bit)
        result[static_cast<std::size_t>(bit % 3)] |= static_cast<int>(code >> bit & 1) << bit / 3;
    return result;
}

/// Neighbours, also across the border of the cube, whose opposite ends meet.
bool are_neighbours(const OccupiedCell& a, const OccupiedCell& b, int level) {
    const std::array<int, 3> p = coordinates(a.code, level), q = coordinates(b.code, level);
    for (std::size_t k = 0; k < 3; ++k) {
        const int apart = std::abs(p[k] - q[k]);
        if (apart > 1 && apart != (1 << level) - 1) return false;
    }
    return true;
}

bool are_close(const NearestPoints& cloud, const OccupiedCell& a, const OccupiedCell& b, int level,
               const std::vector<std::uint8_t>& out) {
    if (std::size_t{a.end - a.begin} * (b.end - b.begin) > kMostPointPairs) return true;
    const float limit = kConnected * cloud.cell_side(level);
    for (Place p = a.begin; p < a.end; ++p)
        for (Place q = b.begin; q < b.end; ++q)
            if (out[p] == 0 && out[q] == 0 &&
                (cloud.point(p) - cloud.point(q)).SquaredNorm() <= limit * limit)
                return true;
    return false;
}

/// By giving the lower label to both of every pair, until nothing changes.
std::vector<std::size_t> plainly_connected(const NearestPoints& cloud, const std::vector<OccupiedCell>& cells,
                                           int level, const std::vector<std::uint8_t>& out) {
    std::vector<std::vector<std::size_t>> neighbours(cells.size());
    for (std::size_t a = 0; a < cells.size(); ++a)
        for (std::size_t b = 0; b < cells.size(); ++b)
            if (are_neighbours(cells[a], cells[b], level) && are_close(cloud, cells[a], cells[b], level, out))
                neighbours[a].push_back(b);
    std::vector<std::size_t> label(cells.size());
    std::iota(label.begin(), label.end(), std::size_t{0});
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t a = 0; a < cells.size(); ++a)
            for (const std::size_t b : neighbours[a]) {
                if (label[b] >= label[a]) continue;
                label[a] = label[b];
                changed = true;
            }
    }
    return label;
}

void expect_the_same(const FloatCloud& points, std::size_t every_out) {
    const NearestPoints cloud(points);
    std::vector<std::uint8_t> out(points.size());
    for (std::size_t i = 0; i < out.size(); i += every_out) out[i] = 1;
    for (int level = 3; level <= 6; ++level) {
        const std::vector<OccupiedCell> cells = occupied_cells(cloud, out, level);
        EXPECT_EQ(connected_cells(cloud, cells, level, out), plainly_connected(cloud, cells, level, out))
            << "level " << level;
    }
}

TEST(CellGroups, AreThoseOfAllPairsOfPoints) {
    Random random(1);
    FloatCloud box, sphere, mixed;
    for (int i = 0; i < 800; ++i) box.push_back(vcg::Point3f::Construct(shapes::in_cube(random)));
    for (const vcg::Point3d& p : shapes::sphere_cloud(1000)) sphere.push_back(vcg::Point3f::Construct(p));
    mixed = sphere;
    for (int clump = 0; clump < 30; ++clump) {
        const vcg::Point3f centre = box[static_cast<std::size_t>(clump)];
        for (int i = 0; i < 60; ++i)
            mixed.push_back(centre + vcg::Point3f::Construct(shapes::in_cube(random)) * 0.02F);
    }
    for (const FloatCloud& cloud : {box, sphere, mixed}) {
        expect_the_same(cloud, cloud.size() + 1);
        expect_the_same(cloud, 3);
    }
}

TEST(CellGroups, PartsWhatTouchesOnlyByItsCells) {
    FloatCloud cloud;  // two planes that are 1.4 cells apart at level 4 and share neighbouring cells
    for (int i = 0; i < 32; ++i)
        for (int j = 0; j < 32; ++j)
            for (const float z : {0.01F, 0.01F + 1.4F / 16})
                cloud.emplace_back((static_cast<float>(i) + 0.5F) / 32, (static_cast<float>(j) + 0.5F) / 32,
                                   z);
    cloud.emplace_back(0.0F, 0.0F, 0.0F);
    cloud.emplace_back(1.0F, 1.0F, 1.0F);
    const NearestPoints index(cloud);
    const std::vector<std::uint8_t> out(cloud.size());
    const std::vector<OccupiedCell> cells = occupied_cells(index, out, 4);
    const std::vector<std::size_t> label = connected_cells(index, cells, 4, out);
    std::size_t first_of_a_group = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) first_of_a_group += label[c] == c ? 1 : 0;
    EXPECT_EQ(first_of_a_group, 3u) << "two planes and the far corner";
}

// Neighbouring cells whose points are far apart: of many points in both, a finer level tells.
TEST(CellGroups, DoNotComparePointsOfFullCells) {
    for (const int count : {90, 150}) {
        FloatCloud cloud{{0, 0, 0}, {1, 1, 1}};
        for (int i = 0; i < count; ++i)
            for (const float x : {0.51F, 0.735F})
                cloud.emplace_back(x + 0.00003F * static_cast<float>(i), 0.55F, 0.55F);
        const NearestPoints index(cloud);
        const std::vector<std::uint8_t> out(cloud.size());
        const std::vector<OccupiedCell> cells = occupied_cells(index, out, 3);
        ASSERT_EQ(cells.size(), 4u);
        const std::vector<std::size_t> label = connected_cells(index, cells, 3, out);
        EXPECT_EQ(label, plainly_connected(index, cells, 3, out));
        EXPECT_EQ(label[1] == label[2], count > 100);
    }
}

}  // namespace
}  // namespace neuralmesh
