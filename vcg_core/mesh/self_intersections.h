// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Self-intersections of a surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// Two faces that cut each other: the sorted corners of the one, then those of the other, the smaller triple
/// first. Unlike face numbers, corners identify a pair across changes of the connectivity elsewhere.
using SelfIntersection = std::array<VertexId, 6>;

/// All pairs of faces of \p surface that cut each other, sorted: an edge of one goes through the other, of
/// faces with one common corner the edge opposite to it. Faces with a common edge never count, nor
/// do faces without area. The result does not depend on the number of threads. O(faces log faces + pairs of
/// faces whose boxes touch; a smooth surface has about six such pairs per face).
/// \param tested_pairs if not null, receives the number of these pairs
std::vector<SelfIntersection> self_intersections(const Surface& surface, ThreadTeam& team,
                                                 std::int64_t* tested_pairs = nullptr);

/// The same result from \p known, the intersections of the surface \p before: tests only faces that are not
/// also in \p before at the same position. Expected O(faces + changed faces x log changed faces).
std::vector<SelfIntersection> update_self_intersections(const Surface& surface, const Surface& before,
                                                        const std::vector<SelfIntersection>& known,
                                                        ThreadTeam& team);

}  // namespace neuralmesh
