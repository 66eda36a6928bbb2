// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "shell_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <queue>
#include <utility>

namespace neuralmesh {
namespace {

using vcg::Point3f;

constexpr int kLowestValence = 3, kHighestValence = 12;

/// Kuhn's six tetrahedra of a cube, positively oriented; corner bits: 1 = x, 2 = y, 4 = z.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}, {0, 5, 1, 7}}};

/// Even permutations of a tetrahedron's vertices, by their first one and, for pairs, by the first two.
constexpr std::array<std::array<int, 4>, 4> kVertexFirst = {
    {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}};
constexpr std::array<std::array<int, 4>, 6> kPairFirst = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

/// A lattice edge: seven per node, by the corner bits of its other end.
using EdgeKey = std::uint64_t;

/// Collects triangles whose corners are lattice edges.
class Tetrahedra {
public:
    Tetrahedra(const Lattice& lattice, const std::vector<float>& values)
        : lattice_(lattice), values_(values) {}

    void add_cube(int x, int y, int z);
    IndexedMesh mesh() const;

private:
    void add_tetrahedron(std::size_t node, const std::array<int, 4>& corners, unsigned solid_corners);
    void add_triangle(EdgeKey a, EdgeKey b, EdgeKey c) { keys_.insert(keys_.end(), {a, b, c}); }
    std::size_t offset(int corner) const {
        return lattice_.index(corner & 1, (corner >> 1) & 1, corner >> 2);
    }
    Point3f crossing(EdgeKey key) const;

    const Lattice& lattice_;
    const std::vector<float>& values_;
    std::vector<EdgeKey> keys_;
};

void Tetrahedra::add_cube(int x, int y, int z) {
    const std::size_t node = lattice_.index(x, y, z);
    unsigned solid = 0;
    for (int corner = 0; corner < 8; ++corner)
        if (values_[node + offset(corner)] < 0) solid |= 1U << corner;
    if (solid == 0 || solid == 255) return;
    for (const std::array<int, 4>& corners : kTetrahedra) add_tetrahedron(node, corners, solid);
}

void Tetrahedra::add_tetrahedron(std::size_t node, const std::array<int, 4>& corners,
                                 unsigned solid_corners) {
    const auto corner = [&](int i) { return corners[static_cast<std::size_t>(i)]; };
    const auto solid = [&](int i) { return (solid_corners >> corner(i) & 1U) != 0; };
    // The corner bits of one end of a lattice edge contain those of the other.
    const auto edge = [&](int i, int j) {
        const int low = corner(i) & corner(j), high = corner(i) | corner(j);
        return static_cast<EdgeKey>(node + offset(low)) * 8 + static_cast<EdgeKey>(high - low);
    };
    const int count = solid(0) + solid(1) + solid(2) + solid(3);
    if (count == 1 || count == 3) {
        for (const auto& [p, a, b, c] : kVertexFirst) {
            if (solid(p) != (count == 1)) continue;
            if (count == 1) {
                add_triangle(edge(p, a), edge(p, b), edge(p, c));
            } else {
                add_triangle(edge(p, a), edge(p, c), edge(p, b));
            }
        }
    } else if (count == 2) {
        for (const auto& [i, j, k, l] : kPairFirst) {
            if (!solid(i) || !solid(j)) continue;
            add_triangle(edge(i, k), edge(i, l), edge(j, l));
            add_triangle(edge(i, k), edge(j, l), edge(j, k));
        }
    }
}

Point3f Tetrahedra::crossing(EdgeKey key) const {
    const std::size_t node = static_cast<std::size_t>(key / 8);
    const int corner = static_cast<int>(key % 8);
    const std::size_t nx = static_cast<std::size_t>(lattice_.nx), ny = static_cast<std::size_t>(lattice_.ny);
    const Point3f start = lattice_.position(static_cast<int>(node % nx), static_cast<int>(node / nx % ny),
                                            static_cast<int>(node / nx / ny));
    const Point3f along(static_cast<float>(corner & 1), static_cast<float>((corner >> 1) & 1),
                        static_cast<float>(corner >> 2));
    const float a = values_[node], b = values_[node + offset(corner)];
    const float t = std::min(0.9F, std::max(0.1F, a / (a - b)));  // away from the nodes: no degenerate faces
    return start + along * (t * lattice_.step);
}

IndexedMesh Tetrahedra::mesh() const {
    std::vector<EdgeKey> unique = keys_;
    std::sort(unique.begin(), unique.end());
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    IndexedMesh result;
    for (const EdgeKey key : unique) result.positions.push_back(crossing(key));
    const auto id = [&](EdgeKey key) {
        return static_cast<VertexId>(std::lower_bound(unique.begin(), unique.end(), key) - unique.begin());
    };
    for (std::size_t i = 0; i < keys_.size(); i += 3)
        result.faces.push_back({id(keys_[i]), id(keys_[i + 1]), id(keys_[i + 2])});
    return result;
}

Point3f normal_of(const Point3f& a, const Point3f& b, const Point3f& c) { return (b - a) ^ (c - a); }

/// Would moving \p v to \p where turn over a face at v that does not contain \p except, or make it a sliver?
bool folds(const Network& net, VertexId v, const Point3f& where, VertexId except) {
    const Ring& ring = net.ring(v);
    for (int i = 0; i < ring.valence; ++i) {
        const VertexId a = ring[i], b = ring.next(i);
        if (a == except || b == except) continue;
        const Point3f pa = net.position(a), pb = net.position(b);
        const Point3f before = normal_of(net.position(v), pa, pb), after = normal_of(where, pa, pb);
        const float product = before * after;
        if (product <= 0 || product * product < 0.1F * before.SquaredNorm() * after.SquaredNorm())
            return true;
    }
    return false;
}

/// A half-edge collapse that waits for its turn.
struct Candidate {
    float squared_length;
    VertexId gone, kept;

