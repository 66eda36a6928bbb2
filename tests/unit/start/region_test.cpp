// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A cloud on one lattice: clearances, spaces, outliers, and the vote of several radii.
#include "tests/unit/support/shapes.h"
#include "tests/unit/support/small_lattice.h"
#include "vcg_core/start/clearance.h"
#include "vcg_core/start/lattice_survey.h"
#include "vcg_core/start/region.h"

namespace neuralmesh::region_test {

using vcg::Point3f;

// Distances and clearances against brute force.

constexpr int kLargestRadius = 5;

TEST(Clearance, DistancesAreThoseOfBruteForce) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const Lattice lattice = small_lattice();
        const PerNode<std::uint32_t> counts = random_counts(lattice, seed, 200);
        const PerNode<SquaredRadius> distances = squared_distances(lattice, counts, kLargestRadius);
        for_each_node(lattice, [&](int x, int y, int z) {
            int best = kLargestRadius * kLargestRadius + 1;
            for_each_node(lattice, [&](int a, int b, int c) {
                if (counts[lattice.index(a, b, c)] != 0)
                    best = std::min(best, (a - x) * (a - x) + (b - y) * (b - y) + (c - z) * (c - z));
            });
            ASSERT_EQ(distances[lattice.index(x, y, z)], best) << x << ' ' << y << ' ' << z;
        });
    }
}

/// The definition as a fixed point: starts from 0 and raises clearances until none can be raised.
PerNode<SquaredRadius> relaxed_clearances(const Lattice& lattice, const PerNode<SquaredRadius>& distances) {
    const Neighbours neighbours(lattice);
    PerNode<SquaredRadius> result(lattice.size(), 0);
    for (bool changed = true; changed;) {
        changed = false;
        for_each_node(lattice, [&](int x, int y, int z) {
            const bool wall = x == 0 || y == 0 || z == 0 || x == lattice.nx - 1 || y == lattice.ny - 1 ||
                              z == lattice.nz - 1;
            const NodeId i = lattice.index(x, y, z);
            SquaredRadius best = wall ? distances[i] : SquaredRadius{0};
            neighbours.for_each_at(i, neighbours.places(i), [&](NodeId j, int) {
                best = std::max(best, std::min(result[j], distances[i]));
            });
            changed = changed || best > result[i];
            result[i] = std::max(result[i], best);
        });
    }
    return result;
}

TEST(Clearance, IsTheFixedPointOfRelaxation) {
    for (const std::uint64_t seed : {1U, 2U, 3U})
        for (const std::uint32_t one_in : {3U, 12U, 200U}) {
            const Lattice lattice = small_lattice();
            const PerNode<SquaredRadius> distances =
                squared_distances(lattice, random_counts(lattice, seed, one_in), kLargestRadius);
            const PerNode<SquaredRadius> relaxed = relaxed_clearances(lattice, distances);
            EXPECT_EQ(clearances(lattice, distances, kLargestRadius, {}), relaxed) << one_in;
        }
}

/// The surface of a cube of 17 x 17 x 17 nodes with a hole of 3 x 3 nodes in its lid.
TEST(Clearance, SpaceBehindANarrowOpeningIsSealed) {
    const Lattice lattice(vcg::Box3f(vcg::Point3f(0, 0, 0), vcg::Point3f(16, 16, 16)), 1.0F, 2);
    PerNode<std::uint32_t> counts(lattice.size(), 0);
    for_each_node(lattice, [&](int x, int y, int z) {
        const int low = std::min({x, y, z}), high = std::max({x, y, z});
        const bool hole = z == 18 && std::abs(x - 10) <= 1 && std::abs(y - 10) <= 1;
        if (low >= 2 && high <= 18 && (low == 2 || high == 18) && !hole) counts[lattice.index(x, y, z)] = 1;
    });
    constexpr int kMax = 12;
    const PerNode<SquaredRadius> distances = squared_distances(lattice, counts, kMax);
    const PerNode<SquaredRadius> open = clearances(lattice, distances, kMax, {});
    const NodeId middle = lattice.index(10, 10, 10);
    EXPECT_GT(open[middle], 1);  // a ball of radius 1 reaches the middle
    const SealedSpaces sealed = enclosed_spaces(lattice, distances, open, 1.7, 0);
    EXPECT_EQ(sealed.inside[middle], 1);
    EXPECT_EQ(sealed.widest_opening, open[middle]);
    EXPECT_EQ(sealed.nodes, std::count(sealed.inside.begin(), sealed.inside.end(), 1));
    const PerNode<SquaredRadius> closed = clearances(lattice, distances, kMax, sealed.inside);
    EXPECT_EQ(closed[middle], 0);
    EXPECT_GT(closed[lattice.index(0, 0, 0)], 0);
    EXPECT_EQ(euler_characteristic(lattice, solid_of(lattice, closed, counts, 1, 1).nodes), 1);
    // The middle is 8 steps from the points: no space is that much wider than its opening, or that deep.
    EXPECT_EQ(enclosed_spaces(lattice, distances, open, 8, 0).nodes, 0);
    EXPECT_EQ(enclosed_spaces(lattice, distances, open, 1.7, 8 * 8 + 1).nodes, 0);
}

