// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/isolated_groups.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/median.h"

namespace neuralmesh {
namespace {

using Place = NearestPoints::Place;

constexpr std::size_t kPointsPerCell = 4;   ///< finer levels part the points of a surface
constexpr float kConnected = 0.5F;          ///< distance of the points of two cells over the side of cells
constexpr std::size_t kSmallest = 6;        ///< points of a group; fewer are suspects by their spacing
constexpr double kMostInClumps = 0.05;      ///< of all points; above, the cloud as a whole consists of clumps
/// Noise as wide as the spacing fills the space between so few neighbours, also on a sheet. Larger groups
/// have to fill the space between more of them, too.
constexpr int kManyNeighbours = 40;
constexpr std::size_t kLargeGroup = 320;
constexpr double kFillsSpace = 0.08;  ///< surface variation: surfaces have .00 to .05, balls .11 to .17
constexpr double kThinPlane = 0.05;   ///< of the variances across a plane and along it
constexpr float kGap = 2.2F;  ///< distance to the rest in the group's own spacings, to the tenth neighbour

/// Consecutive places in one octree cell.
struct Cell {
    std::uint64_t code;
    Place begin, end;
    vcg::Box3f box;  ///< of its points
};

/// The cells at \p level that hold points not in \p out, by ascending code.
std::vector<Cell> occupied_cells(const NearestPoints& cloud, const std::vector<std::uint8_t>& out,
                                 int level) {
    std::vector<Cell> cells;
    for (Place p = 0; p < cloud.size(); ++p) {
        if (out[p] != 0) continue;
        const std::uint64_t code = cloud.cell(p, level);
        if (cells.empty() || cells.back().code != code) cells.push_back({code, p, p, {}});
        cells.back().end = p + 1;
        cells.back().box.Add(cloud.point(p));
    }
    return cells;
}

/// The code of the cell one step along \p axis, by arithmetic on the bits of that axis alone. Beyond the
/// border of the cube it is the cell at the opposite border.
std::uint64_t stepped(std::uint64_t code, int axis, int step, int level) {
    const std::uint64_t mask =
        (std::uint64_t{0x1249249249249249} << axis) & ((std::uint64_t{1} << 3 * level) - 1);
    const std::uint64_t one = std::uint64_t{1} << axis;
    if (step == 0) return code;
    const std::uint64_t moved = step > 0 ? (code | ~mask) + one : (code & mask) - one;
    return (moved & mask) | (code & ~mask);
}

float squared_gap(const vcg::Box3f& a, const vcg::Box3f& b) {
    float sum = 0;
    for (int k = 0; k < 3; ++k) {
        const float d = std::max({a.min[k] - b.max[k], b.min[k] - a.max[k], 0.0F});
        sum += d * d;
    }
    return sum;
}

/// Joins every cell with those of its 26 neighbours whose points are closer than kConnected cell sides, as
/// their boxes tell: whether a gap shows depends little on where cells end.
DisjointSets connected(const std::vector<Cell>& cells, int level, float side) {
    const float limit = kConnected * side * kConnected * side;
    DisjointSets sets(static_cast<int>(cells.size()));
    const auto by_code = [](const Cell& cell, std::uint64_t code) { return cell.code < code; };
    for (std::size_t c = 0; c < cells.size(); ++c)
        for (int k = 0; k < 13; ++k) {  // the others see this one
            std::uint64_t code = stepped(cells[c].code, 0, k % 3 - 1, level);
            code = stepped(stepped(code, 1, k / 3 % 3 - 1, level), 2, k / 9 - 1, level);
            const auto at = std::lower_bound(cells.begin(), cells.end(), code, by_code);
            if (at != cells.end() && at->code == code && squared_gap(at->box, cells[c].box) <= limit)
                sets.join(static_cast<int>(c), static_cast<int>(at - cells.begin()));
        }
    return sets;
}

/// The points of every component that is small but not tiny, by ascending places.
std::vector<std::vector<Place>> small_groups(const std::vector<Cell>& cells, int level, float side,
                                             std::size_t largest, const std::vector<std::uint8_t>& out) {
    DisjointSets sets = connected(cells, level, side);
    std::vector<std::vector<Place>> groups(cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c) {
        std::vector<Place>& group = groups[static_cast<std::size_t>(sets.find(static_cast<int>(c)))];
        for (Place p = cells[c].begin; p < cells[c].end && group.size() <= largest; ++p)
            if (out[p] == 0) group.push_back(p);
    }
    groups.erase(std::remove_if(groups.begin(), groups.end(),
                                [&](const auto& g) { return g.size() < kSmallest || g.size() > largest; }),
                 groups.end());
    return groups;
}

/// Mean surface variation of the points of \p group with their nearest \p neighbours.
double mean_variation(const NearestPoints& group, int neighbours) {
    std::vector<NearestPoints::Neighbour> near;
    std::vector<Place> places;
    double sum = 0;
    for (Place p = 0; p < group.size(); ++p) {
        group.nearest(p, neighbours, near);
        places.assign(1, p);
        for (const NearestPoints::Neighbour& n : near) places.push_back(n.place);
        sum += Extent(group, places).variation();
    }
    return sum / static_cast<double>(group.size());
}

/// Is \p group a clump? Its spacing is the median distance to the tenth neighbour within it.
bool is_clump(const NearestPoints& cloud, const std::vector<Place>& group,
              const std::vector<std::uint8_t>& out) {
    if (Extent(cloud, group).variation() < kFillsSpace) return false;
    std::vector<vcg::Point3f> points;
    for (const Place p : group) points.push_back(cloud.point(p));
    const NearestPoints inner(points);
    if (mean_variation(inner, CloudSurvey::kNeighbour) < kFillsSpace) return false;
    if (group.size() >= kLargeGroup && mean_variation(inner, kManyNeighbours) < kFillsSpace) return false;
    std::vector<NearestPoints::Neighbour> near;
    std::vector<float> spacings;
    for (Place p = 0; p < inner.size(); ++p) {
        inner.nearest(p, CloudSurvey::kNeighbour, near);
        spacings.push_back(std::sqrt(near.back().squared_distance));
    }
    const float gap = kGap * median(std::move(spacings));
    const auto other = [&](Place p) {
        return out[p] == 0 && !std::binary_search(group.begin(), group.end(), p);
    };
    return std::none_of(group.begin(), group.end(),
                        [&](Place p) { return cloud.any_within(cloud.point(p), gap, other); });
}

}  // namespace

Extent::Extent(const NearestPoints& cloud, const std::vector<Place>& points)
    : count_(static_cast<double>(points.size())) {
    for (const Place p : points) mean_ += in_double(cloud.point(p));
    mean_ /= count_;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const Place p : points) {
        const Eigen::Vector3d d = in_double(cloud.point(p)) - mean_;
        covariance += d * d.transpose();
    }
    trace_ = covariance.trace();
    spread_ = principal_axes(covariance);
}

