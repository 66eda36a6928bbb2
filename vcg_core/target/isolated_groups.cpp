// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Groups are connected components of occupied octree cells, level by level from coarse to fine. Neighbouring
// cells are connected if two of their points are close: whether a gap shows does not depend on where cells
// end.
#include "vcg_core/target/isolated_groups.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace neuralmesh {
namespace {

using Place = NearestPoints::Place;

constexpr int kCoarsestLevel = 4;
constexpr float kApart = 0.75F;             ///< in cells: points of connected cells are closer
constexpr std::size_t kMostPairs = 10000;   ///< of points that are compared; of more a finer level tells
constexpr std::size_t kPointsPerCell = 4;   ///< finer levels part the points of a surface
constexpr std::size_t kCheapCells = 20000;  ///< of a level that takes a few milliseconds
constexpr std::size_t kSmallest = 6;        ///< points of a group; fewer are suspects by their spacing
constexpr double kLargestShare = 0.01;      ///< of all points
constexpr double kSmallShare = 0.002;       ///< of all points; larger groups need a wider gap
constexpr double kMostInClumps = 0.05;      ///< of all points; above, the cloud as a whole consists of clumps
constexpr int kNeighbours = 10;
constexpr double kFillsSpace = 0.08;  ///< mean surface variation; surfaces have .00 to .05, balls .11 to .17
constexpr double kThick = 0.1;        ///< surface variation of a group as a whole
constexpr double kGap = 2.2, kWideGap = 6;  ///< distance to the rest in the group's own spacings

Eigen::Vector3d position(const NearestPoints& cloud, Place p) {
    const vcg::Point3f& q = cloud.point(p);
    return {static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2])};
}

/// Mean and covariance (times the number) of some points.
struct Extent {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

    Extent(const NearestPoints& cloud, const std::vector<Place>& points) {
        for (const Place p : points) mean += position(cloud, p);
        mean /= static_cast<double>(points.size());
        for (const Place p : points) {
            const Eigen::Vector3d d = position(cloud, p) - mean;
            covariance += d * d.transpose();
        }
    }
};

/// Of consecutive places in one octree cell.
struct Cell {
    std::uint64_t code;
    Place begin, end;
};

/// The code of the cell one step along \p axis (0: the lowest bit of each triple), by arithmetic on the bits
/// of that axis alone. At the border of the cube it is the cell at the opposite border.
std::uint64_t stepped(std::uint64_t code, int axis, int step, int level) {
    const std::uint64_t mask =
        (std::uint64_t{0x1249249249249249} << axis) & ((std::uint64_t{1} << 3 * level) - 1);
    const std::uint64_t one = std::uint64_t{1} << axis;
    if (step == 0) return code;
    const std::uint64_t moved = step > 0 ? (code | ~mask) + one : (code & mask) - one;
    return (moved & mask) | (code & ~mask);
}

std::vector<Cell> occupied_cells(const NearestPoints& cloud, const std::vector<std::uint8_t>& out,
                                 int level) {
    std::vector<Cell> cells;
    for (Place p = 0; p < cloud.size(); ++p) {
        if (out[p] != 0) continue;
        const std::uint64_t code = cloud.cell(p, level);
        if (cells.empty() || cells.back().code != code) cells.push_back({code, p, p});
        cells.back().end = p + 1;
    }
    return cells;
}

/// Are all points of two cells, those in \p out left aside, farther apart than kApart cells?
bool are_apart(const NearestPoints& cloud, const Cell& a, const Cell& b, int level,
               const std::vector<std::uint8_t>& out) {
    if (std::size_t{a.end - a.begin} * (b.end - b.begin) > kMostPairs) return false;
    const float limit = kApart * cloud.cell_side(level);
    for (Place p = a.begin; p < a.end; ++p)
        for (Place q = b.begin; q < b.end && out[p] == 0; ++q)
            if (out[q] == 0 && (cloud.point(p) - cloud.point(q)).SquaredNorm() <= limit * limit) return false;
    return true;
}

/// The first cell of the component of each, by union-find with path halving.
std::vector<std::size_t> components(const NearestPoints& cloud, const std::vector<Cell>& cells, int level,
                                    const std::vector<std::uint8_t>& out) {
    std::vector<std::size_t> parent(cells.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&parent](std::size_t c) {
        while (parent[c] != c) c = parent[c] = parent[parent[c]];
        return c;
    };
    constexpr std::size_t kFilterBits = std::size_t{1} << 21;
    std::vector<bool> filter(kFilterBits);  // of codes that may be occupied: most neighbours are not
    for (const Cell& cell : cells) filter[cell.code % kFilterBits] = true;
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (int around = 0; around < 13; ++around) {  // the other half of the 26 look at this one
            const int dx = around % 3 - 1, dy = around / 3 % 3 - 1, dz = around / 9 - 1;
            const std::uint64_t code =
                stepped(stepped(stepped(cells[c].code, 0, dx, level), 1, dy, level), 2, dz, level);
            const auto at =
                std::lower_bound(cells.begin(), cells.end(), code,
                                 [](const Cell& cell, std::uint64_t key) { return cell.code < key; });
            if (at == cells.end() || at->code != code) continue;
            const std::size_t a = root(c), b = root(static_cast<std::size_t>(at - cells.begin()));
            if (a == b || are_apart(cloud, cells[c], *at, level, out)) continue;
            parent[std::max(a, b)] = std::min(a, b);
        }
    for (std::size_t c = 0; c < cells.size(); ++c) parent[c] = root(c);
    return parent;
}

