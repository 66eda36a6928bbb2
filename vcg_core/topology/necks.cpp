// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/necks.h"

#include <algorithm>
#include <set>
#include <utility>

namespace neuralmesh {
namespace {

/// A closed chain of edges, by its vertices.
using Chain = std::vector<VertexId>;

/// The same for every beginning and direction.
Chain in_order(Chain chain) {
    std::rotate(chain.begin(), std::min_element(chain.begin(), chain.end()), chain.end());
    if (chain[1] > chain.back()) std::reverse(chain.begin() + 1, chain.end());
    return chain;
}

/// Adds the chains of three and four edges at \p v that no edge divides and that bound no face.
void add_chains(const Network& network, VertexId v, std::set<Chain>& chains) {
    const Ring& ring = network.ring(v);
    for (int i = 0; i < ring.valence; ++i)
        for (int k = i + 2; k < ring.valence - (i == 0 ? 1 : 0); ++k) {
            const Ring& beside = network.ring(ring[i]);
            if (beside.find(ring[k]) >= 0) {
                chains.insert(in_order({v, ring[i], ring[k]}));
                continue;
            }
            for (const VertexId w : network.ring(ring[k]))
                if (w != v && ring.find(w) < 0 && beside.find(w) >= 0)
                    chains.insert(in_order({v, ring[i], w, ring[k]}));
        }
}

std::vector<int> faces_around(const Surface& surface, const Chain& chain) {
    std::set<int> faces;
    for (const VertexId v : chain)
        faces.insert(surface.faces_around(v).begin(), surface.faces_around(v).end());
    return {faces.begin(), faces.end()};
}

/// Whether a way over the faces leads from one side of \p chain to the other without crossing it.
bool is_around_handle(const Surface& surface, const Chain& chain) {
    std::set<std::pair<VertexId, VertexId>> edges;
    for (std::size_t i = 0; i < chain.size(); ++i) {
        const VertexId a = chain[i], b = chain[(i + 1) % chain.size()];
        edges.insert({{a, b}, {b, a}});
    }
    const int goal = corner_of_edge(surface, chain[1], chain[0]).face;
    std::vector<int> way{corner_of_edge(surface, chain[0], chain[1]).face};
    PerFace<char> seen(surface.face_count(), 0);
    seen[way.front()] = 1;
    for (std::size_t i = 0; i < way.size() && seen[goal] == 0; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const Triangle& face = surface.faces[way[i]];
            const int next = face_beyond(surface, way[i], k);
            if (next < 0 || seen[next] != 0 || edges.count({face[k], face[(k + 1) % 3]}) != 0) continue;
            seen[next] = 1;
            way.push_back(next);
        }
    return seen[goal] != 0;
}

}  // namespace

std::vector<Membrane> find_necks(const Network& network, const Surface& surface, const FaceSignals& signals) {
    std::set<Chain> chains;
    for (int f = 0; f < surface.face_count(); ++f) {
        if (!signals.lacks_support(f)) continue;
        for (const VertexId v : surface.faces[f]) add_chains(network, v, chains);
    }
    std::vector<Membrane> necks;
    for (const Chain& chain : chains) {
        Membrane neck;
        neck.faces = faces_around(surface, chain);
        if (signals.lack_of(neck.faces) < kTubeLack || !complete(surface, signals, neck) ||
            neck.rims.size() != 2 || !is_around_handle(surface, chain))
            continue;
        neck.certain = true;
        necks.push_back(std::move(neck));
    }
    return necks;
}

}  // namespace neuralmesh
