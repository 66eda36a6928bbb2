// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Edge flips that bring valences closer to 6, on a boundary to 4, the valences of a regular triangulation
// (Frey and Borouchaki, "Geometric surface mesh optimization", 1998), or give better shaped faces where the
// surface is flat.
#pragma once

#include <vcg/space/point3.h>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Normals, as long as twice the area, of the two faces at an edge before and after its flip.
struct FlipNormals {
    vcg::Point3f before[2];
    vcg::Point3f after[2];
};

/// Conditions on a flip beyond those of Network::can_flip().
struct FlipRule {
    bool (*is_flat)(const FlipNormals& normals);  ///< true if the flip changes the surface little enough
    int max_valence = Ring::kMaxValence;          ///< no flip raises a valence above it
};

/// Changes of a whole mesh raise no valence above it: that leaves room for those of learning and fit.
constexpr int kHighestValence = 12;
/// Valences in a regular triangulation, inside and on a boundary.
constexpr int kRegularValence = 6, kRegularBoundaryValence = 4;

/// (valence - 6)^2: 0 for a regular vertex.
inline int valence_irregularity(int valence) {
    return (valence - kRegularValence) * (valence - kRegularValence);
}

/// Flips the edges of \p v to neighbours from \p least on that can be flipped and for which \p should(v,
/// neighbour) holds. O(valence). \return the number of flips
template <class Should>
int flip_edges_if(Network& network, VertexId v, VertexId least, const Should& should) {
    int flips = 0;
    for (int i = 0; i < network.ring(v).valence; ++i) {
        const VertexId w = network.ring(v)[i];
        if (w < least || !network.can_flip(v, w) || !should(v, w)) continue;
        network.flip(v, w);
        ++flips;
    }
    return flips;
}

/// Flips every inner edge from \p v to neighbours from \p least on whose flip lowers the sum of the squared
/// differences from the regular valences over the four vertices around it and is allowed by \p rule;
/// positions stay. O(valence^2). \return the number of flips
int flip_edges_for_valence(Network& network, VertexId v, const FlipRule& rule, VertexId least = 0);

/// The same for all edges of \p network, once each, in the order of their smaller vertices. O(vertices).
int flip_edges_for_valence(Network& network, const FlipRule& rule);

/// Flips inner edges until no flip that changes the surface by at most \p most, and a hundredth of the new
/// edge, raises the smaller triangle_quality() of its two faces. That change is the distance between the
/// edges before and after the flip. Positions stay. O(vertices) for a pass; few passes do. \return the number
/// of flips
int flip_edges_for_shape(Network& network, float most);

}  // namespace neuralmesh
