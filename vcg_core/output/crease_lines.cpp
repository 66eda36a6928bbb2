// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/output/crease_lines.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/learning/two_planes.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

namespace {

using vcg::Point3f;

// Chosen by tests/experiments/paper/crease_table.py.
constexpr float kLongestGap = 2;      ///< that is bridged, in mean edges of the mesh
constexpr float kFarthest = 0.5F;     ///< a place where two planes meet is within so many edges of the vertex
constexpr float kOffMesh = 0.2F;      ///< ... and within so many of the mesh
constexpr float kCornerReach = 1.5F;  ///< from the end of a line to another line that it joins, in mean edges
constexpr float kShortest = 0.5F;     ///< of the edges of lines, in mean edges of the mesh
constexpr float kSharp = 0.8660254F;  ///< cosine of 30 degrees
constexpr float kLeastMeasure = 0.7F;  ///< of both ends of a sharp edge
constexpr float kLeastOfGap = 0.4F;    ///< the same where a gap is bridged
constexpr float kStraight = 0.5F;      ///< cosine of the angle by which a bridge may turn
constexpr int kSpur = 3;               ///< branches of fewer edges are cut
constexpr int kShortLine = 4;          ///< separate lines of fewer edges are cut
constexpr int kLongestDouble = 6;      ///< edges of one of two lines between the same corners, at most
/// A bridge may join two spurs, and what a spur leaves may be bridged.
constexpr int kPasses = 3;

/// A graph over the vertices of a network: the edges of a mesh that lie on creases, while they are chosen. It
/// begins with sharp edges and is tidied step by step until its edges form lines, as crease_lines() says. A
/// line runs from a corner (more than two edges) or end (one edge) to the next.
class CreaseEdges {
public:
    /// Keeps references. \p measure: that of CreaseMeasure.
    CreaseEdges(const Network& network, const FilteredFaces& faces, const PerVertex<float>& measure)
        : network_(network), faces_(faces), measure_(measure), joined_(network.slot_count()) {}

    void add_sharp_edges() {
        for (const VertexId a : network_.vertices())
            for (const VertexId b : network_.ring(a))
                if (a < b && std::min(measure_[a], measure_[b]) >= kLeastMeasure && cosine(a, b) < kSharp)
                    join(a, b);
    }

    /// A face between three sharp edges is a bevel or the tip of a corner: its least sharp edge goes.
    void open_triangles() {
        open_loops_by([this](VertexId v, VertexId u) { return cosine(v, u); });
    }

    /// Goes on from the ends of lines, straight ahead, to another line at most \p reach away.
    void bridge_gaps(float reach) {
        std::vector<VertexId> ends;
        for (const VertexId v : network_.vertices())
            if (degree(v) == 1) ends.push_back(v);
        for (const VertexId end : ends) {
            if (degree(end) != 1) continue;
            const Line path = path_ahead(end, {reach, kLeastOfGap, kStraight});
            for (std::size_t i = 0; i + 1 < path.size(); ++i) join(path[i], path[i + 1]);
        }
    }

    /// Cuts branches of few edges, and separate lines of few edges.
    void drop_spurs() {
        for (const VertexId v : network_.vertices()) {
            if (degree(v) != 1) continue;
            const Line line = line_from(v, joined_[v].front());
            const int least = degree(line.back()) == 1 ? kShortLine : kSpur;
            if (static_cast<int>(line.size()) <= least) cut(line);
        }
    }

    /// Contracts edges shorter than \p least, so that strips of faces along a crease, and zigzags, become one
    /// line. The sharper end stays.
    void contract_below(float least) {
        PerVertex<float> sharpness(network_.slot_count(), 0);
        for (const VertexId v : network_.vertices())
            for (const VertexId u : network_.ring(v))
                if (degree(v) > 0) sharpness[v] += 1 - cosine(v, u);
        bool changed = true;
        while (changed) {
            changed = false;
            for (const VertexId v : network_.vertices()) {
                const VertexId u = joined_before(v, least);
                if (u < 0) continue;
                if (sharpness[u] > sharpness[v]) {
                    contract(v, u);
                } else {
                    contract(u, v);
                }
                changed = true;
            }
        }
    }

    /// Of three edges that form a triangle, cuts the longest.
    void open_loops() {
        open_loops_by([this](VertexId v, VertexId u) { return length(v, u); });
    }

    /// Joins the ends of lines, which may be anywhere beside a corner, to lines at most \p reach away.
    void join_ends(float reach) {
        for (const VertexId end : network_.vertices()) {
            if (degree(end) != 1) continue;
            const Line path = path_ahead(end, {reach, 0, 0});
            if (!path.empty() && !are_joined(end, path.front())) join(end, path.front());
        }
    }

    /// Of two short lines between the same corners, which border a strip of faces, keeps the one of higher
    /// measure.
    void drop_doubles() {
        for (const VertexId v : network_.vertices())
            while (degree(v) > 2 && drop_double_at(v)) {
            }
    }

    int degree(VertexId v) const { return static_cast<int>(joined_[v].size()); }
    /// The other ends of the edges at \p v.
    const std::vector<VertexId>& joined(VertexId v) const { return joined_[v]; }

private:
    using Edge = std::array<VertexId, 2>;
    using Line = std::vector<VertexId>;

    /// How a line may go on from its end: how far, over which vertices, and the cosine of the widest turn.
    struct Search {
        float reach, least_measure, least_cosine;
    };