    /// The shortest comes first; ties are broken by ids, so that the order never depends on the heap.
    bool operator<(const Candidate& other) const {
        if (squared_length != other.squared_length) return squared_length > other.squared_length;
        return std::pair(gone, kept) > std::pair(other.gone, other.kept);
    }
};

using Queue = std::priority_queue<Candidate>;

void push_edges_of(const Network& net, VertexId v, Queue& queue) {
    const Ring& ring = net.ring(v);
    for (int i = 0; i < ring.valence; ++i) {
        const float length = (net.position(v) - net.position(ring[i])).SquaredNorm();
        queue.push({length, v, ring[i]});
        queue.push({length, ring[i], v});
    }
}

bool keeps_valences(const Network& net, VertexId gone, VertexId kept) {
    return net.ring(gone).valence + net.ring(kept).valence - 4 <= kHighestValence - 2;
}

bool may_collapse(const Network& net, VertexId gone, VertexId kept, bool careful) {
    return keeps_valences(net, gone, kept) && net.can_collapse(gone, kept) &&
           !(careful && folds(net, gone, net.position(kept), kept));
}

/// Sweeps over the vertices, each time collapsing what is shorter than a growing bound: the quick way to a
/// mesh of at least \p vertices from one of many more. O(vertices) per sweep.
void collapse_in_sweeps(Network& net, int vertices, float squared_bound) {
    constexpr int kSweeps = 24;
    for (int sweep = 0; sweep < kSweeps && net.vertex_count() > vertices; ++sweep, squared_bound *= 1.5F)
        for (VertexId v = 0; v < net.slot_count() && net.vertex_count() > vertices; ++v) {
            if (!net.alive(v)) continue;
            const Ring& ring = net.ring(v);
            for (int i = 0; i < ring.valence; ++i) {
                if ((net.position(v) - net.position(ring[i])).SquaredNorm() > squared_bound) continue;
                if (!may_collapse(net, v, ring[i], true)) continue;
                net.collapse(v, ring[i]);
                break;
            }
        }
}

float mean_squared_length(const Network& net) {
    double sum = 0, count = 0;
    for (VertexId v = 0; v < net.slot_count(); ++v)
        for (int i = 0; i < net.ring(v).valence; ++i, ++count)
            sum += static_cast<double>((net.position(v) - net.position(net.ring(v)[i])).SquaredNorm());
    return static_cast<float>(sum / count);
}

/// Collapses in order of length. \p careful: no face may turn over.
void collapse_to(Network& net, int vertices, bool careful) {
    Queue queue;
    for (VertexId v = 0; v < net.slot_count(); ++v) {
        if (!net.alive(v)) continue;
        const Ring& ring = net.ring(v);
        for (int i = 0; i < ring.valence; ++i)
            queue.push({(net.position(v) - net.position(ring[i])).SquaredNorm(), v, ring[i]});
    }
    while (net.vertex_count() > vertices && !queue.empty()) {
        const auto [length, gone, kept] = queue.top();
        queue.pop();
        if (!net.alive(gone) || !net.adjacent(gone, kept)) continue;
        if (!may_collapse(net, gone, kept, careful)) continue;
        net.collapse(gone, kept);
        push_edges_of(net, kept, queue);
    }
}

int valence_cost(int valence) { return (valence - 6) * (valence - 6); }

/// Flips the edges whose flip brings the four valences around it closer to 6 and folds nothing.
int flip_for_valence(Network& net) {
    int flips = 0;
    for (VertexId a = 0; a < net.slot_count(); ++a)
        for (int i = 0; net.alive(a) && i < net.ring(a).valence; ++i) {
            const Ring& ring = net.ring(a);
            const VertexId b = ring[i], c = ring.next(i), d = ring.previous(i);
            if (b < a || !net.can_flip(a, b)) continue;
            const int va = ring.valence, vb = net.ring(b).valence, vc = net.ring(c).valence,
                      vd = net.ring(d).valence;
            const int before = valence_cost(va) + valence_cost(vb) + valence_cost(vc) + valence_cost(vd);
            const int after =
                valence_cost(va - 1) + valence_cost(vb - 1) + valence_cost(vc + 1) + valence_cost(vd + 1);
            if (after >= before || vc + 1 > kHighestValence || vd + 1 > kHighestValence) continue;
            if (va - 1 < kLowestValence || vb - 1 < kLowestValence) continue;
            const Point3f pa = net.position(a), pb = net.position(b), pc = net.position(c),
                          pd = net.position(d);
            const Point3f n1 = normal_of(pa, pb, pc), n2 = normal_of(pb, pa, pd);
            const Point3f m1 = normal_of(pa, pd, pc), m2 = normal_of(pb, pc, pd);
            const Point3f n = n1 + n2;
            const auto faces_along = [&](const Point3f& m) {
                const float product = m * n;
                return product > 0 && product * product > 0.5F * m.SquaredNorm() * n.SquaredNorm();
            };
            if (!faces_along(m1) || !faces_along(m2)) continue;
            net.flip(a, b);
            ++flips;
        }
    return flips;
}

/// Moves every vertex halfway to the mean of its neighbours, along the surface.
void smooth_tangentially(Network& net) {
    for (VertexId v = 0; v < net.slot_count(); ++v) {
        if (!net.alive(v)) continue;
        const Ring& ring = net.ring(v);
        const Point3f p = net.position(v);
        Point3f mean(0, 0, 0), normal(0, 0, 0);
        for (int i = 0; i < ring.valence; ++i) {
            mean += net.position(ring[i]);
            normal += normal_of(p, net.position(ring[i]), net.position(ring.next(i)));
        }
        const float squared = normal.SquaredNorm();
        if (!(squared > 0)) continue;
        Point3f move = mean / static_cast<float>(ring.valence) - p;
        move -= normal * (move * normal / squared);
        const Point3f where = p + move * 0.5F;
        if (!folds(net, v, where, -1)) net.set_position(v, where);
    }
}

}  // namespace

IndexedMesh marching_tetrahedra(const Lattice& lattice, const std::vector<float>& values) {
    Tetrahedra tetrahedra(lattice, values);
    for (int z = 0; z + 1 < lattice.nz; ++z)
        for (int y = 0; y + 1 < lattice.ny; ++y)
            for (int x = 0; x + 1 < lattice.nx; ++x) tetrahedra.add_cube(x, y, z);
    return tetrahedra.mesh();
}

void simplify(Network& network, int vertices) {
    constexpr int kRounds = 3, kSweepAbove = 6;
    if (network.vertex_count() > kSweepAbove * vertices) {
        collapse_in_sweeps(network, kSweepAbove * vertices, 0.5F * mean_squared_length(network));
        flip_for_valence(network);
        smooth_tangentially(network);
    }
    for (int i = 0; i < kRounds && network.vertex_count() > vertices; ++i) {
        // Evening makes room for collapses that would have folded something.
        collapse_to(network, vertices, true);
        flip_for_valence(network);
        smooth_tangentially(network);
    }
    if (network.vertex_count() > vertices) collapse_to(network, vertices, false);
    for (int i = 0; i < kRounds; ++i) {
        flip_for_valence(network);
        smooth_tangentially(network);
    }
}

}  // namespace neuralmesh
