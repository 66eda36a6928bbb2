// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// When and how a growing network changes its topology: it gives up membranes that the points do not support.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/random.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/topology/reconnection.h"
#include "vcg_core/topology/topology_rules.h"

namespace neuralmesh {

/// The number of vertices at the last stage of a long growth: with more, the points of \p target are too few
/// for each vertex to tell of the topology.
int most_examined(const TargetSpace& target);

/// The stages of growth at which the topology is examined: 300 x 2^k vertices, and the last number. Each is
/// passed once, so a run has at most log2(vertices) of them whatever the points are.
class TopologyStages {
public:
    /// Of growth from \p vertices on; \p goal is the last stage. None if that is passed already.
    TopologyStages(int vertices, int goal)
        : goal_(goal), next_(std::min(kFirst, goal)), over_(vertices >= goal) {
        while (next_ <= vertices && next_ < goal) advance();
    }
    /// True once for each stage that a network of \p vertices has reached.
    bool pass(int vertices) {
        if (over_ || vertices < next_) return false;
        over_ = next_ == goal_;
        advance();
        return true;
    }
    /// Whether the last one is passed.
    bool over() const { return over_; }

private:
    static constexpr int kFirst = 300;
    /// A stage beyond four fifths of the last would find the same as that.
    void advance() { next_ = next_ < goal_ / 5 * 2 ? 2 * next_ : goal_; }

    int goal_;
    int next_;
    bool over_;
};

/// What a sample of the points says of a closed network.
struct TopologyEvidence {
    Surface surface;
    FaceSignals support;
    std::vector<Membrane> membranes;
};

/// The signals are a fair sample of \p target, 20 per vertex. Nothing if the network is open or has less
/// than six points per vertex. Does not depend on the number of threads. Cost: about that of learning the
/// signals.
std::optional<TopologyEvidence> topology_evidence(const Network& network, const TargetSpace& target,
                                                  Random& random, ThreadTeam& team);

/// Exchanges of faces by which \p network loses membranes of few points: see reconnection.h. No membrane is
/// in two of them. They do not depend on the number of threads.
std::vector<Reconnection> topology_changes(const Network& network, const TargetSpace& target,
                                           const TopologyEvidence& now, const TopologyRules& rules,
                                           ThreadTeam& team, Progress& progress);

/// The faces of each certain membrane with one rim that is wide enough to become a hole, and faces no other.
std::vector<std::vector<Triangle>> membranes_to_open(const TopologyEvidence& now, const TopologyRules& rules);

}  // namespace neuralmesh