TEST(Clearance, SmallComponentsAreSpecks) {
    const Lattice lattice = small_lattice();
    PerNode<std::uint32_t> counts(lattice.size(), 0);
    counts[lattice.index(2, 2, 2)] = 10;
    counts[lattice.index(8, 8, 8)] = 3;
    const PerNode<SquaredRadius> distances = squared_distances(lattice, counts, kLargestRadius);
    const PerNode<SquaredRadius> clearance = clearances(lattice, distances, kLargestRadius, {});
    const Solid small = solid_of(lattice, clearance, counts, 1, 5);
    EXPECT_EQ(small.components, 1);
    EXPECT_EQ(small.points_in_specks, 3);
    EXPECT_EQ(small.nodes[lattice.index(2, 2, 3)], 1);
    EXPECT_EQ(small.nodes[lattice.index(8, 8, 8)], 0);
    EXPECT_EQ(solid_of(lattice, clearance, counts, 1, 10).components, 1) << "of as many points as it takes";
    // They are 6 * sqrt(3) apart: balls of radius 5 have adjacent nodes.
    const Solid large = solid_of(lattice, clearance, counts, kLargestRadius * kLargestRadius, 5);
    EXPECT_EQ(large.components, 1);
    EXPECT_EQ(large.points_in_specks, 0);
}

std::vector<Point3f> sphere(int count) { return shapes::in_float(shapes::sphere_cloud(count)); }

/// A square with sides of length 2.
std::vector<Point3f> square(int count) {
    std::vector<Point3f> points = shapes::in_float(shapes::plane_cloud(count));
    for (Point3f& p : points) p *= 2;
    return points;
}

Region region_of(const std::vector<Point3f>& points, float step) {
    return examine(points, vcg::Box3f(Point3f(-1, -1, -1), Point3f(1, 1, 1)), step);
}

TEST(Region, KnowsTheShareOfTheSurfaceThatEnclosesNothing) {
    const auto share = [](const std::vector<Point3f>& points) {
        return thin_parts(examine(points, vcg::Box3f(Point3f(-1, -1, -1), Point3f(5, 1, 1)), 0.05F), {})
            .share;
    };
    std::vector<Point3f> points = sphere(20000);
    EXPECT_LT(share(points), 0.001);
    EXPECT_EQ(share(square(10000)), 1);
    // The sphere has an area of 12.6, the square beside it one of 4.
    for (const Point3f& p : square(6000)) points.push_back(p + Point3f(3, 0, 0));
    EXPECT_NEAR(share(points), 4 / 16.6, 0.05);
}

TEST(Region, WideOpeningsAreSealedAndMeasured) {
    std::vector<Point3f> points;
    for (const Point3f& p : sphere(40000))
        if (p[2] < 0.8F) points.push_back(p);
    const Region region = region_of(points, 0.02F);
    EXPECT_TRUE(region.encloses_space);
    EXPECT_EQ(region.clearance[region.lattice.node_of({0, 0, 0})], 0);
    EXPECT_NEAR(region.widest_opening, 0.6, 0.05);  // the hole's radius; its rim is at z = 0.8
}

TEST(Region, TheFringeOfANoisyCloudIsLeftOut) {
    std::vector<Point3f> points = sphere(100000);
    const Region clean = region_of(points, 0.05F);
    EXPECT_EQ(clean.counts, count_points(clean.lattice, points));
    points.emplace_back(0.0F, 0.0F, 1.1F);  // two nodes from the surface
    const Region fringed = region_of(points, 0.05F);
    EXPECT_EQ(fringed.counts, clean.counts);
    EXPECT_NE(fringed.counts, count_points(fringed.lattice, points));
}

std::vector<Point3f> sphere(int count, float radius, const Point3f& centre, std::uint64_t seed) {
    std::vector<Point3f> points;
    for (const vcg::Point3d& p : shapes::sphere_cloud(count, 0, seed))
        points.push_back(centre + Point3f::Construct(p) * radius);
    return points;
}

