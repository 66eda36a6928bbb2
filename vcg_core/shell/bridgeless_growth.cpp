// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Growth by nodes whose surroundings in the solid are connected.
#include "vcg_core/shell/bridgeless_growth.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/shell/node_groups.h"

namespace neuralmesh {
namespace {

constexpr int kNeighbours = 14;
constexpr int kGrowth = 2;                // by this factor a handle has to persist
constexpr double kLevelOfOccupied = 0.6;  // squared radius that the occupied nodes stand for by themselves
constexpr std::array<int, 8> kStarts = {0, 1, 2, 3, 4, 6, 9, 16};

std::array<int, 3> offset(int neighbour) {
    const auto& ahead = kNeighboursAhead[static_cast<std::size_t>(neighbour % 7)];
    const int sign = neighbour < 7 ? 1 : -1;
    return {sign * ahead[0], sign * ahead[1], sign * ahead[2]};
}

/// The neighbours of a node are the corners of a triangulated sphere: for every set of them, as a bit mask,
/// whether it is one connected piece.
class LinkConnected {
public:
    LinkConnected() : one_(std::size_t{1} << kNeighbours) {
        for (int i = 0; i < kNeighbours; ++i)
            for (int j = 0; j < kNeighbours; ++j)
                if (adjacent(i, j)) beside_[static_cast<std::size_t>(i)] |= 1U << j;
        for (std::uint32_t set = 1; set < one_.size(); ++set) one_[set] = connected(set) ? 1 : 0;
    }
    bool operator()(std::uint32_t set) const { return one_[set] != 0; }

private:
    static bool adjacent(int i, int j) {
        const auto a = offset(i), b = offset(j);
        for (int k = 0; k < kNeighbours; ++k) {
            const auto step = offset(k);
            if (b[0] - a[0] == step[0] && b[1] - a[1] == step[1] && b[2] - a[2] == step[2]) return true;
        }
        return false;
    }
    bool connected(std::uint32_t set) const {
        std::uint32_t reached = set & (~set + 1), before = 0;
        while (reached != before) {
            before = reached;
            for (int i = 0; i < kNeighbours; ++i)
                if ((before >> i & 1U) != 0) reached |= beside_[static_cast<std::size_t>(i)] & set;
        }
        return reached == set;
    }

