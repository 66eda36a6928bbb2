// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Counting, sealing, counting again.
#include "vcg_core/shell/region.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace neuralmesh {
namespace {

constexpr double kWidthRatio = 1.7;      // a space this much wider than the way in is sealed
constexpr double kWeakWidthRatio = 1.2;  // the same for a cloud that encloses nothing else
constexpr int kWeakDepth = 4 * 4;        // ... and the least squared depth of such a space, in coarse steps
constexpr double kCoarseSteps = 40;      // per side
constexpr int kCoarseReach = 18;
constexpr double kLoose = 0.05;            // of the points
constexpr double kFringe = 0.2;            // of the density next to it
constexpr std::uint32_t kManyPoints = 40;  // enough for that ratio to mean something

/// Applies f to every row along x, then y, then z: index of its first node, stride, length.
template <class F>
void for_each_row(const Lattice& l, const F& f) {
    for (int z = 0; z < l.nz; ++z)
        for (int y = 0; y < l.ny; ++y) f(l.index(0, y, z), std::size_t{1}, l.nx);
    for (int z = 0; z < l.nz; ++z)
        for (int x = 0; x < l.nx; ++x) f(l.index(x, 0, z), l.index(0, 1, 0), l.ny);
    for (int y = 0; y < l.ny; ++y)
        for (int x = 0; x < l.nx; ++x) f(l.index(x, y, 0), l.index(0, 0, 1), l.nz);
}

/// The counts without the fringe of a noisy cloud: nodes whose surroundings (3 x 3 x 3 nodes) hold less than
/// kFringe of what some surroundings up to two nodes away hold, where that is many enough to be no accident.
std::vector<std::uint32_t> without_fringe(const Lattice& lattice, const std::vector<std::uint32_t>& counts) {
    std::vector<std::uint32_t> sums = counts, row;
    for_each_row(lattice, [&](std::size_t first, std::size_t stride, int length) {
        std::uint32_t before = 0, here = sums[first];
        for (int i = 0; i < length; ++i) {
            std::uint32_t& at = sums[first + static_cast<std::size_t>(i) * stride];
            const std::uint32_t after =
                i + 1 < length ? sums[first + static_cast<std::size_t>(i + 1) * stride] : 0;
            at = before + here + after;
            before = here;
            here = after;
        }
    });
    std::vector<std::uint32_t> most = sums;
    for_each_row(lattice, [&](std::size_t first, std::size_t stride, int length) {
        const std::size_t n = static_cast<std::size_t>(length);
        row.assign(n + 4, 0U);
        for (std::size_t i = 0; i < n; ++i) row[i + 2] = most[first + i * stride];
        for (std::size_t i = 0; i < n; ++i)
            most[first + i * stride] = *std::max_element(row.data() + i, row.data() + i + 5);
    });
    std::vector<std::uint32_t> kept = counts;
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (most[i] >= kManyPoints && sums[i] < kFringe * most[i]) kept[i] = 0;
    return kept;
}

/// Marks in \p inside the nodes whose nearest node of \p coarse is marked in \p coarse_inside.
void refine(const Lattice& coarse, const std::vector<std::uint8_t>& coarse_inside, const Lattice& lattice,
            std::vector<std::uint8_t>& inside) {
    for (int z = 0; z < lattice.nz; ++z)
        for (int y = 0; y < lattice.ny; ++y)
            for (int x = 0; x < lattice.nx; ++x) {
                const std::size_t j = coarse.node_of(lattice.position(x, y, z));
                if (j < coarse.size() && coarse_inside[j] != 0) inside[lattice.index(x, y, z)] = 1;
            }
}

/// Seals the spaces with openings too wide for the region's own reach, if any.
void seal_wide_openings(const std::vector<vcg::Point3f>& points, const vcg::Box3f& box, Region& region,
                        std::vector<std::uint8_t>& inside) {
    const float step = longest_side(box) / static_cast<float>(kCoarseSteps);
    if (!(step > region.lattice.step)) return;
    const Lattice coarse(box, step, Region::kMargin);
    const std::vector<SquaredRadius> distances =
        squared_distances(coarse, count_points(coarse, points), kCoarseReach);
    const std::vector<SquaredRadius> clearance = clearances(coarse, distances, kCoarseReach, {});
    SealedSpaces sealing = enclosed_spaces(coarse, distances, clearance, kWidthRatio, kWeakDepth);
    if (sealing.nodes == 0 && !region.encloses_space)
        sealing = enclosed_spaces(coarse, distances, clearance, kWeakWidthRatio, kWeakDepth);
    if (sealing.nodes == 0) return;
    refine(coarse, sealing.inside, region.lattice, inside);
    region.encloses_space = true;
    region.widest_opening =
        std::max(region.widest_opening,
                 static_cast<double>(step) * std::sqrt(static_cast<double>(sealing.widest_opening)));
}

}  // namespace

float longest_side(const vcg::Box3f& box) { return std::max({box.DimX(), box.DimY(), box.DimZ()}); }

bool is_fragmented(const Region& region, int level) {
    constexpr int kTogether = 4 * 4;
    const auto at = [&](int l) { return region.topologies[static_cast<std::size_t>(l)]; };
    const LevelTopology here = at(level);
    const double coming =
        static_cast<double>(here.speck_points - at(std::max(level, kTogether)).speck_points);
    return here.components == 0 || coming > kLoose * static_cast<double>(region.total_points);
}

std::vector<std::uint32_t> count_points(const Lattice& lattice, const std::vector<vcg::Point3f>& points) {
    std::vector<std::uint32_t> counts(lattice.size(), 0);
    for (const vcg::Point3f& p : points) {
        const std::size_t i = lattice.node_of(p);
        if (i < counts.size()) ++counts[i];
    }
    return counts;
}

double points_per_occupied_node(const std::vector<std::uint32_t>& counts) {
    std::uint64_t occupied = 0, points = 0;
    for (const std::uint32_t c : counts) {
        occupied += c != 0;
        points += c;
    }
    return occupied == 0 ? 0 : static_cast<double>(points) / static_cast<double>(occupied);
}

Region examine(const std::vector<vcg::Point3f>& points, const vcg::Box3f& box, float step, double share,
               long long least) {
    Region region(Lattice(box, step, Region::kMargin));
    const std::vector<std::uint32_t> counts = count_points(region.lattice, points);
    region.counts = without_fringe(region.lattice, counts);
    for (std::size_t i = 0; i < counts.size(); ++i) region.fringe_points += counts[i] - region.counts[i];
    region.distances = squared_distances(region.lattice, region.counts, Region::kReach);
    region.clearance = clearances(region.lattice, region.distances, Region::kReach, {});
    SealedSpaces sealing =
        enclosed_spaces(region.lattice, region.distances, region.clearance, kWidthRatio, 0);
    region.encloses_space = sealing.nodes > 0;
    region.widest_opening =
        static_cast<double>(step) * std::sqrt(static_cast<double>(sealing.widest_opening));
    seal_wide_openings(points, box, region, sealing.inside);
    if (region.encloses_space)
        region.clearance = clearances(region.lattice, region.distances, Region::kReach, sealing.inside);

    const long long total = static_cast<long long>(points.size());
    const long long wanted = std::max(least, static_cast<long long>(share * static_cast<double>(total)));
    region.total_points = total;
    region.enough = std::min(wanted, 1 + total / 4);  // a handful of points is a cloud, too
    region.topologies =
        topology_of_levels(region.lattice, region.clearance, region.counts, Region::kReach, region.enough);
    return region;
}

}  // namespace neuralmesh
