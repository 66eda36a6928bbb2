// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/paper/learning_state.h"

#include <map>
#include <utility>

#include "vcg_core/mesh/flips.h"

namespace neuralmesh {

namespace {

/// Flips are allowed if the normals of both faces before and after differ by less than 18 degrees.
constexpr float kLeastCosineOfFlip = 0.95F;

bool is_flat(const FlipNormals& normals) {
    for (vcg::Point3f n : normals.before) {
        n.Normalize();
        for (vcg::Point3f m : normals.after)
            if (n * m.Normalize() < kLeastCosineOfFlip) return false;
    }
    return true;
}

}  // namespace

LearningState::LearningState(const GrowthOptions& the_options, Network start)
    : options(the_options),
      network(std::move(start)),
      search(network),
      utility_counters(options.counter_decay, options.min_wins_per_split),
      feature_counters(options.feature_decay) {
    network.reserve(options.grow_to + 1);
    utility_counters.resize(network.slot_count());
    feature_counters.resize(network.slot_count());
    activity.resize(network.slot_count());
}

VertexId LearningState::split(VertexId v, int first, int count, const vcg::Point3f& where) {
    const VertexId u = network.split(v, first, count, where);
    search.add(u);
    search.rebuild_if_outgrown();
    utility_counters.resize(network.slot_count());
    feature_counters.resize(network.slot_count());
    activity.resize(network.slot_count());
    utility_counters.share(v, u, squared_mean_edge(network, v), squared_mean_edge(network, u));
    feature_counters.inherit(v, u);
    // A new vertex counts as active, so that the next Half-Edge Collapse keeps it. To the letter of the
    // paper it is inactive until it wins.
    activity.set(u, to_the_letter() ? 0 : signals);
    ++splits;
    return u;
}

void LearningState::collapse(VertexId gone, VertexId kept) {
    search.remove(gone);
    utility_counters.remove(gone);
    network.collapse(gone, kept);
    ++collapses;
}

bool LearningState::exchange_faces(const std::vector<Triangle>& gone, const std::vector<Triangle>& added) {
    if (!network.can_exchange_faces(gone, added)) return false;
    std::map<VertexId, int> left;  // faces of the vertices concerned
    for (const Triangle& f : gone)
        for (const VertexId v : f) --left.try_emplace(v, network.ring(v).face_count()).first->second;
    for (const Triangle& f : added)
        for (const VertexId v : f) ++left[v];
    for (const auto& [v, faces] : left) {
        if (faces > 0) continue;
        search.remove(v);
        utility_counters.remove(v);
        ++collapses;
    }
    network.exchange_faces(gone, added);
    return true;
}

void LearningState::regularise(VertexId v) {
    if (!to_the_letter()) flip_edges_for_valence(network, v, {is_flat});
}

void LearningState::renumber(const std::vector<VertexId>& order) {
    network.renumber(order);
    utility_counters.renumber(order);
    feature_counters.renumber(order);
    activity.renumber(order);
    search.rebuild();
}

}  // namespace neuralmesh
