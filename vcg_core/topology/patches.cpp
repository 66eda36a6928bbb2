// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/patches.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace neuralmesh {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

int size_of(const Rim& rim) { return static_cast<int>(rim.size()); }

/// A table of n x m values.
template <class T>
class Table {
public:
    Table(int n, int m, T value)
        : m_(m), values_(static_cast<std::size_t>(n) * static_cast<std::size_t>(m), value) {}
    T& operator()(int i, int j) { return values_[static_cast<std::size_t>(i * m_ + j)]; }

private:
    int m_;
    std::vector<T> values_;
};

/// The faces between corners i and j of a polygon, by their indices, from the table of best third corners.
void collect(Table<int>& third, int i, int j, std::vector<Triangle>& faces) {
    if (j - i < 2) return;
    const int k = third(i, j);
    faces.push_back({j, k, i});
    collect(third, i, k, faces);
    collect(third, k, j, faces);
}

/// The triangulation of a polygon of \p n corners with the least sum of \p diagonal(i, j); none if that is
/// kNever.
template <class Diagonal>
std::vector<Triangle> least_triangulation(int n, const Diagonal& diagonal) {
    if (n < 3) return {};
    Table<float> best(n, n, 0.0F);
    Table<int> third(n, n, -1);
    for (int span = 2; span < n; ++span)
        for (int i = 0; i + span < n; ++i) {
            const int j = i + span;
            float least = kNever;
            for (int k = i + 1; k < j; ++k) {
                const float cost = best(i, k) + best(k, j);
                if (cost >= least) continue;
                least = cost;
                third(i, j) = k;
            }
            // The last is a side of the polygon.
            best(i, j) = least + (span + 1 == n ? 0.0F : diagonal(i, j));
        }
    std::vector<Triangle> faces;
    if (best(0, n - 1) < kNever) collect(third, 0, n - 1, faces);
    return faces;
}

std::vector<Triangle> with_vertices(std::vector<Triangle> faces, const Rim& corners) {
    for (Triangle& face : faces)
        for (VertexId& corner : face) corner = corners[static_cast<std::size_t>(corner)];
    return faces;
}

/// Rims made one polygon by bridges, along which it runs there and back.
struct Slit {
    Rim corners;
    std::set<std::pair<VertexId, VertexId>> bridges;
};

/// The shortest bridges between rims, each between corners that have no other.
Slit slit_between(std::vector<Rim> rims, const Edges& edges) {
    Slit slit;
    slit.corners = std::move(rims.front());
    rims.erase(rims.begin());
    std::set<VertexId> used;
    while (!rims.empty()) {
        float least = kNever;
        std::size_t from = 0, rim = 0, to = 0;
        for (std::size_t i = 0; i < slit.corners.size(); ++i) {
            if (used.count(slit.corners[i]) != 0) continue;
            for (std::size_t r = 0; r < rims.size(); ++r)
                for (std::size_t j = 0; j < rims[r].size(); ++j) {
                    const float length = edges.new_edge(slit.corners[i], rims[r][j]);
                    if (length >= least) continue;
                    least = length;
                    from = i, rim = r, to = j;
                }
        }
        if (least == kNever) return {};
        const VertexId a = slit.corners[from], b = rims[rim][to];
        used.insert({a, b});
        slit.bridges.insert(std::minmax(a, b));
        Rim way = std::move(rims[rim]);
        rims.erase(rims.begin() + static_cast<std::ptrdiff_t>(rim));
        std::rotate(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(to), way.end());
        way.insert(way.end(), {b, a});
        slit.corners.insert(slit.corners.begin() + static_cast<std::ptrdiff_t>(from) + 1, way.begin(),
                            way.end());
    }
    return slit;
}

/// A ring of faces between two rims, as steps from one edge between them to the next: 0 along a, 1 along b.
struct Zip {
    float cost = kNever;
    std::vector<char> steps;
};

