// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/sources.h"

#include <utility>

namespace neuralmesh {

PerVertex<VertexId> own_sources(const Network& network) {
    PerVertex<VertexId> sources(network.slot_count(), -1);
    for (VertexId v : network.vertices()) sources[v] = v;
    return sources;
}

VertexId nearest_by_steps(const Network& before, VertexId from, const vcg::Point3f& place) {
    const auto distance = [&](VertexId u) { return (before.position(u) - place).SquaredNorm(); };
    VertexId nearest = from;
    do {
        from = nearest;
        for (VertexId u : before.ring(from))
            if (distance(u) < distance(nearest)) nearest = u;
    } while (nearest != from);
    return nearest;
}

PerVertex<VertexId> chained(const PerVertex<VertexId>& first, PerVertex<VertexId> second) {
    for (VertexId& v : second)
        if (v >= 0) v = first[v];
    return second;
}

}  // namespace neuralmesh
