// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A spanning tree of the vertices and one of the faces that crosses none of its edges leave two edges for
// each handle; each closes a loop along the first tree that separates nothing (Eppstein, "Dynamic generators
// of topologically embedded graphs", 2003). With a tree of shortest ways from a vertex, and a tree of faces
// that takes the edges with the longest loops first, these are the shortest loops through the vertex
// (Erickson and Whittlesey, "Greedy optimal homotopy and homology generators", 2005).
#include "vcg_core/start/short_handles.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/indexed.h"
#include "vcg_core/mesh/boundary_loops.h"
#include "vcg_core/mesh/non_manifold_vertices.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {
namespace {

/// Roots that are tried in all.
constexpr int kMostRoots = 200;

/// An edge, with the faces, or holes, on its two sides.
struct Edge {
    int a, b;
    int left = -1, right = -1;
};

struct Graph {
    std::vector<Edge> edges;
    std::vector<std::vector<int>> at_vertex;  ///< edges
    int sides = 0;                            ///< faces and holes
};

/// Holes count as faces, so that a loop around one separates.
Graph graph_of(const IndexedMesh<float>& mesh) {
    struct HalfEdge {
        int low, high, side;
        bool forward;
    };
    Graph graph;
    std::vector<HalfEdge> halves;
    const auto add = [&](int a, int b) {
        halves.push_back({std::min(a, b), std::max(a, b), graph.sides, a < b});
    };
    for (const Triangle& f : mesh.faces) {
        for (std::size_t k = 0; k < 3; ++k) add(f[k], f[(k + 1) % 3]);
        ++graph.sides;
    }
    for (const auto& loop : boundary_loops(static_cast<int>(mesh.positions.size()), mesh.faces)) {
        for (std::size_t i = 0; i < loop.size(); ++i) add(loop[(i + 1) % loop.size()], loop[i]);
        ++graph.sides;
    }
    std::sort(halves.begin(), halves.end(), [](const HalfEdge& x, const HalfEdge& y) {
        return std::tie(x.low, x.high, x.forward) < std::tie(y.low, y.high, y.forward);
    });
    graph.at_vertex.resize(mesh.positions.size());
    for (std::size_t i = 0; i + 1 < halves.size(); i += 2) {
        for (const int v : {halves[i].low, halves[i].high})
            graph.at_vertex[at(v)].push_back(static_cast<int>(graph.edges.size()));
        graph.edges.push_back({halves[i].low, halves[i].high, halves[i].side, halves[i + 1].side});
    }
    return graph;
}

/// Shortest ways, in edges, from a vertex.
struct Ways {
    std::vector<int> length, by;  ///< edge that leads to each vertex; -1: none

    Ways(const Graph& graph, int root) : length(graph.at_vertex.size(), -1), by(length) {
        std::vector<int> queue{root};
        length[at(root)] = 0;
        for (std::size_t i = 0; i < queue.size(); ++i)
            for (const int e : graph.at_vertex[at(queue[i])]) {
                const Edge& edge = graph.edges[at(e)];
                const int other = edge.a == queue[i] ? edge.b : edge.a;
                if (length[at(other)] >= 0) continue;
                length[at(other)] = length[at(queue[i])] + 1;
                by[at(other)] = e;
                queue.push_back(other);
            }
    }
    void trace(const Graph& graph, int v, std::vector<int>& vertices) const {
        for (; by[at(v)] >= 0;) {
            vertices.push_back(v);
            const Edge& edge = graph.edges[at(by[at(v)])];
            v = edge.a == v ? edge.b : edge.a;
        }
        vertices.push_back(v);
    }
};

struct Loop {
    int length = std::numeric_limits<int>::max();
    std::vector<int> vertices;
};

/// The edges that close loops through \p root around all handles of its component, shortest loops last.
std::vector<int> generators(const Graph& graph, const Ways& ways) {
    std::vector<std::vector<int>> by_length;
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
        const Edge& edge = graph.edges[e];
        if (ways.length[at(edge.a)] < 0) continue;
        const int i = static_cast<int>(e);
        if (ways.by[at(edge.a)] == i || ways.by[at(edge.b)] == i) continue;
        const std::size_t length = at(ways.length[at(edge.a)] + ways.length[at(edge.b)] + 1);
        if (by_length.size() <= length) by_length.resize(length + 1);
        by_length[length].push_back(i);
    }
    DisjointSets sides(graph.sides);
    std::vector<int> left;
    for (auto edges = by_length.rbegin(); edges != by_length.rend(); ++edges)
        for (const int e : *edges)
            if (!sides.join(graph.edges[at(e)].left, graph.edges[at(e)].right)) left.push_back(e);
    return left;
}

