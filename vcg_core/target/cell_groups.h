// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The occupied cells of one octree level, and which of them are connected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vcg_core/target/nearest_points.h"

namespace neuralmesh {

/// Consecutive places in one octree cell.
struct OccupiedCell {
    std::uint64_t code;
    NearestPoints::Place begin, end;
};

/// The cells at \p level that hold points not in \p out, by ascending code.
std::vector<OccupiedCell> occupied_cells(const NearestPoints& cloud, const std::vector<std::uint8_t>& out,
                                         int level);

/// The first cell of the component of each. Of the 26 neighbours of a cell those are connected to it that
/// have a point within kConnected cell sides of one of its points: whether a gap shows does not depend on
/// where cells end. Neighbours of many points are connected in any case; a finer level parts them. Points in
/// \p out do not count.
std::vector<std::size_t> connected_cells(const NearestPoints& cloud, const std::vector<OccupiedCell>& cells,
                                         int level, const std::vector<std::uint8_t>& out);

constexpr float kConnected = 0.75F;
constexpr std::size_t kMostPointPairs = 10000;  ///< of two cells; those of more are not compared

}  // namespace neuralmesh
