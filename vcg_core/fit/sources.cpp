// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/sources.h"

#include "vcg_core/cloud/nearest_points.h"

namespace neuralmesh {

VertexPlaces::VertexPlaces(const Network& network) {
    for (const VertexId v : network.vertices()) {
        ids.push_back(v);
        places.push_back(network.position(v));
    }
}

PerVertex<VertexId> nearest_vertices(const VertexPlaces& before, const Network& after) {
    const NearestPoints search(before.places);
    PerVertex<VertexId> nearest(after.slot_count(), -1);
    for (const VertexId v : after.vertices())
        nearest[v] = before.ids[search.index(search.nearest_to(after.position(v)))];
    return nearest;
}

}  // namespace neuralmesh