double Extent::variation() const { return trace_ > 0 ? std::max(spread_.values[0], 0.0) / trace_ : 0; }
bool Extent::is_plane() const { return spread_.values[0] < kThinPlane * spread_.values[1]; }
double Extent::thickness() const { return std::sqrt(std::max(spread_.values[0], 0.0) / count_); }
double Extent::distance(const vcg::Point3f& p) const { return (in_double(p) - mean_).norm(); }
double Extent::height(const vcg::Point3f& p) const {
    return std::abs((in_double(p) - mean_).dot(spread_.axes.col(0)));
}

void mark_isolated_clumps(const NearestPoints& cloud, std::vector<std::uint8_t>& out) {
    if (skips("clumps")) return;
    const auto points = static_cast<double>(cloud.size());
    const auto largest = static_cast<std::size_t>(kComponentShare * points);
    std::vector<std::uint8_t> marked = out;
    std::size_t in_clumps = 0;
    for (int level = 1; level <= cloud.finest_level(); ++level) {
        const std::vector<Cell> cells = occupied_cells(cloud, marked, level);
        if (kPointsPerCell * cells.size() > cloud.size()) break;
        for (const std::vector<Place>& group :
             small_groups(cells, level, cloud.cell_side(level), largest, marked)) {
            if (!is_clump(cloud, group, marked)) continue;
            for (const Place p : group) marked[p] = 1;
            in_clumps += group.size();
        }
    }
    if (static_cast<double>(in_clumps) <= kMostInClumps * points) out = std::move(marked);
}

}  // namespace neuralmesh
