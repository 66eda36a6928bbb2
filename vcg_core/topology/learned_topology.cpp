// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/learned_topology.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/mesh/boundary_loops.h"
#include "vcg_core/mesh/face_tree.h"
#include "vcg_core/topology/surroundings.h"

namespace neuralmesh {

namespace {

/// Ten for each face: that a face of the surface gets none by chance happens once in 20,000 times.
constexpr std::size_t kSignalsPerVertex = 20;
/// With fewer points per vertex, faces without any are common. With eight, feline from 20,000 points has two
/// handles with 10 of 30 seeds instead of 16.
constexpr std::size_t kFewestPerVertex = 6;

/// Of the signals that a membrane lacks, what another has to lack to be its counterpart. Along the rim of an
/// opening there may be small ones.
constexpr float kComparable = 0.2F;

float width_of(const Rim& rim, const Surface& surface) {
    std::vector<vcg::Point3f> points;
    points.reserve(rim.size());
    for (const VertexId v : rim) points.push_back(to_vcg(surface.positions[v]));
    return smallest_sphere_diameter(points);
}

/// Membranes with more rims have too many reconnections to try: one or two membranes, and three or more.
constexpr std::size_t kMostRims = 4, kMostOfGroup = 5;
/// With more points per vertex, the mesh is too coarse to tell a handle from a bridge: it has a bridge
/// wherever parts are closer than its edges are long.
constexpr std::size_t kMostPerVertex = 40;
/// Rings by which membranes are widened.
constexpr std::size_t kMostRings = 2;
/// A reconnection that loses more signals than this as the membranes are gains none with wider ones.
constexpr float kHopeless = -60;
/// A reconnection gains enough if it explains this share of what the membranes lack, and this many signals.
/// The way back would have to gain as much, so nothing oscillates while the vertices stay. Chosen by the bolt
/// holes of turbine: joints there gain 10 signals and more, joints elsewhere lose 40 and more.
constexpr float kLeastShare = 0.4F, kLeastGain = 8;

/// A membrane that more others face is left alone: points that fill space, as leaves do, make membranes all
/// around, and any surface in their place is as wrong.
constexpr std::size_t kMostFacing = 8;
/// What a search may cost: so many faces looked at for each face of the mesh. In groups, for so many faces at
/// least: small meshes from a tetrahedron are full of membranes, and up to 90,000 faces are looked at where
/// there are 600 to 6,000.
constexpr std::int64_t kVisitsPerFace = 8, kFewestFaces = 12000;
/// Candidates between two looks at the budget and the progress. A number that depends on the threads would
/// let them change the result.
constexpr int kBetweenLooks = 32;

bool may_form_handles(const TargetSpace& target, const TopologyRules& rules, std::size_t vertices) {
    return !target.is_exact() &&
           (rules.from_tetrahedron || target.positions().size() <= kMostPerVertex * vertices);
}

/// A membrane, and the same one and more rings wider.
using Wide = std::vector<Membrane>;
/// Membranes that may go together, by their indices.
using Group = std::vector<int>;

class Search {
public:
    Search(const Network& network, const TopologyEvidence& now, bool handles, bool in_groups,
           ThreadTeam& team, Progress& progress);

    /// Every certain membrane, and every two that face each other and are no clutter.
    std::vector<Group> candidates();
    /// The best reconnections of \p groups that gain enough, as far as the budget goes.
    std::vector<Reconnection> reconnections(const std::vector<Group>& groups);
    float missing(const Group& group) const;
    float edge() const { return edge_; }

private:
    /// Calls \p find(i, found) for every i below \p count, on several threads, while the search may go on.
    template <class Found, class Find>
    std::vector<Found> collect(int count, const Find& find);
    void widen(Wide& wide) const;
    /// The membranes that \p membrane may be joined with.
    Group facing(int membrane) const;
    /// The best reconnection of membranes, joined if they are several, if it gains enough; else one without
    /// faces.
    Reconnection of(const Group& group) const;
    Reconnection best(const std::vector<Membrane>& membranes) const;
    /// Makes a membrane of \p faces. \return false if it cannot be completed.
    bool make(Membrane& membrane, std::vector<int> faces) const;