/// The search for the cheapest steps. A run of steps along one rim makes a fan around a vertex of the other;
/// runs are short, so that no fan goes all around, and valences stay low.
class Zipper {
public:
    /// \p a runs forwards, \p b, already reversed, runs beside it; both return to where they begin.
    Zipper(const Rim& a, const Rim& b, const Edges& edges)
        : a_(a),
          b_(b),
          edges_(edges),
          n_(static_cast<int>(a.size())),
          m_(static_cast<int>(b.size())),
          runs_(longest_run()),
          best_((n_ + 1) * (m_ + 1), 2 * runs_, kNever),
          from_((n_ + 1) * (m_ + 1), 2 * runs_, -1) {}

    Zip best();

private:
    int longest_run() const {
        const int enough = std::max((n_ + m_ - 1) / std::min(n_, m_), 2) + 1;
        return std::min(enough, std::min(n_, m_) - 1);
    }
    int cell(int i, int j) const { return i * (m_ + 1) + j; }
    static VertexId in(const Rim& rim, int i) { return rim[static_cast<std::size_t>(i) % rim.size()]; }
    void reach(int i, int j, int direction);

    const Rim &a_, &b_;
    const Edges& edges_;
    int n_, m_;
    int runs_;           ///< longest run
    Table<float> best_;  ///< by cell, and by direction and length of the last run
    Table<int> from_;    ///< the same of the step before
};

/// The costs of reaching cell (i, j) by a step in \p direction.
void Zipper::reach(int i, int j, int direction) {
    const int before_i = i - (direction == 0 ? 1 : 0), before_j = j - direction;
    if (before_i < 0 || before_j < 0) return;
    const float along = direction == 0 ? edges_.squared_length(in(a_, before_i), in(a_, i))
                                       : edges_.squared_length(in(b_, before_j), in(b_, j));
    const float edge = along + edges_.new_edge(in(a_, i), in(b_, j));
    for (int state = 0; state < 2 * runs_; ++state) {
        const bool goes_on = state / runs_ == direction;
        const int run = goes_on ? state % runs_ + 1 : 0;
        const float cost = best_(cell(before_i, before_j), state) + edge;
        if (run >= runs_ || cost >= best_(cell(i, j), direction * runs_ + run)) continue;
        best_(cell(i, j), direction * runs_ + run) = cost;
        from_(cell(i, j), direction * runs_ + run) = state;
    }
}

Zip Zipper::best() {
    Zip result;
    if (runs_ < 1) return result;
    for (int state = 0; state < 2 * runs_; state += runs_) best_(0, state) = 0;
    for (int i = 0; i <= n_; ++i)
        for (int j = 0; j <= m_; ++j)
            for (int direction = 0; direction < 2; ++direction) reach(i, j, direction);
    int state = 0;
    for (int s = 0; s < 2 * runs_; ++s)
        if (best_(cell(n_, m_), s) < best_(cell(n_, m_), state)) state = s;
    result.cost = best_(cell(n_, m_), state);
    for (int i = n_, j = m_; i + j > 0 && result.cost < kNever;) {
        const int before = from_(cell(i, j), state);
        result.steps.push_back(static_cast<char>(state / runs_));
        (state < runs_ ? i : j) -= 1;
        state = before;
    }
    std::reverse(result.steps.begin(), result.steps.end());
    return result;
}

/// Diagonals of a slit polygon that have the same ends as others, by their corners.
using Pairs = std::set<std::pair<int, int>>;
Pairs repeated(const std::vector<Triangle>& faces, const Rim& corners) {
    std::map<std::pair<VertexId, VertexId>, std::pair<int, int>> known;
    Pairs found;
    for (const Triangle& face : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::pair<int, int> pair = std::minmax(face[k], face[(k + 1) % 3]);
            const VertexId a = corners[static_cast<std::size_t>(pair.first)];
            const VertexId b = corners[static_cast<std::size_t>(pair.second)];
            const bool side = pair.second == pair.first + 1 || pair == std::pair(0, size_of(corners) - 1);
            if (!side && known.emplace(std::minmax(a, b), pair).first->second != pair) found.insert(pair);
        }
    return found;
}

