// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/lattice_survey.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/base/thread_team.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

// tests/experiments/accuracy/ablation.py shows what a change of these figures does.

/// Of the first lattice. A node costs about 30 bytes and 0.3 microseconds. Where parts nearly touch, a
/// further lattice has up to eight times as many nodes, and a node takes 9 bytes more for each of at most
/// eight threads.
constexpr double kMaxNodes = 5.0e5;
constexpr int kMaxNodesPerSide = 256;
/// The lattice is as fine as possible with this many points per occupied node on average.
constexpr double kPointsPerNode = 1.1;
constexpr int kCoarserLattices = 4;
constexpr float kCoarser = 1.4F;  // step of a lattice over that of the next finer one
// At this share of the votes no finer lattice is examined.
constexpr double kFineConfidence = 0.75;
// The finer lattice may have this many times the nodes, but needs this many times the points per node: it is
// for dense clouds.
constexpr double kFineNodes = 8, kFinePointsPerNode = 2;

// step_for() tries longer and longer steps. A try for the density counts all points, one for the size is
// free.
constexpr float kNextStepForSize = 1.05F, kNextStepForDensity = 1.12F;
constexpr float kMinStepsPerSide = 8;  // a coarser lattice shows no shape

/// The step of the finest lattice that the limits allow: at most \p max_nodes nodes, and at least \p
/// points_per_node points per occupied node, so that most nodes of the surface hold points.
float step_for(const std::vector<Point3f>& points, const Box3f& box, double max_nodes,
               double points_per_node) {
    const float side = longest_side(box);
    float step = side / static_cast<float>(kMaxNodesPerSide - 2 * Region::kMargin);
    while (static_cast<double>(Lattice(box, step, Region::kMargin).size()) > max_nodes)
        step *= kNextStepForSize;
    while (step < side / kMinStepsPerSide) {
        const Lattice lattice(box, step, Region::kMargin);
        const PerNode<std::uint32_t> counts = count_points(lattice, points);
        const auto occupied = counts.size() - std::count(counts.begin(), counts.end(), 0U);
        if (static_cast<double>(points.size()) / static_cast<double>(occupied) >= points_per_node) break;
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

}  // namespace

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

bool is_better(const TopologyVote& vote, const TopologyVote& than, bool finer) {
    const double least = finer ? std::min(than.confidence, kLowConfidence) : than.confidence;
    return vote.confidence > least || !than.found;
}

LatticeSurvey survey_lattices(const std::vector<Point3f>& points, const std::vector<LayerPlace>& places,
                              const Box3f& box, int threads, Progress& progress) {
    ThreadTeam team(thread_count(threads));
    const auto survey_at = [&](float step) {
        progress(0, "Start mesh: counting components and handles");
        LatticeSurvey survey{examine(points, box, step, places), {}, step};
        survey.vote = persistent_topology(grown_topologies(survey.region, team));
        if (!survey.vote.found) survey.vote.level = Region::kMaxLevel;
        return survey;
    };
    const float first = step_for(points, box, kMaxNodes, kPointsPerNode);
    LatticeSurvey best = survey_at(first);
    const auto take_better = [&](float step) {
        LatticeSurvey other = survey_at(step);
        if (is_better(other.vote, best.vote, step < first)) best = std::move(other);
    };
    if (best.vote.confidence < kFineConfidence && !skips("finer_lattice")) {
        const float finer =
            step_for(points, box, kFineNodes * kMaxNodes, kFinePointsPerNode * kPointsPerNode);
        if (finer * kCoarser < first) take_better(finer);
    }
    float step = first;
    for (int i = 0; i < kCoarserLattices && best.vote.confidence < kLowConfidence; ++i)
        if (!skips("coarser_lattices")) take_better(step *= kCoarser);
    best.step = first;
    return best;
}

}  // namespace neuralmesh
