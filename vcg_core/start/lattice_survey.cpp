// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A node may join the solid if its neighbours in the solid are connected among themselves. Then it neither
// joins components nor closes a loop.
#include "vcg_core/start/lattice_survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/parallel_for.h"
namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

bool adjacent(std::size_t i, std::size_t j) {
    const auto &a = kNeighbourOffsets[i], &b = kNeighbourOffsets[j];
    const NodeOffset difference = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return std::find(kNeighbourOffsets.begin(), kNeighbourOffsets.end(), difference) !=
           kNeighbourOffsets.end();
}

/// For every neighbour of a node those neighbours that are adjacent to it.
std::array<NeighbourSet, kNeighbourCount> adjacent_sets() {
    std::array<NeighbourSet, kNeighbourCount> sets{};
    for (std::size_t i = 0; i < kNeighbourCount; ++i)
        for (std::size_t j = 0; j < kNeighbourCount; ++j)
            if (adjacent(i, j)) sets[i] |= NeighbourSet{1} << j;
    return sets;
}

std::vector<std::uint8_t> connected_sets() {
    std::vector<std::uint8_t> connected(std::size_t{1} << kNeighbourCount);
    const auto adjacent_to = adjacent_sets();
    for (NeighbourSet set = 1; set < connected.size(); ++set) {
        NeighbourSet reached = set & (~set + 1), before = 0;
        while (reached != before) {
            before = reached;
            for (std::size_t i = 0; i < kNeighbourCount; ++i)
                if ((before >> i & 1U) != 0) reached |= adjacent_to[i] & set;
        }
        connected[set] = reached == set ? 1 : 0;
    }
    return connected;
}

constexpr int kRadiusFactor = 2;  // a handle has to persist over this range of radii
// The radius of level 0 is 0 and cannot be doubled. Its solid grows by the diagonal of a lattice square.
constexpr int kGrownLevelOfOccupied = 2;
/// Dense for small radii, where gaps between points and narrow handles appear and vanish.
constexpr std::array<int, 8> kGrownFromLevels = {0, 1, 2, 3, 4, 6, 9, 16};

// Pieces that join within this squared radius, and hold this share of the points, are fragments.
constexpr int kJoiningLevel = 4 * 4;
constexpr double kFragmentShare = 0.05;

Solid solid_at(const Region& region, int level) {
    return solid_of(region.lattice, region.clearance, region.counts, level, region.min_points);
}

/// Adds the components of the nodes outside \p solid that hold no node with clearance > level.
void fill_cavities(const Lattice& lattice, const PerNode<SquaredRadius>& clearance, int level,
                   NodeSet& solid) {
    const auto is_open = [&](const Run& run) {
        return std::any_of(run.begin_in(clearance), run.end_in(clearance),
                           [&](int c) { return c > level; }) ||
               lattice.is_on_side(run.begin) || lattice.is_on_side(run.end - 1);
    };
    for_each_component(lattice, solid, 0, [&](Span<const Run> component) {
        if (std::any_of(component.begin(), component.end(), is_open)) return;
        for (const Run& run : component) std::fill(run.begin_in(solid), run.end_in(solid), 1);
    });
}

// tests/experiments/accuracy/ablation.py shows what a change of these figures does.

/// A node costs about 30 bytes and 0.3 microseconds, and 9 bytes more for each of at most eight threads.
constexpr double kMaxNodes = 5.0e5;
constexpr int kMaxNodesPerSide = 256;
/// The lattice is as fine as possible with this many points per occupied node on average.
constexpr double kPointsPerNode = 1.1;
constexpr int kCoarserLattices = 4;
constexpr float kCoarser = 1.4F;  // step of a lattice over that of the next finer one

// step_for() tries longer and longer steps. A try for the density counts all points, one for the size is
// free.
constexpr float kNextStepForSize = 1.05F, kNextStepForDensity = 1.12F;
constexpr float kMinStepsPerSide = 8;  // a coarser lattice shows no shape

/// The step of the finest lattice that the limits allow: at most kMaxNodes nodes, and at least kPointsPerNode
/// points per occupied node, so that most nodes of the surface hold points.
float step_for(const std::vector<Point3f>& points, const Box3f& box) {
    const float side = longest_side(box);
    float step = side / static_cast<float>(kMaxNodesPerSide - 2 * Region::kMargin);
    while (static_cast<double>(Lattice(box, step, Region::kMargin).size()) > kMaxNodes)
        step *= kNextStepForSize;
    while (step < side / kMinStepsPerSide) {
        const Lattice lattice(box, step, Region::kMargin);
        const PerNode<std::uint32_t> counts = count_points(lattice, points);
        const auto occupied = counts.size() - std::count(counts.begin(), counts.end(), 0U);
        if (static_cast<double>(points.size()) / static_cast<double>(occupied) >= kPointsPerNode) break;
        step *= kNextStepForDensity;
    }
    return step;
}

/// In lattice steps. Level 0, the occupied nodes alone, counts as half a step: half the width of a cell.
double radius_of(int level) { return level == 0 ? 0.5 : std::sqrt(static_cast<double>(level)); }

/// A solid that is in pieces up to a larger radius than this, in lattice steps, is that of points in clumps.
/// The radii from here to where it hangs together vote for nothing.
constexpr double kClumpRadius = 2;

/// The votes for one topology, and the first level of the range with most of them.
struct Tally {
    double votes = 0, most = 0;
    int level = 0;
};