    /// Of three edges that form a triangle, cuts the one with the largest value(a, b).
    template <class Value>
    void open_loops_by(const Value& value) {
        for (const VertexId a : network_.vertices()) {
            const std::vector<VertexId> around = joined_[a];
            for (const VertexId b : around)
                for (const VertexId c : around) {
                    if (!(a < b && b < c && are_joined(a, b) && are_joined(b, c) && are_joined(c, a)))
                        continue;
                    const std::array<Edge, 3> edges{{{a, b}, {b, c}, {c, a}}};
                    const auto less = [&](const Edge& x, const Edge& y) {
                        return value(x[0], x[1]) < value(y[0], y[1]);
                    };
                    const Edge& largest = *std::max_element(edges.begin(), edges.end(), less);
                    cut(largest[0], largest[1]);
                }
        }
    }

    bool are_joined(VertexId a, VertexId b) const {
        return std::find(joined_[a].begin(), joined_[a].end(), b) != joined_[a].end();
    }

    void join(VertexId a, VertexId b) {
        joined_[a].push_back(b);
        joined_[b].push_back(a);
    }

    void cut(VertexId a, VertexId b) {
        joined_[a].erase(std::find(joined_[a].begin(), joined_[a].end(), b));
        joined_[b].erase(std::find(joined_[b].begin(), joined_[b].end(), a));
    }

    void cut(const Line& line) {
        for (std::size_t i = 0; i + 1 < line.size(); ++i) cut(line[i], line[i + 1]);
    }

    double mean_measure(const Line& line) const {
        double sum = 0;
        for (const VertexId v : line) sum += static_cast<double>(measure_[v]);
        return sum / static_cast<double>(line.size());
    }

    /// Cuts one of two short lines from \p a to the same other corner. \return whether there were two
    bool drop_double_at(VertexId a) {
        std::vector<Line> lines;
        for (const VertexId next : joined_[a]) {
            Line line = line_from(a, next);
            if (static_cast<int>(line.size()) > kLongestDouble + 1) continue;
            for (const Line& other : lines) {
                if (other.back() != line.back()) continue;
                cut(mean_measure(line) < mean_measure(other) ? line : other);
                return true;
            }
            lines.push_back(std::move(line));
        }
        return false;
    }

    /// The first of the vertices joined to \p v that is nearer than \p least, or -1.
    VertexId joined_before(VertexId v, float least) const {
        for (const VertexId u : joined_[v])
            if (length(u, v) < least) return u;
        return -1;
    }

    void contract(VertexId gone, VertexId kept) {
        const std::vector<VertexId> others = joined_[gone];
        for (const VertexId u : others) {
            cut(gone, u);
            if (u != kept && !are_joined(u, kept)) join(u, kept);
        }
    }

    float length(VertexId a, VertexId b) const {
        return (network_.position(b) - network_.position(a)).Norm();
    }

    /// Of the angle between the faces at an edge; 1 on a boundary.
    float cosine(VertexId a, VertexId b) const {
        std::array<int, 2> sides{};
        std::size_t count = 0;
        for (const int f : faces_.around(a))
            if (count < 2 && faces_.has_corner(f, b)) sides[count++] = f;
        return count < 2 ? 1.0F : faces_.normal(sides[0]) * faces_.normal(sides[1]);
    }

    Point3f unit_from(VertexId a, VertexId b) const {
        return unit_or_zero(network_.position(b) - network_.position(a));
    }

    /// Whether \p v lies in the direction in which the line of \p end goes on.
    bool is_ahead(VertexId end, VertexId v, const Search& search) const {
        return v != end && measure_[v] >= search.least_measure &&
               unit_from(joined_[end].front(), end) * unit_from(end, v) > search.least_cosine;
    }

    /// The shortest path over vertices that lie ahead of \p end to one of another line, at most \p reach
    /// long. In reverse order; empty if there is none.
    Line path_ahead(VertexId end, const Search& search) const {
        struct Way {
            float length;
            VertexId before;
        };
        std::map<VertexId, Way> ways{{end, {0, end}}};
        std::set<std::pair<float, VertexId>> frontier{{0.0F, end}};
        while (!frontier.empty()) {
            const auto [distance, v] = *frontier.begin();
            frontier.erase(frontier.begin());
            if (v != end && degree(v) > 0) {
                Line path{v};
                while (path.back() != end) path.push_back(ways.at(path.back()).before);
                return path;
            }
            for (const VertexId u : network_.ring(v)) {
                const float there = distance + length(v, u);
                if (there > search.reach || !is_ahead(end, u, search)) continue;
                const auto [known, is_new] = ways.insert({u, {there, v}});
                if (!is_new && known->second.length <= there) continue;
                frontier.erase({known->second.length, u});
                known->second = {there, v};
                frontier.insert({there, u});
            }
        }
        return {};
    }

    /// From the corner or end \p v over \p next to the next corner or end, both included.
    Line line_from(VertexId v, VertexId next) const {
        Line line{v, next};
        while (degree(line.back()) == 2) {
            const std::vector<VertexId>& two = joined_[line.back()];
            line.push_back(two[0] == line[line.size() - 2] ? two[1] : two[0]);
        }
        return line;
    }

    const Network& network_;
    const FilteredFaces& faces_;
    const PerVertex<float>& measure_;
    PerVertex<std::vector<VertexId>> joined_;
};

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
    const FilteredFaces faces(network, network.positions(), alone);
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
