// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/sources.h"

#include <vector>

#include "vcg_core/cloud/nearest_points.h"

namespace neuralmesh {

PerVertex<VertexId> nearest_vertices(const Network& before, const Network& after) {
    std::vector<VertexId> ids;
    std::vector<vcg::Point3f> places;
    for (const VertexId v : before.vertices()) {
        ids.push_back(v);
        places.push_back(before.position(v));
    }
    const NearestPoints search(places);
    PerVertex<VertexId> nearest(after.slot_count(), -1);
    for (const VertexId v : after.vertices())
        nearest[v] = ids[search.index(search.nearest_to(after.position(v)))];
    return nearest;
}

}  // namespace neuralmesh
