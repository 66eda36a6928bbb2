// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/lattice_survey.h"

#include <cstddef>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/shell/bridgeless_growth.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

// tests/experiments/tools/shell_topology shows what a change of these figures does.

/// Of the first lattice. A node costs about 30 bytes and 0.3 microseconds. Where parts nearly touch, a
/// further lattice has up to eight times as many nodes, and a node takes 9 bytes more for each of at most
/// eight threads.
constexpr double kMaxNodes = 5.0e5;
constexpr int kMaxNodesPerSide = 256;
/// The lattice is as fine as possible with this many points per occupied node on average.
constexpr double kPointsPerNode = 1.1;
constexpr std::size_t kMaxLattices = 5;
constexpr float kCoarser = 1.4F;  // step of a lattice over that of the next finer one
// The survey ends at this share of the votes: for plain solids, for grown ones before a finer lattice is
// examined, and for grown ones before coarser lattices are.
constexpr double kPlainConfidence = 0.9, kFineConfidence = 0.75;
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
        if (points_per_occupied_node(count_points(lattice, points)) >= points_per_node) break;
        step *= kNextStepForDensity;
    }
    return step;
}

/// Of all levels with a solid. Level 0 is left out: the points alone are rarely connected.
std::vector<TopologyAt> plain_topologies(const Region& region) {
    std::vector<TopologyAt> result;
    for (int level = 1; level < region.topologies.size(); ++level)
        if (!is_fragmented(region, level))
            result.push_back({level, region.topologies[level].surfaces(), region.topologies[level].genus});
    return result;
}

class Surveyor {
public:
    Surveyor(const std::vector<Point3f>& points, const std::vector<LayerPlace>& places, const Box3f& box,
             int threads, Progress& progress)
        : points_(points), places_(places), box_(box), progress_(progress), team_(thread_count(threads)) {
        survey_.step = step_for(points, box, kMaxNodes, kPointsPerNode);
    }

    void examine_plain();
    void grow();
    void examine_finer();
    void examine_coarser();
    double confidence() const { return survey_.vote.confidence; }
    LatticeSurvey take();

private:
    Region region_at(float step) const { return examine(points_, box_, step, places_); }
    void report() { progress_(0, "Start mesh: counting components and handles"); }
    void count_votes(bool grown);

    const std::vector<Point3f>& points_;
    const std::vector<LayerPlace>& places_;
    const Box3f& box_;
    Progress& progress_;
    ThreadTeam team_;
    LatticeSurvey survey_;
};

void Surveyor::count_votes(bool grown) {
    std::vector<double> steps;
    for (const Region& region : survey_.regions) steps.push_back(static_cast<double>(region.lattice.step));
    survey_.vote = persistent_topology(survey_.topologies, steps);
    survey_.vote.grown = grown;
}

void Surveyor::examine_plain() {
    survey_.regions.assign(2, Region(Lattice(box_, longest_side(box_), 0)));
    for_chunks(2, 1, team_, [&](std::size_t i, std::size_t, std::size_t) {
        survey_.regions[i] = region_at(i == 0 ? survey_.step : kCoarser * survey_.step);
    });
    for (const Region& region : survey_.regions) {
        report();
        survey_.topologies.push_back(plain_topologies(region));
    }
    count_votes(false);
}

void Surveyor::grow() {
    for (std::size_t i = 0; i < survey_.regions.size(); ++i) {
        report();
        survey_.topologies[i] = grown_topologies(survey_.regions[i], team_);
    }
    count_votes(true);
}

void Surveyor::examine_finer() {
    const float step = step_for(points_, box_, kFineNodes * kMaxNodes, kFinePointsPerNode * kPointsPerNode);
    if (step * kCoarser > survey_.step || skips("finer_lattice")) return;
    report();
    survey_.regions.insert(survey_.regions.begin(), region_at(step));
    report();
    survey_.topologies.insert(survey_.topologies.begin(), grown_topologies(survey_.regions.front(), team_));
    count_votes(true);
}

void Surveyor::examine_coarser() {
    for (float step = survey_.step * kCoarser * kCoarser;
         confidence() < kLowConfidence && survey_.regions.size() < kMaxLattices && !skips("coarser_lattices");
         step *= kCoarser) {
        report();
        survey_.regions.push_back(region_at(step));
        survey_.topologies.push_back(grown_topologies(survey_.regions.back(), team_));
        count_votes(true);
    }
}

LatticeSurvey Surveyor::take() {
    TopologyVote& vote = survey_.vote;
    if (!vote.found) {
        vote.lattice = static_cast<int>(survey_.regions.size()) - 1;
        vote.levels = {Region::kMaxLevel};
        vote.grown = false;
    }
    return std::move(survey_);
}

}  // namespace

LatticeSurvey survey_lattices(const std::vector<Point3f>& points, const std::vector<LayerPlace>& places,
                              const Box3f& box, int threads, Progress& progress) {
    Surveyor surveyor(points, places, box, threads, progress);
    surveyor.examine_plain();
    if (surveyor.confidence() >= kPlainConfidence || skips("bridgeless_growth")) return surveyor.take();
    surveyor.grow();
    if (surveyor.confidence() < kFineConfidence) surveyor.examine_finer();
    surveyor.examine_coarser();
    return surveyor.take();
}

}  // namespace neuralmesh
