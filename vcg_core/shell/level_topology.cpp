// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Squared distances, floods and counts on the lattice.
#include "vcg_core/shell/level_topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace neuralmesh {
namespace {

int nodes_along(float extent, float step, int margin) {
    return static_cast<int>(std::ceil(static_cast<double>(extent) / static_cast<double>(step))) + 1 +
           2 * margin;
}

/// Squared distances along x: two sweeps per row.
void distances_along_rows(const Lattice& lattice, const std::vector<std::uint32_t>& occupied, int reach,
                          std::vector<SquaredRadius>& out) {
    const int far = reach + 1;
    const std::size_t nx = static_cast<std::size_t>(lattice.nx);
    const SquaredRadius far_level = static_cast<SquaredRadius>(reach * reach + 1);
    for (std::size_t row = 0; row < lattice.size(); row += nx) {
        int d = far;
        for (std::size_t i = row; i < row + nx; ++i) {
            d = occupied[i] != 0 ? 0 : std::min(d + 1, far);
            out[i] = static_cast<SquaredRadius>(d);
        }
        d = far;
        for (std::size_t i = row + nx; i-- > row;) {
            d = occupied[i] != 0 ? 0 : std::min(d + 1, far);
            const int best = std::min<int>(d, out[i]);
            out[i] = best > reach ? far_level : static_cast<SquaredRadius>(best * best);
        }
    }
}

/// out[row][x] = min over |k| <= reach of in[row + k * stride][x] + k^2, for \p count rows \p stride apart.
/// \p scratch holds the column of rows.
void lower_envelope(SquaredRadius* first, int count, std::size_t stride, int width, int reach,
                    std::vector<SquaredRadius>& scratch) {
    const std::size_t w = static_cast<std::size_t>(width);
    scratch.resize(static_cast<std::size_t>(count) * w);
    for (int i = 0; i < count; ++i)
        std::copy_n(first + static_cast<std::size_t>(i) * stride, w,
                    scratch.data() + static_cast<std::size_t>(i) * w);
    for (int i = 0; i < count; ++i) {
        SquaredRadius* out = first + static_cast<std::size_t>(i) * stride;
        for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); ++j) {
            const SquaredRadius* in = scratch.data() + static_cast<std::size_t>(j) * w;
            const SquaredRadius add = static_cast<SquaredRadius>((i - j) * (i - j));
            for (std::size_t x = 0; x < w; ++x) {
                const SquaredRadius candidate = static_cast<SquaredRadius>(in[x] + add);
                out[x] = candidate < out[x] ? candidate : out[x];
            }
        }
    }
}

/// Union-find over nodes, with the number of points in each set.
class Components {
public:
    explicit Components(const std::vector<std::uint32_t>& counts)
        : parent_(counts.size(), -1), points_(counts) {}

    bool contains(std::size_t i) const { return parent_[i] >= 0; }
    void add(std::size_t i) { parent_[i] = static_cast<std::int32_t>(i); }
    std::uint32_t points(std::size_t root) const { return points_[root]; }
    std::size_t find(std::size_t i) {
        while (parent_[i] != static_cast<std::int32_t>(i)) {
            parent_[i] = parent_[static_cast<std::size_t>(parent_[i])];
            i = static_cast<std::size_t>(parent_[i]);
        }
        return i;
    }
    void join(std::size_t a, std::size_t b) {
        parent_[std::max(a, b)] = static_cast<std::int32_t>(std::min(a, b));
        points_[std::min(a, b)] += points_[std::max(a, b)];
    }

private:
    std::vector<std::int32_t> parent_;
    std::vector<std::uint32_t> points_;
};

