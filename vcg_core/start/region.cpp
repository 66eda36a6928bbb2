// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/region.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/ablation.h"
#include "vcg_core/start/hollows.h"

namespace neuralmesh {
namespace {

// tests/experiments/accuracy/ablation.py shows what a change of these figures does.

// A space is sealed if it is this much wider than its opening ...
constexpr double kWidthRatio = 1.7;
// ... or, in a cloud that encloses nothing else, this much and at least this many coarse steps deep.
constexpr double kSingleLayerWidthRatio = 1.2;
constexpr int kSingleLayerSquaredDepth = 4 * 4;
// The lattice for wide openings: steps along the longest side, and the largest radius in steps.
constexpr double kCoarseSteps = 40;
constexpr int kCoarseMaxRadius = 18;

/// A component holds at least this share of the points, and so many of them.
constexpr double kComponentShare = 0.01;
constexpr long long kSpeckPoints = 20;

// A node is fringe if its density is below this share of the highest density close by ...
constexpr double kFringeShare = 0.2;
// ... where that is at least this many points in 3 x 3 x 3 nodes: fewer may differ so much by chance.
constexpr std::uint32_t kFringeMinPoints = 40;

/// For every node combine() of the values in a cube of 2 * reach + 1 nodes per side around it, axis by axis.
template <class T, class Combine>
PerNode<T> combine_boxes(const Lattice& l, const PerNode<T>& values, int reach, const Combine& combine) {
    PerNode<T> out = values;
    for (NodeId row = 0; row < l.size(); row += l.nx)
        for (int d = 1; d <= reach; ++d) {
            const T* const in = values.data() + row;
            T* const to = out.data() + row;
            for (int x = 0; x < l.nx - d; ++x) to[x] = combine(to[x], in[x + d], d);
            for (int x = d; x < l.nx; ++x) to[x] = combine(to[x], in[x - d], d);
        }
    combine_across_rows(l, reach, combine, out);
    return out;
}

/// Points in the 3 x 3 x 3 nodes around every node.
PerNode<std::uint32_t> box_sums(const Lattice& lattice, const PerNode<std::uint32_t>& counts) {
    return combine_boxes(lattice, counts, 1, [](std::uint32_t a, std::uint32_t b, int) { return a + b; });
}

/// The largest value in the 5 x 5 x 5 nodes around every node.
template <class T>
PerNode<T> box_maxima(const Lattice& lattice, const PerNode<T>& values) {
    return combine_boxes(lattice, values, 2, [](T a, T b, int) { return a < b ? b : a; });
}

/// 0 instead of the counts of fringe nodes.
PerNode<std::uint32_t> without_fringe(const Lattice& lattice, const PerNode<std::uint32_t>& counts) {
    const PerNode<std::uint32_t> sums = box_sums(lattice, counts), most = box_maxima(lattice, sums);
    PerNode<std::uint32_t> kept = counts;
    for (NodeId i = 0; i < kept.size(); ++i)
        if (most[i] >= kFringeMinPoints && sums[i] < kFringeShare * most[i] && !skips("fringe")) kept[i] = 0;
    return kept;
}

/// Adds to \p inside the nodes of \p lattice whose nearest node of \p coarse is in \p coarse_inside.
void add_refined(const Lattice& coarse, const NodeSet& coarse_inside, const Lattice& lattice,
                 NodeSet& inside) {
    // Of node (x, y, z) it is xs[x] + ys[y] + zs[z].
    const auto along = [&](int axis, int count) {
        std::vector<NodeId> nearest;
        for (int i = 0; i < count; ++i) {
            vcg::Point3f p = coarse.corner;
            p[axis] = lattice.position(i, i, i)[axis];
            nearest.push_back(coarse.node_of(p));
        }
        return nearest;
    };
    const std::vector<NodeId> xs = along(0, lattice.nx), ys = along(1, lattice.ny), zs = along(2, lattice.nz);
    for_each_node(lattice, [&](int x, int y, int z) {
        const NodeId j = xs[at(x)] + ys[at(y)] + zs[at(z)];
        if (j < coarse.size() && coarse_inside[j] != 0) inside[lattice.index(x, y, z)] = 1;
    });
}

double radius_of_opening(const SealedSpaces& sealed, const Lattice& lattice) {
    return static_cast<double>(lattice.step) * std::sqrt(static_cast<double>(sealed.widest_opening));
}

/// Adds to \p inside the spaces with openings wider than kMaxRadius, found on a coarser lattice.
void seal_wide_openings(const std::vector<vcg::Point3f>& points, const vcg::Box3f& box, Region& region,
                        NodeSet& inside) {
    const float step = longest_side(box) / static_cast<float>(kCoarseSteps);
    if (!(step > region.lattice.step) || skips("wide_lattice")) return;
    const Lattice coarse(box, step, Region::kMargin);
    const PerNode<SquaredRadius> distances =
        squared_distances(coarse, count_points(coarse, points), kCoarseMaxRadius);
    const PerNode<SquaredRadius> clearance = clearances(coarse, distances, kCoarseMaxRadius, {});
    SealedSpaces sealed =
        enclosed_spaces(coarse, distances, clearance, kWidthRatio, kSingleLayerSquaredDepth);
    if (sealed.nodes == 0 && !region.encloses_space && !skips("single_layer"))
        sealed =
            enclosed_spaces(coarse, distances, clearance, kSingleLayerWidthRatio, kSingleLayerSquaredDepth);
    if (sealed.nodes == 0) return;
    add_refined(coarse, sealed.inside, region.lattice, inside);
    region.encloses_space = true;
    region.widest_opening = std::max(region.widest_opening, radius_of_opening(sealed, coarse));
}

/// Fills clearance, encloses_space, widest_opening and hollows.
void seal(const std::vector<vcg::Point3f>& points, const vcg::Box3f& box,
          const std::vector<LayerPlace>& places, Region& region) {
    region.clearance = clearances(region.lattice, region.distances, Region::kMaxRadius, {});
    SealedSpaces sealed = enclosed_spaces(region.lattice, region.distances, region.clearance, kWidthRatio, 0);
    region.encloses_space = sealed.nodes > 0;
    region.widest_opening = radius_of_opening(sealed, region.lattice);
    seal_wide_openings(points, box, region, sealed.inside);
    if (!region.encloses_space) return;
    region.hollows =
        take_hollows_out(region.lattice, region.distances, region.clearance, places, sealed.inside);
    region.clearance =
        clearances(region.lattice, region.distances, Region::kMaxRadius, sealed.inside, region.hollows);
}

long long points_of_component(long long total) {
    const long long wanted =
        std::max(kSpeckPoints, static_cast<long long>(kComponentShare * static_cast<double>(total)));
    return std::min(wanted, 1 + total / 4);  // so that a cloud of a few points has a component
}

}  // namespace

ThinParts thin_parts(const Region& region, const std::vector<LayerPlace>& places) {
    NodeSet enclosed(region.lattice.size(), 0);
    if (region.encloses_space)
        for (NodeId i = 0; i < enclosed.size(); ++i)
            enclosed[i] = region.clearance[i] == 0 && region.distances[i] > 0 ? 1 : 0;
    const NodeSet beside = box_maxima(region.lattice, enclosed);
    long long nodes = 0, of_sheet = 0;
    for (NodeId i = 0; i < beside.size(); ++i) {
        if (region.counts[i] == 0) continue;
        ++nodes;
        of_sheet += beside[i] == 0 ? 1 : 0;
    }
    ThinParts thin;
    thin.share = nodes == 0 ? 0 : static_cast<double>(of_sheet) / static_cast<double>(nodes);
    for (const LayerPlace& place : places) {
        const NodeId i = region.lattice.node_of(place.position);
        if (i < beside.size() && region.counts[i] != 0 && beside[i] == 0) thin.places.push_back(place);
    }
    return thin;
}

PerNode<std::uint32_t> count_points(const Lattice& lattice, const std::vector<vcg::Point3f>& points) {
    PerNode<std::uint32_t> counts(lattice.size(), 0);
    for (const vcg::Point3f& p : points) {
        const NodeId i = lattice.node_of(p);
        if (i < counts.size()) ++counts[i];
    }
    return counts;
}

Region examine(const std::vector<vcg::Point3f>& points, const vcg::Box3f& box, float step,
               const std::vector<LayerPlace>& places) {
    Region region;
    region.lattice = Lattice(box, step, Region::kMargin);
    region.counts = without_fringe(region.lattice, count_points(region.lattice, points));
    region.distances = squared_distances(region.lattice, region.counts, Region::kMaxRadius);
    seal(points, box, places, region);
    region.total_points = static_cast<long long>(points.size());
    region.min_points = points_of_component(region.total_points);
    return region;
}

}  // namespace neuralmesh
