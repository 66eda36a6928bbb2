// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Moves vertices through the mesh: collapses where they matter little, splits where the error is large. Fewer
// vertices, by measured costs or by the shape of the mesh (volume_collapse.cpp). More vertices than the
// points carry: the longest edges are split. And which earlier vertex stands for each after that.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/fit/support.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// The cheapest half-edge collapse of a vertex.
struct Collapse {
    float cost;  ///< rise of the sum of squared distances of the points
    VertexId gone;
    VertexId into;  ///< -1 and a cost of Support::kForbidden: the vertex cannot go, or was not examined
};

/// The cheapest collapse of every slot, cheapest first. Examines two fifths of the vertices, those with the
/// smallest quadric errors, and for each the three neighbours of smallest quadric error. Each cost is
/// measured on about 64 points of the star, by their distances from the faces that replace it. kCollapseRules
/// of face_rules.h hold. \p surface is that of the network. O(vertices log vertices). The result does not
/// depend on the number of threads.
std::vector<Collapse> find_collapses(const Network& network, const Surface& surface,
                                     const PointsByFace& points, ThreadTeam& team);

/// A new vertex on an edge.
struct EdgeSplit {
    float gain;  ///< drop of the sum of squared distances of the points on the edge's two faces
    VertexId a, b;
    Vector3 position;
};

/// The splits of edges that gain at least \p least_gain, in points of weight 1, times the mean of
/// \p variances at the edge's ends (empty: 1), most gain first, by linear least
/// squares over the offset of the new vertex from the middle of its edge, along the mean normal of the edge's
/// faces. The new vertex of a boundary edge also follows the edge's BoundaryTarget, which counts the distance
/// between the boundary and where the points end; such an edge is that of a face (a, b, c). \p surface is
/// that of the network. O(points + vertices).
/// The result does not depend on the number of threads.
std::vector<EdgeSplit> find_splits(const Network& network, const Surface& surface, const PointsByFace& points,
                                   float least_gain, ThreadTeam& team,
                                   const PerVertex<float>& variances = {});

/// A collapse that was carried out.
struct DoneCollapse {
    VertexId gone, into;
};

/// Carries out pairs of a collapse and a split, best first, as long as the split gains more than the collapse
/// costs, at most \p max_pairs. No two operations have a vertex in common, and none has a \p barred one.
/// Topology and number of vertices stay; an inserted vertex usually gets the id of a removed one. \return the
/// collapses, in order; all come before the first split
/// \param collapses of find_collapses() \param splits of find_splits()
std::vector<DoneCollapse> redistribute(Network& network, const std::vector<Collapse>& collapses,
                                       const std::vector<EdgeSplit>& splits, int max_pairs,
                                       const PerVertex<char>& barred);

/// Carries out the best \p splits, at most \p max_count. No two have a corner of their faces in common. The
/// topology stays. \return their number
int insert(Network& network, const std::vector<EdgeSplit>& splits, int max_count);

/// Carries out the cheapest \p collapses, at most \p max_count. No two have a vertex in common, and none has
/// a \p barred one. The topology stays.
std::vector<DoneCollapse> reduce(Network& network, const std::vector<Collapse>& collapses, int max_count,
                                 const PerVertex<char>& barred);

/// The same with more collapses at once: they may have neighbours in common, but none removes a vertex whose
/// faces, or faces beyond its ring, are new. So the cost of each still holds.
std::vector<DoneCollapse> reduce_densely(Network& network, const std::vector<Collapse>& collapses,
                                         int max_count, const PerVertex<char>& barred);

/// Reduces \p network to \p vertices vertices, or more if no other edge may collapse: the edge that sweeps
/// the least squared volume first, to the place where that is least while the enclosed volume stays. Between
/// places that hardly differ, which is on planes and along straight edges, the mean of the neighbours
/// decides. It compares the mesh with itself as it is then, not with the first one.
///
/// Vertices on a boundary and \p barred ones stay as they are. No face turns over or becomes a sliver
/// (kCollapseRules), no valence rises above 12, and the topology stays; faces may cut others. Removed is the
/// end of the edge that is farther from the place.
/// \param short_length shorter edges collapse sooner, by a hundredth of the squared volume short_length^6 at
/// most. \return what was collapsed, in order
/// Source: Lindstrom and Turk, "Fast and memory efficient polygonal simplification" (1998); the cost is their
/// volume optimization. O(vertices log vertices).
std::vector<DoneCollapse> collapse_by_volume(Network& network, int vertices, const PerVertex<char>& barred,
                                             double short_length = 0);

/// Where refine() puts the new vertices.
enum class NewVertices {
    on_edges,  ///< adds no self-intersection
    curved,    ///< the surface curves by the normals at the ends of the edges
    between,   ///< the same, but it curves only where the normals turn by little
};

/// Splits edges of \p network, the longest first, until it has \p vertices vertices or no edge can be
/// split. O(n log n) for every doubling of the vertices. \p progress is asked before each pass. \return the
/// number of vertices inserted
int refine(Network& network, int vertices, NewVertices where, Progress& progress);

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