/// Adds to changes[l] by how much the Euler characteristic grows when the solid grows to level l.
void add_euler_changes(const Lattice& lattice, const std::vector<SquaredRadius>& clearance,
                       std::vector<int>& changes) {
    const SquaredRadius far = static_cast<SquaredRadius>(changes.size() - 1);
    for (int z = 0; z < lattice.nz; ++z)
        for (int y = 0; y < lattice.ny; ++y)
            for (int x = 0; x < lattice.nx; ++x) {
                std::array<SquaredRadius, 8> c;  // corner bits: 1 = x, 2 = y, 4 = z
                SquaredRadius low = far, high = 0;
                for (int k = 0; k < 8; ++k) {
                    const int dx = k & 1, dy = (k >> 1) & 1, dz = k >> 2;
                    const SquaredRadius value = in_box(lattice, x, y, z, dx, dy, dz)
                                                    ? clearance[lattice.index(x + dx, y + dy, z + dz)]
                                                    : far;
                    c[static_cast<std::size_t>(k)] = value;
                    low = std::min(low, value);
                    high = std::max(high, value);
                }
                if (low == high) continue;  // the simplices of one node cancel out: 1 - 7 + 12 - 6
                // All chains 0 < a < b < 7 of corner bits: the simplices whose lowest corner is this node.
                ++changes[static_cast<std::size_t>(c[0])];
                for (int a = 1; a < 8; ++a) {
                    const SquaredRadius ca = std::max(c[0], c[static_cast<std::size_t>(a)]);
                    --changes[static_cast<std::size_t>(ca)];
                    for (int b = a + 1; b < 8; ++b) {
                        if ((a & b) != a) continue;
                        const SquaredRadius cb = std::max(ca, c[static_cast<std::size_t>(b)]);
                        ++changes[static_cast<std::size_t>(cb)];
                        if (b != 7) --changes[static_cast<std::size_t>(std::max(cb, c[7]))];
                    }
                }
            }
}

}  // namespace

Lattice::Lattice(const vcg::Box3f& box, float node_step, int margin)
    : nx(nodes_along(box.DimX(), node_step, margin)),
      ny(nodes_along(box.DimY(), node_step, margin)),
      nz(nodes_along(box.DimZ(), node_step, margin)),
      step(node_step) {
    const vcg::Point3f extent(static_cast<float>(nx - 1), static_cast<float>(ny - 1),
                              static_cast<float>(nz - 1));
    origin = box.Center() - extent * (step * 0.5F);
}

std::size_t Lattice::node_of(const vcg::Point3f& p) const {
    const vcg::Point3f q = (p - origin) * (1.0F / step) + vcg::Point3f(0.5F, 0.5F, 0.5F);
    const float fx = static_cast<float>(nx), fy = static_cast<float>(ny), fz = static_cast<float>(nz);
    if (!(q[0] >= 0 && q[1] >= 0 && q[2] >= 0 && q[0] < fx && q[1] < fy && q[2] < fz)) return size();
    return index(static_cast<int>(q[0]), static_cast<int>(q[1]), static_cast<int>(q[2]));
}

std::vector<SquaredRadius> squared_distances(const Lattice& lattice,
                                             const std::vector<std::uint32_t>& occupied, int reach) {
    std::vector<SquaredRadius> out(lattice.size()), scratch;
    distances_along_rows(lattice, occupied, reach, out);
    const std::size_t slice = static_cast<std::size_t>(lattice.nx) * static_cast<std::size_t>(lattice.ny);
    for (int z = 0; z < lattice.nz; ++z)
        lower_envelope(out.data() + static_cast<std::size_t>(z) * slice, lattice.ny,
                       static_cast<std::size_t>(lattice.nx), lattice.nx, reach, scratch);
    for (int y = 0; y < lattice.ny; ++y)
        lower_envelope(out.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(lattice.nx),
                       lattice.nz, slice, lattice.nx, reach, scratch);
    const SquaredRadius far = static_cast<SquaredRadius>(reach * reach + 1);
    for (SquaredRadius& d : out) d = std::min(d, far);
    return out;
}

std::vector<SquaredRadius> clearances(const Lattice& lattice, const std::vector<SquaredRadius>& distances,
                                      int reach, const std::vector<std::uint8_t>& inside) {
    const int far = reach * reach + 1;
    constexpr SquaredRadius kUnknown = -1, kInside = 0;
    std::vector<SquaredRadius> out(lattice.size(), kUnknown);
    // First in, first out on every level, so that inside and outside meet halfway.
    std::vector<std::vector<std::uint32_t>> waiting(static_cast<std::size_t>(far) + 1);
    const auto wait = [&](std::size_t i, int level, bool in) {
        const int l = std::min<int>(level, distances[i]);
        out[i] = in ? kInside : static_cast<SquaredRadius>(l);
        waiting[static_cast<std::size_t>(l)].push_back(static_cast<std::uint32_t>(i));
    };
    if (!inside.empty())
        for (std::size_t i = 0; i < out.size(); ++i)
            if (inside[i] != 0) wait(i, far, true);
    for (int z = 0; z < lattice.nz; ++z)
        for (int y = 0; y < lattice.ny; ++y) {
            const bool wall = z == 0 || y == 0 || z == lattice.nz - 1 || y == lattice.ny - 1;
            for (int x = 0; x < lattice.nx; x += wall ? 1 : std::max(1, lattice.nx - 1))
                if (out[lattice.index(x, y, z)] == kUnknown) wait(lattice.index(x, y, z), far, false);
        }
    for (int level = far; level > 0; --level) {
        std::vector<std::uint32_t>& front = waiting[static_cast<std::size_t>(level)];
        for (std::size_t k = 0; k < front.size(); ++k) {
            const bool in = out[front[k]] == kInside;
            for_each_neighbour(lattice, front[k], [&](std::size_t j) {
                if (out[j] == kUnknown) wait(j, level, in);
            });
        }
        std::vector<std::uint32_t>().swap(front);
    }
    for (SquaredRadius& c : out) c = std::max(c, kInside);  // walled in by occupied nodes all around
    return out;
}