/// The points of every component that is small but not tiny, by ascending places.
std::vector<std::vector<Place>> small_groups(const NearestPoints& cloud, const std::vector<Cell>& cells,
                                             int level, std::size_t largest,
                                             const std::vector<std::uint8_t>& out) {
    const std::vector<std::size_t> component = components(cloud, cells, level, out);
    std::vector<std::size_t> size(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) size[component[c]] += cells[c].end - cells[c].begin;
    std::vector<std::vector<Place>> groups(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (size[component[c]] > largest + cells.size()) continue;
        for (Place p = cells[c].begin; p < cells[c].end; ++p)
            if (out[p] == 0 && groups[component[c]].size() <= largest) groups[component[c]].push_back(p);
    }
    groups.erase(std::remove_if(groups.begin(), groups.end(),
                                [&](const auto& g) { return g.size() < kSmallest || g.size() > largest; }),
                 groups.end());
    return groups;
}

/// Is \p group a clump? Its spacing is the median distance to the tenth neighbour within it.
bool is_clump(const NearestPoints& cloud, const std::vector<Place>& group,
              const std::vector<std::uint8_t>& out) {
    if (surface_variation(cloud, group) < kThick) return false;
    std::vector<vcg::Point3f> points;
    for (const Place p : group) points.push_back(cloud.point(p));
    const NearestPoints inner(points);
    std::vector<NearestPoints::Neighbour> near;
    std::vector<Place> places;
    std::vector<float> spacings;
    double variation = 0;
    for (Place p = 0; p < inner.size(); ++p) {
        inner.nearest(p, kNeighbours, near);
        places.assign(1, p);
        for (const NearestPoints::Neighbour& n : near) places.push_back(n.place);
        variation += surface_variation(inner, places) / static_cast<double>(inner.size());
        spacings.push_back(std::sqrt(near.back().squared_distance));
    }
    if (variation < kFillsSpace) return false;
    std::nth_element(spacings.begin(), spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2),
                     spacings.end());
    const bool small = static_cast<double>(group.size()) <= kSmallShare * static_cast<double>(cloud.size());
    const auto gap = static_cast<float>(small ? kGap : kWideGap) * spacings[spacings.size() / 2];
    const auto other = [&](Place p) {
        return out[p] == 0 && !std::binary_search(group.begin(), group.end(), p);
    };
    return std::none_of(group.begin(), group.end(), [&](Place p) { return cloud.any_within(p, gap, other); });
}

}  // namespace

double surface_variation(const NearestPoints& cloud, const std::vector<Place>& points) {
    const Extent extent(cloud, points);
    const double all = extent.covariance.trace();
    if (!(all > 0)) return 0;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(extent.covariance, Eigen::EigenvaluesOnly);
    return std::max(solver.eigenvalues()[0], 0.0) / all;
}

bool continues_plane(const NearestPoints& cloud, Place place, const std::vector<Place>& others) {
    constexpr double kThin = 0.05;     // of the variances across and along the plane
    constexpr double kInPlane = 0.35;  // sine of the angle between plane and offset
    const Extent extent(cloud, others);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(extent.covariance);
    const Eigen::Vector3d offset = position(cloud, place) - extent.mean;
    return solver.eigenvalues()[0] < kThin * solver.eigenvalues()[1] &&
           std::abs(offset.dot(solver.eigenvectors().col(0))) < kInPlane * offset.norm();
}

double relative_plane_distance(const NearestPoints& cloud, Place place, const std::vector<Place>& others,
                               double at_least) {
    constexpr double kThin = 0.1;  // of the variances across and along the plane
    const Extent extent(cloud, others);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(extent.covariance);
    if (!(solver.eigenvalues()[0] < kThin * solver.eigenvalues()[1])) return 0;
    const double own = std::sqrt(std::max(solver.eigenvalues()[0], 0.0) / static_cast<double>(others.size()));
    const Eigen::Vector3d offset = position(cloud, place) - extent.mean;
    return std::abs(offset.dot(solver.eigenvectors().col(0))) / std::sqrt(own * own + at_least * at_least);
}

void mark_isolated_clumps(const NearestPoints& cloud, std::vector<std::uint8_t>& out) {
    const auto points = static_cast<double>(cloud.size());
    const auto largest = static_cast<std::size_t>(kLargestShare * points);
    const std::size_t n = cloud.size();
    const std::size_t most_cells = std::max(n / kPointsPerCell, std::min(n / 2, kCheapCells));
    std::vector<std::uint8_t> marked = out;
    std::size_t in_clumps = 0;
    for (int level = kCoarsestLevel; level <= cloud.finest_level(); ++level) {
        const std::vector<Cell> cells = occupied_cells(cloud, marked, level);
        if (cells.size() > most_cells && level > kCoarsestLevel) break;
        for (const std::vector<Place>& group : small_groups(cloud, cells, level, largest, marked)) {
            if (!is_clump(cloud, group, marked)) continue;
            for (const Place p : group) marked[p] = 1;
            in_clumps += group.size();
        }
    }
    if (static_cast<double>(in_clumps) <= kMostInClumps * points) out = std::move(marked);
}

}  // namespace neuralmesh
