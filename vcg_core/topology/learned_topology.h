// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// When and how a growing network changes its topology: it gives up membranes that the points do not support.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/random.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/topology/membranes.h"

namespace neuralmesh {

/// How far a growing network may change its topology.
struct TopologyRules {
    /// Handles form while the mesh is coarse, too: a tetrahedron knows none. A shell has most of them, and a
    /// coarse mesh takes a narrow gap between two parts for a handle.
    bool from_tetrahedron = false;
    /// At the end of growth a membrane that nothing replaces becomes a hole if the smallest sphere around its
    /// rim has at least this diameter, in the core's frame. Infinite: the mesh stays closed.
    float opens_from = std::numeric_limits<float>::infinity();
};

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

/// An exchange of faces: another surface in place of membranes.
struct Reconnection {
    std::vector<int> membranes;   ///< indices of the membranes that go
    std::vector<Triangle> gone;   ///< their faces
    std::vector<Triangle> added;  ///< the faces in their place
    float gain = 0;               ///< signals that are explained better, see surroundings.h
};

/// Exchanges of faces by which \p network loses membranes: their rims closed, or joined with each other,
/// whichever the points support. A joint makes a handle, or one component of two; closed rims of a tube take
/// a handle away; a membrane with one rim is closed by a smaller surface.
///
/// Tried are every certain membrane, every pair that face each other, to be joined, and, from a tetrahedron,
/// three and more (membranes.h): the openings of one hollow, where every joint of two leaves a tube that
/// spans the others. Where joining two gains too little they may be the sides of a web, and are closed as one
/// with the faces between them. Membranes may be widened by one or two rings: the surface dents around a hole
/// that it plugs. A membrane that many others face is left alone, as it is among points that fill space.
///
/// The search ends when it has cost its budget, which is in proportion to the faces, those first that lack
/// the most signals; or when \p progress asks to stop. \return the best of those that gain enough (see
/// learned_topology.cpp), the largest gain first; each of them alone leaves a manifold, and no membrane is in
/// two. They do not depend on the number of threads. O(faces log faces + signals)
std::vector<Reconnection> topology_changes(const Network& network, const TargetSpace& target,
                                           const TopologyEvidence& now, const TopologyRules& rules,
                                           ThreadTeam& team, Progress& progress);

/// The faces of each certain membrane with one rim that is wide enough to become a hole, and faces no other.
std::vector<std::vector<Triangle>> membranes_to_open(const TopologyEvidence& now, const TopologyRules& rules);

}  // namespace neuralmesh