    const Network& network_;
    const Surface& surface_;
    FaceTree tree_;
    const FaceSignals& support_;
    bool handles_;  ///< joints may make some
    std::int64_t most_visits_;
    ThreadTeam& team_;
    Progress& progress_;
    float edge_;
    Indexed<Wide> wide_;
    PerFace<int> membrane_of_;  ///< -1: none
    bool stopped_ = false;
    mutable std::atomic<std::int64_t> visits_{0};  ///< faces looked at
};

Search::Search(const Network& network, const TopologyEvidence& now, bool handles, bool in_groups,
               ThreadTeam& team, Progress& progress)
    : network_(network),
      surface_(now.surface),
      tree_(surface_, team),
      support_(now.support),
      handles_(handles),
      most_visits_(kVisitsPerFace *
                   std::max<std::int64_t>(surface_.face_count(), in_groups ? kFewestFaces : 0)),
      team_(team),
      progress_(progress),
      edge_(mean_edge_length(surface_)),
      membrane_of_(surface_.face_count(), -1) {
    for (const Membrane& membrane : now.membranes) {
        for (const int f : membrane.faces) membrane_of_[f] = wide_.size();
        wide_.push_back({membrane});
    }
}

template <class Found, class Find>
std::vector<Found> Search::collect(int count, const Find& find) {
    std::vector<Found> all;
    for (int begin = 0; begin < count && !stopped_ && visits_ < most_visits_; begin += kBetweenLooks) {
        const int some = std::min(kBetweenLooks, count - begin);
        for (Found& found : parallel_collect<Found>(
                 some, 1, team_, [&](int i, std::vector<Found>&part) { find(begin + i, part); }))
            all.push_back(std::move(found));
        stopped_ = !progress_(0, "Learning: exchanging faces without points");
    }
    return all;
}

/// Of the membranes together; one that joins them, if they are several. Its gain is the lowest number if
/// there is none.
Reconnection Search::best(const std::vector<Membrane>& membranes) const {
    Reconnection found;
    found.gain = std::numeric_limits<float>::lowest();
    std::vector<int> faces;
    std::vector<Rim> rims;
    for (const Membrane& membrane : membranes) {
        faces.insert(faces.end(), membrane.faces.begin(), membrane.faces.end());
        rims.insert(rims.end(), membrane.rims.begin(), membrane.rims.end());
    }
    visits_ += static_cast<std::int64_t>(faces.size());
    if (rims.size() > (membranes.size() > 2 ? kMostOfGroup : kMostRims)) return found;
    PerFace<char> out(surface_.face_count(), 0);
    for (const int f : faces) {
        if (out[f]++ != 0) return found;  // the membranes overlap
        found.gone.push_back(surface_.faces[f]);
    }
    const Edges edges(network_, surface_, out);
    std::optional<const Surroundings> around;  // for many membranes no patch can be made
    const bool several = membranes.size() > 1;
    for (const bool joined : {false, true}) {
        if (joined ? rims.size() < 2 || (several && !handles_) : several) continue;
        std::vector<Triangle> added = joined ? joining_patch(rims, edges) : closing_patches(rims, edges);
        if (added.empty() || !network_.can_exchange_faces(found.gone, added)) continue;
        if (!around) visits_ += around.emplace(surface_, tree_, support_, faces, edge_).face_count();
        const float gain = around->gain(added);
        if (gain <= found.gain) continue;
        found.gain = gain;
        found.added = std::move(added);
    }
    return found;
}

bool Search::make(Membrane& membrane, std::vector<int> faces) const {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    membrane.faces = std::move(faces);
    return complete(surface_, support_, membrane);
}

/// Adds the same membrane with the faces around, and around those.
void Search::widen(Wide& wide) const {
    if (skips("wide_membranes")) return;
    while (wide.size() <= kMostRings) {
        std::vector<int> faces;
        for (const int f : wide.back().faces)
            for (const VertexId v : surface_.faces[f])
                faces.insert(faces.end(), surface_.faces_around(v).begin(), surface_.faces_around(v).end());
        Membrane next;
        if (!make(next, std::move(faces))) return;
        wide.push_back(std::move(next));
    }
}

Group Search::facing(int membrane) const {
    const Membrane& from = wide_[membrane].front();
    std::set<int> near;
    tree_.for_overlapping(box_around(surface_, from.faces, kReach * edge_),
                          [&](int f) { near.insert(membrane_of_[f]); });
    Group found;
    for (const int other : near)
        if (other >= 0 && other != membrane && face_each_other(surface_, from, wide_[other].front(), edge_))
            found.push_back(other);
    return found;
}

Reconnection Search::of(const Group& group) const {
    Reconnection found;
    found.gain = std::numeric_limits<float>::lowest();
    for (std::size_t ring = 0; ring <= kMostRings; ++ring) {
        std::vector<Membrane> membranes;
        for (const int i : group) membranes.push_back(wide_[i][std::min(ring, wide_[i].size() - 1)]);
        if (group.size() > 2 && !take_apart(surface_, support_, membranes)) continue;
        Reconnection next = best(membranes);
        if (next.gain > found.gain) found = std::move(next);
        if (group.size() == 2 && found.gain < kHopeless) break;
    }
    if (found.gain < std::max(kLeastGain, kLeastShare * missing(group))) found = Reconnection();
    found.membranes = group;
    return found;
}

float Search::missing(const Group& group) const {
    float sum = 0;
    for (const int i : group) sum += wide_[i].front().missing;
    return sum;
}

std::vector<Group> Search::candidates() {
    const Indexed<Group> facing(
        collect<Group>(wide_.size(), [&](int a, auto& all) { all.push_back(this->facing(a)); }));
    const auto is_clutter = [&](int a) { return facing[a].size() > kMostFacing; };
    std::vector<Group> found;
    for (int a = 0; a < facing.size(); ++a) {
        if (is_clutter(a)) continue;
        if (wide_[a].front().certain) found.push_back({a});
        for (const int b : facing[a])
            if (b > a && b < facing.size() && !is_clutter(b) &&
                wide_[a].front().rims.size() + wide_[b].front().rims.size() <= kMostRims)
                found.push_back({a, b});
    }
    return found;
}

std::vector<Reconnection> Search::reconnections(const std::vector<Group>& groups) {
    std::set<int> used;
    for (const Group& group : groups) used.insert(group.begin(), group.end());
    const std::vector<int> members(used.begin(), used.end());
    parallel_for(static_cast<int>(members.size()), 1, team_,
                 [&](int i) { widen(wide_[members[static_cast<std::size_t>(i)]]); });
    return collect<Reconnection>(static_cast<int>(groups.size()),
                                 [&](int i, std::vector<Reconnection>& found) {
                                     Reconnection change = of(groups[static_cast<std::size_t>(i)]);
                                     if (!change.added.empty()) found.push_back(std::move(change));
                                 });
}

/// \p groups, each followed by what is left of it without those that lack the least signals, down to three.
std::vector<Group> with_smaller(const std::vector<Group>& groups) {
    std::vector<Group> all;
    for (Group group : groups)
        for (; group.size() >= 3; group.pop_back()) all.push_back(group);
    return all;
}

}  // namespace

int most_examined(const TargetSpace& target) {
    // A stage may begin some vertices late.
    const std::size_t most = target.positions().size() / 100 * 96 / kFewestPerVertex;
    return target.is_exact() ? std::numeric_limits<int>::max() : static_cast<int>(most);
}

std::optional<TopologyEvidence> topology_evidence(const Network& network, const TargetSpace& target,
                                                  Random& random, ThreadTeam& team) {
    Surface surface(network);
    const auto vertices = static_cast<std::size_t>(network.vertex_count());
    if (surface.has_boundary() ||
        (!target.is_exact() && target.positions().size() < kFewestPerVertex * vertices))
        return std::nullopt;
    FaceSignals support =
        face_signals(network, surface, fair_sample(target, kSignalsPerVertex * vertices, random), team);
    std::vector<Membrane> membranes = find_membranes(surface, support);
    return TopologyEvidence{std::move(surface), std::move(support), std::move(membranes)};
}

std::vector<Reconnection> topology_changes(const Network& network, const TargetSpace& target,
                                           const TopologyEvidence& now, const TopologyRules& rules,
                                           ThreadTeam& team, Progress& progress) {
    if (now.membranes.empty()) return {};
    const bool handles = may_form_handles(target, rules, static_cast<std::size_t>(network.vertex_count()));
    Search search(network, now, handles, rules.from_tetrahedron, team, progress);
    std::vector<Group> groups = search.candidates();
    if (rules.from_tetrahedron && !skips("membrane_groups"))
        for (Group& group :
             with_smaller(membrane_groups(now.surface, now.membranes, search.edge(), kMostOfGroup)))
            groups.push_back(std::move(group));
    // The budget is for those that lack the most signals.
    std::stable_sort(groups.begin(), groups.end(),
                     [&](const Group& a, const Group& b) { return search.missing(a) > search.missing(b); });
    std::vector<Reconnection> found = search.reconnections(groups);
    std::stable_sort(found.begin(), found.end(),
                     [](const Reconnection& a, const Reconnection& b) { return a.gain > b.gain; });
    std::vector<Reconnection> chosen;
    std::set<int> used;
    for (Reconnection& change : found) {
        const auto taken = [&](int membrane) { return used.count(membrane) != 0; };
        if (std::any_of(change.membranes.begin(), change.membranes.end(), taken)) continue;
        used.insert(change.membranes.begin(), change.membranes.end());
        chosen.push_back(std::move(change));
    }
    return chosen;
}

std::vector<std::vector<Triangle>> membranes_to_open(const TopologyEvidence& now,
                                                     const TopologyRules& rules) {
    std::vector<std::vector<Triangle>> chosen;
    const float edge = mean_edge_length(now.surface);
    for (const Membrane& membrane : now.membranes) {
        if (!membrane.certain || membrane.rims.size() != 1 ||
            width_of(membrane.rims.front(), now.surface) < rules.opens_from)
            continue;
        // Two that face each other span a gap or plug a hole that was not understood.
        const auto faces_it = [&](const Membrane& other) {
            return &other != &membrane && other.missing > kComparable * membrane.missing &&
                   face_each_other(now.surface, membrane, other, edge);
        };
        if (std::any_of(now.membranes.begin(), now.membranes.end(), faces_it)) continue;
        chosen.emplace_back();
        for (const int f : membrane.faces) chosen.back().push_back(now.surface.faces[f]);
    }
    return chosen;
}

}  // namespace neuralmesh
