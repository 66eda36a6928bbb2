// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/output/crease_lines.h"

#include <algorithm>
#include <set>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/learning/two_planes.h"
#include "vcg_core/mesh/surface.h"
#include "vcg_core/output/crease_edges.h"

namespace neuralmesh {

namespace {

using vcg::Point3f;

// Chosen by tests/experiments/paper/crease_table.py.
constexpr float kLongestGap = 2;      ///< that is bridged, in mean edges of the mesh
constexpr float kFarthest = 0.5F;     ///< a place where two planes meet is within so many edges of the vertex
constexpr float kOffMesh = 0.2F;      ///< ... and within so many of the mesh
constexpr float kCornerReach = 1.5F;  ///< from the end of a line to another line that it joins, in mean edges
constexpr float kShortest = 0.5F;     ///< of the edges of lines, in mean edges of the mesh
/// A bridge may join two spurs, and what a spur leaves may be bridged.
constexpr int kPasses = 3;

/// How many lines have neither corners nor ends.
int closed_lines(const CreaseEdges& chosen, const CreaseGraph& graph) {
    DisjointSets parts(static_cast<int>(graph.vertices.size()));
    for (const auto& [i, j] : graph.edges) parts.join(i, j);
    std::set<int> all, ended;
    for (int i = 0; i < static_cast<int>(graph.vertices.size()); ++i)
        (chosen.degree(graph.vertices[at(i)]) == 2 ? all : ended).insert(parts.find(i));
    return static_cast<int>(
        std::count_if(all.begin(), all.end(), [&](int part) { return ended.count(part) == 0; }));
}

/// The place of \p v on the line where two planes meet, if that is near and no farther from the mesh than
/// noise would bring it. Where the smoothed normals tilt the planes, they meet off the mesh.
Point3f place_on_line(const Network& network, const Surface& surface, TwoPlanes& planes, VertexId v) {
    const Point3f p = network.position(v);
    const float edge = mean_edge_at(network, v);
    const Crease crease = planes.crease_near(p, edge, v);
    const Point3f place = p + crease.to_line;
    const float most = kOffMesh * edge;
    const bool is_near =
        crease.squared_distance < kFarthest * kFarthest &&
        squared_distance_from(surface, surface.faces_around(v), to_eigen(place)) < most * most;
    return is_near ? place : p;
}

}  // namespace

CreaseGraph crease_lines(const Network& network, const PerVertex<float>& measure) {
    ThreadTeam alone(1);
    const FilteredFaces faces(network, alone);
    CreaseEdges chosen(network, faces, measure);
    chosen.add_sharp_edges();
    chosen.open_triangles();
    const Surface surface(network);
    const float edge = mean_edge_length(surface);
    for (int pass = 0; pass < kPasses; ++pass) {
        chosen.bridge_gaps(kLongestGap * edge);
        chosen.drop_spurs();
    }
    chosen.contract_below(kShortest * edge);
    chosen.open_loops();
    chosen.join_ends(kCornerReach * edge);
    for (int pass = 0; pass < kPasses; ++pass) {
        chosen.drop_doubles();
        chosen.drop_spurs();
    }

    CreaseGraph graph;
    TwoPlanes planes(network, faces);
    PerVertex<int> index(network.slot_count(), -1);
    int ends = 0;  // of lines: each edge at a corner or end is the end of a line
    for (const VertexId v : network.vertices()) {
        if (chosen.degree(v) == 0) continue;
        index[v] = static_cast<int>(graph.vertices.size());
        graph.vertices.push_back(v);
        const bool inner = chosen.degree(v) == 2;
        graph.positions.push_back(inner ? place_on_line(network, surface, planes, v) : network.position(v));
        if (!inner) ends += chosen.degree(v);
        if (chosen.degree(v) > 2) ++graph.corners;
    }
    for (const VertexId v : graph.vertices)
        for (const VertexId u : chosen.joined(v))
            if (v < u) graph.edges.push_back({index[v], index[u]});
    std::sort(graph.edges.begin(), graph.edges.end());
    graph.lines = ends / 2 + closed_lines(chosen, graph);
    return graph;
}

}  // namespace neuralmesh
