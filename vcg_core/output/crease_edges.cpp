// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/output/crease_edges.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace neuralmesh {

namespace {

using vcg::Point3f;

// Chosen by tests/experiments/paper/crease_table.py.
constexpr float kSharp = 0.8660254F;   ///< cosine of 30 degrees
constexpr float kLeastMeasure = 0.7F;  ///< of both ends of a sharp edge
constexpr float kLeastOfGap = 0.4F;    ///< the same where a gap is bridged
constexpr float kStraight = 0.5F;      ///< cosine of the angle by which a bridge may turn
constexpr int kSpur = 3;               ///< branches of fewer edges are cut
constexpr int kShortLine = 4;          ///< separate lines of fewer edges are cut
constexpr int kLongestDouble = 6;      ///< edges of one of two lines between the same corners, at most

}  // namespace

/// Of three edges that form a triangle, cuts the one with the largest value(a, b).
template <class Value>
void CreaseEdges::open_loops_by(const Value& value) {
    for (const VertexId a : network_.vertices()) {
        const std::vector<VertexId> around = joined_[a];
        for (const VertexId b : around)
            for (const VertexId c : around) {
                if (!(a < b && b < c && are_joined(a, b) && are_joined(b, c) && are_joined(c, a))) continue;
                const std::array<Edge, 3> edges{{{a, b}, {b, c}, {c, a}}};
                const auto less = [&](const Edge& x, const Edge& y) {
                    return value(x[0], x[1]) < value(y[0], y[1]);
                };
                const Edge& largest = *std::max_element(edges.begin(), edges.end(), less);
                cut(largest[0], largest[1]);
            }
    }
}

void CreaseEdges::add_sharp_edges() {
    for (const VertexId a : network_.vertices())
        for (const VertexId b : network_.ring(a))
            if (a < b && std::min(measure_[a], measure_[b]) >= kLeastMeasure && cosine(a, b) < kSharp)
                join(a, b);
}

void CreaseEdges::open_triangles() {
    open_loops_by([this](VertexId v, VertexId u) { return cosine(v, u); });
}

void CreaseEdges::bridge_gaps(float reach) {
    std::vector<VertexId> ends;
    for (const VertexId v : network_.vertices())
        if (degree(v) == 1) ends.push_back(v);
    for (const VertexId end : ends) {
        if (degree(end) != 1) continue;
        const std::vector<VertexId> path = path_ahead(end, {reach, kLeastOfGap, kStraight});
        for (std::size_t i = 0; i + 1 < path.size(); ++i) join(path[i], path[i + 1]);
    }
}

void CreaseEdges::drop_spurs() {
    for (const VertexId v : network_.vertices()) {
        if (degree(v) != 1) continue;
        const std::vector<VertexId> line = line_from(v, joined_[v].front());
        const int least = degree(line.back()) == 1 ? kShortLine : kSpur;
        if (static_cast<int>(line.size()) <= least) cut(line);
    }
}

void CreaseEdges::contract_below(float least) {
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

void CreaseEdges::open_loops() {
    open_loops_by([this](VertexId v, VertexId u) { return length(v, u); });
}

void CreaseEdges::join_ends(float reach) {
    for (const VertexId end : network_.vertices()) {
        if (degree(end) != 1) continue;
        const std::vector<VertexId> path = path_ahead(end, {reach, 0, 0});
        if (!path.empty() && !are_joined(end, path.front())) join(end, path.front());
    }
}

void CreaseEdges::drop_doubles() {
    for (const VertexId v : network_.vertices())
        while (degree(v) > 2 && drop_double_at(v)) {
        }
}

bool CreaseEdges::are_joined(VertexId a, VertexId b) const {
    return std::find(joined_[a].begin(), joined_[a].end(), b) != joined_[a].end();
}

void CreaseEdges::join(VertexId a, VertexId b) {
    joined_[a].push_back(b);
    joined_[b].push_back(a);
}

void CreaseEdges::cut(VertexId a, VertexId b) {
    joined_[a].erase(std::find(joined_[a].begin(), joined_[a].end(), b));
    joined_[b].erase(std::find(joined_[b].begin(), joined_[b].end(), a));
}

void CreaseEdges::cut(const std::vector<VertexId>& line) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) cut(line[i], line[i + 1]);
}