/// The shortest loop through \p root, and the ends of the edges of the others as further \p roots.
Loop shortest_loop(const Graph& graph, int root, std::vector<int>* roots) {
    const Ways ways(graph, root);
    const std::vector<int> edges = generators(graph, ways);
    Loop loop;
    if (edges.empty()) return loop;
    const Edge& edge = graph.edges[at(edges.back())];
    loop.length = ways.length[at(edge.a)] + ways.length[at(edge.b)] + 1;
    ways.trace(graph, edge.a, loop.vertices);
    ways.trace(graph, edge.b, loop.vertices);
    if (roots != nullptr)
        for (auto e = edges.rbegin(); e != edges.rend(); ++e) roots->push_back(graph.edges[at(*e)].a);
    return loop;
}

/// A loop of at most \p most edges, or none. \p budget: of roots
Loop short_loop(const Graph& graph, int most, int& budget) {
    Loop best;
    std::vector<char> seen(graph.at_vertex.size(), 0);
    for (std::size_t v = 0; v < seen.size() && budget > 0; ++v) {
        if (seen[v] != 0 || graph.at_vertex[v].empty()) continue;
        std::vector<int> component{static_cast<int>(v)};  // one root for each
        seen[v] = 1;
        for (std::size_t i = 0; i < component.size(); ++i)
            for (const int e : graph.at_vertex[at(component[i])])
                for (const int other : {graph.edges[at(e)].a, graph.edges[at(e)].b})
                    if (seen[at(other)] == 0) {
                        seen[at(other)] = 1;
                        component.push_back(other);
                    }
        std::vector<int> roots{static_cast<int>(v)};
        for (std::size_t i = 0; i < roots.size() && budget-- > 0; ++i) {
            Loop loop = shortest_loop(graph, roots[i], i == 0 ? &roots : nullptr);
            if (loop.length < best.length) best = std::move(loop);
            if (best.length <= most) return best;
        }
    }
    return best.length <= most ? best : Loop();
}

void remove_faces_at(const std::vector<int>& vertices, IndexedMesh<float>& mesh, std::vector<int>& source) {
    std::vector<char> gone(mesh.positions.size(), 0);
    for (const int v : vertices) gone[at(v)] = 1;
    std::vector<Triangle>& faces = mesh.faces;
    faces.erase(std::remove_if(faces.begin(), faces.end(),
                               [&](const Triangle& f) {
                                   return std::any_of(f.begin(), f.end(),
                                                      [&](int v) { return gone[at(v)] != 0; });
                               }),
                faces.end());
    split_non_manifold_vertices(mesh, source);
    drop_unused_vertices(mesh, source);
}

}  // namespace

int cut_short_handles(IndexedMesh<float>& mesh, int edges, std::vector<int>& source) {
    if (skips("short_handles")) return 0;
    int cut = 0;
    for (int budget = kMostRoots; budget > 0;) {
        const Loop loop = short_loop(graph_of(mesh), edges, budget);
        if (loop.vertices.empty()) break;
        remove_faces_at(loop.vertices, mesh, source);
        ++cut;
    }
    return cut;
}

}  // namespace neuralmesh
