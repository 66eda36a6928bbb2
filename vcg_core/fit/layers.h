// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Layers of points: the views of a scan that do not quite meet. Their distances from the surface are alike
// over many edges, so points held out of a fit cannot tell them from bends of the surface, and a mesh that
// runs from one layer to the next and back comes closer to all of them.
//
// What gives them away: independent noise is equally wide everywhere. Where views overlap, the points are
// spread across the surface more widely than where one view sees it alone.
#pragma once

#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// How surely the points lie in layers over most of the surface, in [0, 1], by the \p variances of
/// local_variances(): 0 if they are close to the surface, spread evenly, or fill a space. O(vertices).
/// \param points_per_vertex the variances of few points differ by chance
float layering(const Network& network, const Surface& surface, const PerVertex<float>& variances,
               float points_per_vertex);

/// The same for the places around each vertex: a few views may overlap where most of the surface is seen by
/// one. 0 where the points are spread widely everywhere, in layers or because they fill a space; and where
/// most of the rest is spread unevenly, too, because the mesh is too coarse for the shape.
PerVertex<float> local_layering(const Network& network, const Surface& surface,
                                const PerVertex<float>& variances);

/// The mean squared gap of the edges (see PointToPlaneSystem), estimated from how the faces around each
/// vertex turn. O(faces).
double mean_squared_gap(const Surface& surface);

}  // namespace neuralmesh
