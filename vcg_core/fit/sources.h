// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Which vertex of an earlier network stands for each vertex of a later one: its counters are taken over.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The vertices of a network and where they lie: what nearest_vertices() needs of one that is to change.
struct VertexPlaces {
    explicit VertexPlaces(const Network& network);

    std::vector<VertexId> ids;
    std::vector<vcg::Point3f> places;
};

/// For every slot of \p after the vertex of \p before that is nearest to the place of its vertex, so that
/// counters stay where they were learned; -1 for free slots. O(vertices log vertices).
PerVertex<VertexId> nearest_vertices(const VertexPlaces& before, const Network& after);

}  // namespace neuralmesh