/// Of the diagonals that would have the same ends all but one are forbidden, until there are none.
std::vector<Triangle> triangulate(const Slit& slit, const Edges& edges) {
    const auto at = [&](int i) { return slit.corners[static_cast<std::size_t>(i)]; };
    Pairs forbidden;
    for (;;) {
        const auto faces = least_triangulation(size_of(slit.corners), [&](int i, int j) {
            const bool bridge = slit.bridges.count(std::minmax(at(i), at(j))) != 0;
            const bool possible = at(i) != at(j) && !bridge && forbidden.count({i, j}) == 0;
            return possible ? edges.new_edge(at(i), at(j)) : kNever;
        });
        const Pairs twice = repeated(faces, slit.corners);
        if (twice.empty()) return with_vertices(faces, slit.corners);
        forbidden.insert(twice.begin(), twice.end());
    }
}

/// A ring of faces from \p a to \p b.
std::vector<Triangle> zip(const Rim& a, const Rim& b, const Edges& edges) {
    const auto longest = static_cast<std::size_t>(kLongestRim);
    if (a.size() > longest || b.size() > longest) return {};
    for (const VertexId v : a)
        if (std::find(b.begin(), b.end(), v) != b.end()) return {};
    Zip best;
    Rim best_beside;
    Rim beside(b.rbegin(), b.rend());
    for (std::size_t turn = 0; turn < b.size(); ++turn) {
        Zip next = Zipper(a, beside, edges).best();
        if (next.cost < best.cost) {
            best = std::move(next);
            best_beside = beside;
        }
        std::rotate(beside.begin(), beside.begin() + 1, beside.end());
    }
    std::vector<Triangle> faces;
    std::size_t i = 0, j = 0;
    for (const char step : best.steps) {
        const VertexId p = a[i % a.size()], q = best_beside[j % b.size()];
        if (step == 0) {
            faces.push_back({a[++i % a.size()], p, q});
        } else {
            faces.push_back({p, q, best_beside[++j % b.size()]});
        }
    }
    return faces;
}

}  // namespace

float Edges::squared_length(VertexId a, VertexId b) const {
    return (surface_.positions[a] - surface_.positions[b]).squaredNorm();
}

float Edges::new_edge(VertexId a, VertexId b) const {
    const Span<const int> around = surface_.faces_around(a);
    const auto has_edge = [&](int f) {
        const Triangle& face = surface_.faces[f];
        return left_out_[f] == 0 && std::find(face.begin(), face.end(), b) != face.end();
    };
    const bool exists = network_.adjacent(a, b) && std::any_of(around.begin(), around.end(), has_edge);
    return exists ? kNever : squared_length(a, b);
}

std::vector<Triangle> closing_patches(const std::vector<Rim>& rims, const Edges& edges) {
    std::vector<Triangle> all;
    for (const Rim& rim : rims) {
        if (rim.size() > static_cast<std::size_t>(kLongestRim)) return {};
        const auto at = [&](int i) { return rim[static_cast<std::size_t>(i)]; };
        const auto diagonal = [&](int i, int j) { return edges.new_edge(at(i), at(j)); };
        const std::vector<Triangle> faces = with_vertices(least_triangulation(size_of(rim), diagonal), rim);
        if (faces.empty()) return {};
        all.insert(all.end(), faces.begin(), faces.end());
    }
    return all;
}

std::vector<Triangle> joining_patch(const std::vector<Rim>& rims, const Edges& edges) {
    if (rims.size() == 2) return zip(rims[0], rims[1], edges);
    std::set<VertexId> distinct;
    std::size_t corners = 0;
    for (const Rim& rim : rims) {
        distinct.insert(rim.begin(), rim.end());
        corners += rim.size();
    }
    if (distinct.size() != corners || corners > 2 * static_cast<std::size_t>(kLongestRim)) return {};
    return triangulate(slit_between(rims, edges), edges);
}

}  // namespace neuralmesh