    std::array<std::uint32_t, kNeighbours> beside_{};
    std::vector<std::uint8_t> one_;
};

/// The neighbours of node \p i that are in the solid, as bits.
std::uint32_t solid_around(const Lattice& lattice, std::size_t i, const std::vector<std::uint8_t>& solid) {
    const std::uint32_t nx = static_cast<std::uint32_t>(lattice.nx),
                        ny = static_cast<std::uint32_t>(lattice.ny);
    const std::uint32_t row = static_cast<std::uint32_t>(i) / nx;
    const int x = static_cast<int>(static_cast<std::uint32_t>(i) - row * nx);
    const int y = static_cast<int>(row % ny), z = static_cast<int>(row / ny);
    std::uint32_t set = 0;
    for (std::size_t k = 0; k < 7; ++k) {
        const auto& [dx, dy, dz] = kNeighboursAhead[k];
        const std::size_t step = lattice.index(dx, dy, dz);
        if (in_box(lattice, x, y, z, dx, dy, dz) && solid[i + step] != 0) set |= 1U << k;
        if (in_box(lattice, x, y, z, -dx, -dy, -dz) && solid[i - step] != 0) set |= 1U << (k + 7);
    }
    return set;
}

/// Adds the groups of left-out nodes that nothing connects to the outside.
void fill_cavities(const Lattice& lattice, const std::vector<std::uint32_t>& candidates,
                   const std::vector<SquaredRadius>& clearance, int level, std::vector<std::uint8_t>& solid) {
    constexpr std::uint8_t kSeen = 2;  // left out and looked at
    std::vector<std::uint32_t> group;
    for (const std::uint32_t seed : candidates) {
        if (solid[seed] != 0) continue;
        group.assign(1, seed);
        solid[seed] = kSeen;
        bool open = false;
        for (std::size_t k = 0; k < group.size(); ++k) {
            int neighbours = 0;
            for_each_neighbour(lattice, group[k], [&](std::size_t j) {
                ++neighbours;
                open = open || clearance[j] > level;
                if (solid[j] != 0 || clearance[j] > level) return;
                solid[j] = kSeen;
                group.push_back(static_cast<std::uint32_t>(j));
            });
            open = open || neighbours < kNeighbours;
        }
        if (!open)
            for (const std::uint32_t i : group) solid[i] = 1;
    }
    for (const std::uint32_t i : candidates) solid[i] = solid[i] == 1 ? 1 : 0;
}

}  // namespace

void grow_without_bridges(const Lattice& lattice, const std::vector<SquaredRadius>& clearance, int level,
                          std::vector<std::uint8_t>& solid) {
    static const LinkConnected one_piece;
    std::vector<std::vector<std::uint32_t>> waiting(static_cast<std::size_t>(level) + 1);
    std::vector<std::uint32_t> candidates;
    for (std::size_t i = 0; i < solid.size(); ++i)
        if (solid[i] == 0 && clearance[i] <= level) {
            waiting[static_cast<std::size_t>(clearance[i])].push_back(static_cast<std::uint32_t>(i));
            candidates.push_back(static_cast<std::uint32_t>(i));
        }
    for (int l = 0; l <= level; ++l) {
        std::vector<std::uint32_t>& front = waiting[static_cast<std::size_t>(l)];
        for (std::size_t k = 0; k < front.size(); ++k) {
            const std::size_t i = front[k];
            if (solid[i] != 0 || !one_piece(solid_around(lattice, i, solid))) continue;
            solid[i] = 1;
            // What was left out, or not reached yet, may be different now.
            for_each_neighbour(lattice, i, [&](std::size_t j) {
                if (solid[j] == 0 && clearance[j] <= l) front.push_back(static_cast<std::uint32_t>(j));
            });
        }
    }
    fill_cavities(lattice, candidates, clearance, level, solid);
}

int grown_level(int level) {
    const double from = std::max(static_cast<double>(level), kLevelOfOccupied);
    return std::min(Region::kReach * Region::kReach, static_cast<int>(from * kGrowth * kGrowth));
}

std::vector<std::uint8_t> grown_solid(const Region& region, int level) {
    std::vector<std::uint8_t> solid;
    const LevelTopology& plain = region.topologies[static_cast<std::size_t>(level)];
    if (plain.specks > 0) {
        solid = solid_of(region.lattice, region.clearance, region.counts, level, region.enough);
    } else {  // all of it, and cheaper
        solid.resize(region.clearance.size());
        for (std::size_t i = 0; i < solid.size(); ++i) solid[i] = region.clearance[i] <= level ? 1 : 0;
    }
    grow_without_bridges(region.lattice, region.clearance, grown_level(level), solid);
    return solid;
}

std::vector<TopologyAt> grown_topologies(const Region& region, ThreadTeam& team) {
    std::vector<TopologyAt> result;
    for (const int level : kStarts) {
        const LevelTopology& plain = region.topologies[static_cast<std::size_t>(level)];
        if (is_fragmented(region, level) || (level == 0 && plain.specks > 0)) continue;
        result.push_back({level, plain.components, 0});
    }
    for_chunks(result.size(), 1, team, [&](std::size_t i, std::size_t, std::size_t) {
        const std::vector<std::uint8_t> solid = grown_solid(region, result[i].level);
        // No cavities: the Euler characteristic is components minus handles.
        result[i].genus = result[i].components - euler_characteristic(region.lattice, solid);
    });
    return result;
}

}  // namespace neuralmesh