/// The topologies of the grown solids of some levels up to a third of Region::kMaxRadius. Left out are level
/// 0 if it has specks, and levels whose solid is in pieces because the radius is smaller than the distance
/// between points: no component is large enough, or 5 % of the points are in specks that join something
/// larger within four lattice steps. About 0.01 microseconds per node and level.
std::vector<TopologyAt> grown_topologies(const Region& region, ThreadTeam& team) {
    const long long joined = solid_at(region, kJoiningLevel).points_in_specks;
    const double fragments = kFragmentShare * static_cast<double>(region.total_points);
    const int levels = static_cast<int>(kGrownFromLevels.size());
    return parallel_collect<TopologyAt>(levels, 1, team, [&](int i, std::vector<TopologyAt>& found) {
        const int level = kGrownFromLevels[at(i)];
        Solid solid = solid_at(region, level);
        if (solid.components == 0 || static_cast<double>(solid.points_in_specks - joined) > fragments ||
            (level == 0 && solid.points_in_specks > 0))
            return;
        grow_without_bridges(region.lattice, region.clearance, grown_level(level), solid.nodes);
        const auto cavities = std::count_if(region.hollows.begin(), region.hollows.end(), [&](NodeId node) {
            return region.clearance[node] > grown_level(level);
        });
        const int surfaces = solid.components + static_cast<int>(cavities);
        found.push_back({level, surfaces, surfaces - euler_characteristic(region.lattice, solid.nodes)});
    });
}

}  // namespace

bool is_connected(NeighbourSet set) {
    static const std::vector<std::uint8_t> connected = connected_sets();
    return connected[set] != 0;
}

void grow_without_bridges(const Lattice& lattice, const PerNode<SquaredRadius>& clearance, int level,
                          NodeSet& solid) {
    Indexed<std::vector<NodeId>> waiting(level + 1);
    NodeSet outside(solid.size());
    std::transform(clearance.begin(), clearance.end(), solid.begin(), outside.begin(),
                   [level](SquaredRadius c, std::uint8_t in) { return c <= level && in == 0 ? 1 : 0; });
    for_each_member(outside, [&](NodeId i) { waiting[clearance[i]].push_back(i); });
    const Neighbours neighbours(lattice);
    for (int l = 0; l <= level; ++l) {
        std::vector<NodeId>& front = waiting[l];
        for (std::size_t k = 0; k < front.size(); ++k) {
            const NodeId i = front[k];
            if (solid[i] != 0) continue;
            const NeighbourSet places = neighbours.places(i);
            NeighbourSet link = 0;  // the neighbours in the solid
            neighbours.for_each_at(i, places, [&](NodeId j, int n) { link |= NeighbourSet{solid[j]} << n; });
            if (!is_connected(link)) continue;
            solid[i] = 1;
            neighbours.for_each_at(i, places & ~link, [&](NodeId j, int) {
                // It may have been left out, and be connected to the solid in another way now.
                if (clearance[j] <= l) front.push_back(j);
            });
        }
    }
    fill_cavities(lattice, clearance, level, solid);
}

int grown_level(int level) {
    if (level == 0) return kGrownLevelOfOccupied;
    return std::min(Region::kMaxLevel, level * kRadiusFactor * kRadiusFactor);
}

NodeSet plain_solid(const Region& region, int level) { return solid_at(region, level).nodes; }

NodeSet grown_solid(const Region& region, int level) {
    NodeSet solid = plain_solid(region, level);
    grow_without_bridges(region.lattice, region.clearance, grown_level(level), solid);
    return solid;
}

TopologyVote persistent_topology(const std::vector<TopologyAt>& topologies) {
    std::map<std::pair<int, int>, Tally> tallies;  // by components and genus
    double all = 0;
    if (!topologies.empty()) all = std::max(0.0, 1 / kClumpRadius - 1 / radius_of(topologies.front().level));
    for (std::size_t first = 0, last = 0; first < topologies.size(); first = last) {
        const TopologyAt& topology = topologies[first];
        while (last < topologies.size() && topologies[last].components == topology.components &&
               topologies[last].genus == topology.genus)
            ++last;
        // The last level of all, after which nothing is known, counts for one lattice step.
        const double from = radius_of(topology.level);
        const double to = last < topologies.size() ? radius_of(topologies[last].level)
                                                   : radius_of(topologies.back().level) + 1;
        const double votes = 1 / from - 1 / to;
        Tally& tally = tallies[{topology.components, topology.genus}];
        if (votes > tally.most) {
            tally.most = votes;
            tally.level = topology.level;
        }
        tally.votes += votes;
        all += votes;
    }
    TopologyVote result;
    for (const auto& [topology, tally] : tallies)
        if (tally.votes / all > result.confidence)
            result = {true, topology.first, topology.second, tally.votes / all, tally.level};
    return result;
}

LatticeSurvey survey_lattices(const std::vector<Point3f>& points, const std::vector<LayerPlace>& places,
                              const Box3f& box, ThreadTeam& team, Progress& progress) {
    const auto survey_at = [&](float step) {
        progress(0, "Start mesh: counting components and handles");
        LatticeSurvey survey{examine(points, box, step, places), {}, step};
        survey.vote = persistent_topology(grown_topologies(survey.region, team));
        if (!survey.vote.found) survey.vote.level = Region::kMaxLevel;
        return survey;
    };
    const float first = step_for(points, box);
    LatticeSurvey best = survey_at(first);
    float step = first;
    for (int i = 0; i < kCoarserLattices && best.vote.confidence < kLowConfidence; ++i) {
        if (skips("coarser_lattices")) break;
        LatticeSurvey other = survey_at(step *= kCoarser);
        if (other.vote.confidence > best.vote.confidence || !best.vote.found) best = std::move(other);
    }
    best.step = first;
    return best;
}

}  // namespace neuralmesh