double CreaseEdges::mean_measure(const std::vector<VertexId>& line) const {
    double sum = 0;
    for (const VertexId v : line) sum += static_cast<double>(measure_[v]);
    return sum / static_cast<double>(line.size());
}

/// Cuts one of two short lines from \p a to the same other corner. \return whether there were two
bool CreaseEdges::drop_double_at(VertexId a) {
    std::vector<std::vector<VertexId>> lines;
    for (const VertexId next : joined_[a]) {
        std::vector<VertexId> line = line_from(a, next);
        if (static_cast<int>(line.size()) > kLongestDouble + 1) continue;
        for (const std::vector<VertexId>& other : lines) {
            if (other.back() != line.back()) continue;
            cut(mean_measure(line) < mean_measure(other) ? line : other);
            return true;
        }
        lines.push_back(std::move(line));
    }
    return false;
}

/// The first of the vertices joined to \p v that is nearer than \p least, or -1.
VertexId CreaseEdges::joined_before(VertexId v, float least) const {
    for (const VertexId u : joined_[v])
        if (length(u, v) < least) return u;
    return -1;
}

void CreaseEdges::contract(VertexId gone, VertexId kept) {
    const std::vector<VertexId> others = joined_[gone];
    for (const VertexId u : others) {
        cut(gone, u);
        if (u != kept && !are_joined(u, kept)) join(u, kept);
    }
}

float CreaseEdges::length(VertexId a, VertexId b) const {
    return (network_.position(b) - network_.position(a)).Norm();
}

/// Of the angle between the faces at an edge; 1 on a boundary.
float CreaseEdges::cosine(VertexId a, VertexId b) const {
    std::array<int, 2> sides{};
    std::size_t count = 0;
    for (const int f : faces_.around(a))
        if (count < 2 && faces_.has_corner(f, b)) sides[count++] = f;
    return count < 2 ? 1.0F : faces_.normal(sides[0]) * faces_.normal(sides[1]);
}

Point3f CreaseEdges::unit_from(VertexId a, VertexId b) const {
    return unit_or_zero(network_.position(b) - network_.position(a));
}

/// Whether \p v lies in the direction in which the line of \p end goes on.
bool CreaseEdges::is_ahead(VertexId end, VertexId v, const Search& search) const {
    return v != end && measure_[v] >= search.least_measure &&
           unit_from(joined_[end].front(), end) * unit_from(end, v) > search.least_cosine;
}

/// The shortest path over vertices that lie ahead of \p end to one of another line, at most \p reach
/// long. In reverse order; empty if there is none.
CreaseEdges::Line CreaseEdges::path_ahead(VertexId end, const Search& search) const {
    std::map<VertexId, VertexId> parents{{end, end}};
    std::set<std::pair<float, VertexId>> frontier{{0.0F, end}};
    std::map<VertexId, float> distances{{end, 0.0F}};
    while (!frontier.empty()) {
        const auto [distance, v] = *frontier.begin();
        frontier.erase(frontier.begin());
        if (v != end && degree(v) > 0) {
            std::vector<VertexId> path{v};
            while (path.back() != end) path.push_back(parents.at(path.back()));
            return path;
        }
        for (const VertexId u : network_.ring(v)) {
            const float there = distance + length(v, u);
            if (there > search.reach || !is_ahead(end, u, search)) continue;
            const auto known = distances.find(u);
            if (known != distances.end() && known->second <= there) continue;
            if (known != distances.end()) frontier.erase({known->second, u});
            distances[u] = there;
            parents[u] = v;
            frontier.insert({there, u});
        }
    }
    return {};
}

/// From the corner or end \p v over \p next to the next corner or end, both included.
CreaseEdges::Line CreaseEdges::line_from(VertexId v, VertexId next) const {
    std::vector<VertexId> line{v, next};
    while (degree(line.back()) == 2) {
        const std::vector<VertexId>& two = joined_[line.back()];
        line.push_back(two[0] == line[line.size() - 2] ? two[1] : two[0]);
    }
    return line;
}

}  // namespace neuralmesh