SealedSpaces enclosed_spaces(const Lattice& lattice, const std::vector<SquaredRadius>& distances,
                             const std::vector<SquaredRadius>& clearance, double width_ratio,
                             int least_depth) {
    SealedSpaces result;
    result.inside.assign(lattice.size(), 0);
    std::vector<std::uint8_t> seen(lattice.size(), 0);
    std::vector<std::uint32_t> space;
    for (std::size_t seed = 0; seed < lattice.size(); ++seed) {
        if (seen[seed] != 0 || distances[seed] <= clearance[seed]) continue;
        space.assign(1, static_cast<std::uint32_t>(seed));
        seen[seed] = 1;
        int deepest = 0;
        for (std::size_t k = 0; k < space.size(); ++k) {
            deepest = std::max<int>(deepest, distances[space[k]]);
            for_each_neighbour(lattice, space[k], [&](std::size_t j) {
                if (seen[j] != 0 || distances[j] <= clearance[j]) return;
                seen[j] = 1;
                space.push_back(static_cast<std::uint32_t>(j));
            });
        }
        const int opening = clearance[seed];  // the same for all nodes of the space
        if (deepest < least_depth || deepest < width_ratio * width_ratio * std::max(1, opening)) continue;
        for (const std::uint32_t i : space) result.inside[i] = 1;
        result.nodes += static_cast<long long>(space.size());
        result.widest_opening = std::max(result.widest_opening, opening);
    }
    return result;
}

std::vector<LevelTopology> topology_of_levels(const Lattice& lattice,
                                              const std::vector<SquaredRadius>& clearance,
                                              const std::vector<std::uint32_t>& counts, int reach,
                                              long long enough) {
    const std::size_t levels =
        static_cast<std::size_t>(reach * reach) + 1;  // far is the outside at any level
    std::vector<int> euler(levels + 1, 0);
    add_euler_changes(lattice, clearance, euler);

    std::vector<std::uint32_t> first(levels + 2, 0), order;
    for (const SquaredRadius c : clearance) ++first[static_cast<std::size_t>(c) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    order.resize(first[levels]);
    std::vector<std::uint32_t> place(first.begin(), first.end());
    for (std::size_t i = 0; i < clearance.size(); ++i)
        if (static_cast<std::size_t>(clearance[i]) < levels)
            order[place[static_cast<std::size_t>(clearance[i])]++] = static_cast<std::uint32_t>(i);

    std::vector<LevelTopology> result(levels);
    Components sets(counts);
    LevelTopology now;
    const auto count_set = [&](std::size_t root, int sign) {
        const long long points = sets.points(root);
        (points >= enough ? now.components : now.specks) += sign;
        if (points < enough) now.speck_points += sign * points;
    };
    int euler_now = 0;
    for (std::size_t l = 0; l < levels; ++l) {
        for (std::uint32_t k = first[l]; k < first[l + 1]; ++k) {
            const std::size_t i = order[k];
            sets.add(i);
            count_set(i, 1);
            for_each_neighbour(lattice, i, [&](std::size_t j) {
                if (!sets.contains(j)) return;
                const std::size_t p = sets.find(i), q = sets.find(j);
                if (p == q) return;
                count_set(p, -1);
                count_set(q, -1);
                sets.join(p, q);
                count_set(std::min(p, q), 1);
            });
        }
        euler_now += euler[l];
        now.genus = now.components + now.specks - euler_now;
        result[l] = now;
    }
    return result;
}

int euler_characteristic(const Lattice& lattice, const std::vector<std::uint8_t>& solid) {
    std::vector<SquaredRadius> level(solid.size());
    for (std::size_t i = 0; i < solid.size(); ++i) level[i] = solid[i] != 0 ? 0 : 1;
    std::vector<int> changes(2, 0);
    add_euler_changes(lattice, level, changes);
    return changes[0];
}

}  // namespace neuralmesh