/// A sphere of radius 0.5 with 20,000 points, which is in one piece at level 4, and \p others.
struct Examined {
    explicit Examined(const std::vector<Point3f>& others)
        : points(sphere(20000, 0.5F, {0, 0, 0}, 1)),
          surface_points(points.size()),
          region(with(others, points)),
          solid(solid_of(region.lattice, region.clearance, region.counts, kLevel, region.min_points).nodes) {}

    /// The outliers among the others; empty if outliers_of() is.
    std::vector<int> outliers() const {
        const std::vector<std::uint8_t> all = outliers_of(points, region, solid);
        if (all.empty()) return {};
        EXPECT_EQ(all.size(), points.size());
        const auto others = all.begin() + static_cast<std::ptrdiff_t>(surface_points);
        EXPECT_EQ(std::count(all.begin(), others, 0), static_cast<std::ptrdiff_t>(surface_points));
        return {others, all.end()};
    }

    static constexpr int kLevel = 4;
    std::vector<Point3f> points;
    std::size_t surface_points;
    Region region;
    NodeSet solid;

private:
    static Region with(const std::vector<Point3f>& others, std::vector<Point3f>& points) {
        points.insert(points.end(), others.begin(), others.end());
        const vcg::Box3f box(Point3f(-1, -1, -1), Point3f(1, 1, 1));
        return examine(points, box, 0.04F);
    }
};

TEST(Outliers, ArePointsFarFromTheSurface) {
    EXPECT_TRUE(Examined({}).outliers().empty());
    using Points = std::vector<Point3f>;
    for (const Points& far : {Points{{0.8F, 0, 0}, {0, 0, -0.9F}},  // outside
                              Points{{3, 0, 0}, {0, -1e20F, 0}}})   // outside the lattice
        EXPECT_EQ(Examined(far).outliers(), (std::vector<int>{1, 1})) << far[0][0];
    EXPECT_TRUE(Examined({{0.52F, 0, 0}, {0, 0.48F, 0}}).outliers().empty());
    // Each is judged on its own: of these the second one is an outlier.
    EXPECT_EQ(Examined({{0.52F, 0, 0}, {0.8F, 0, 0}}).outliers(), (std::vector<int>{0, 1}));
}

TEST(Outliers, AreGroupsSmallerThanAComponent) {
    // 1 % of 20,000 points are 200.
    EXPECT_EQ(Examined(sphere(100, 0.05F, {0.8F, 0, 0}, 2)).outliers(), std::vector<int>(100, 1));
    EXPECT_TRUE(Examined(sphere(400, 0.05F, {0.8F, 0, 0}, 2)).outliers().empty());
}

// The vote on lists written by hand. Level l stands for the radius sqrt(l), level 0 for half a step, and the
// last level of a list for one step more.

TEST(TopologyVote, NothingToVoteOn) { EXPECT_FALSE(persistent_topology({}).found); }

TEST(TopologyVote, ThePersistentTopologyWins) {
    const TopologyVote vote =
        persistent_topology({{1, 1, 3}, {2, 1, 1}, {4, 1, 1}, {8, 1, 1}, {9, 1, 1}, {16, 1, 1}});
    EXPECT_EQ(vote.genus, 1);
    const double genus3 = 1 - 1 / std::sqrt(2.0), genus1 = 1 / std::sqrt(2.0) - 1 / 5.0;
    EXPECT_DOUBLE_EQ(vote.confidence, genus1 / (genus1 + genus3));
    EXPECT_EQ(vote.level, 2);
}

TEST(TopologyVote, SmallerRadiiCountMore) {
    // Genus 2 at radii from 1 to 2, genus 0 from 2 to 6, which is longer.
    const TopologyVote vote = persistent_topology({{1, 1, 2}, {3, 1, 2}, {4, 1, 0}, {25, 1, 0}});
    EXPECT_EQ(vote.genus, 2);
    EXPECT_DOUBLE_EQ(vote.confidence, 0.5 / (0.5 + 1 / 2.0 - 1 / 6.0));
}

TEST(TopologyVote, OccupiedNodesCountAsHalfAStep) {
    const TopologyVote vote = persistent_topology({{0, 1, 5}, {1, 1, 0}, {100, 1, 0}});
    EXPECT_EQ(vote.genus, 5);
    EXPECT_DOUBLE_EQ(vote.confidence, 1 / (1 + 1 - 1 / 11.0));
    EXPECT_EQ(vote.level, 0);
}

TEST(TopologyVote, IsUncertainIfPointsLieInClumps) {
    EXPECT_EQ(persistent_topology({{4, 1, 1}, {16, 1, 1}}).confidence, 1);
    EXPECT_LT(persistent_topology({{9, 1, 1}, {16, 1, 1}}).confidence, 0.5);
}

}  // namespace neuralmesh::region_test
