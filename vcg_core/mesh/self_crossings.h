// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Where the surface cuts through itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// Two faces that cut each other, as their corners, the face of the smaller ones first. So a crossing is
/// known again when faces get other numbers.
using Crossing = std::array<VertexId, 6>;

/// All pairs of faces of \p surface that cut each other, sorted: faces without a common corner that have a
/// point in common, and faces with one common corner where the edge opposite to it of one goes through the
/// other (vcglib's definition, but for its tolerances, which depend on the scale). Faces with a common edge
/// never count, nor do those without area. By \p team, with the same result for any number. O(faces log faces
/// + pairs of faces whose boxes meet, of which a smooth surface has about six for each face).
/// \param pairs_looked_at if not null, gets the number of these pairs
std::vector<Crossing> crossings_of(const Surface& surface, ThreadTeam& team,
                                   std::int64_t* pairs_looked_at = nullptr);

/// The same, from \p known, the crossings of the surface \p before: only faces that are not in \p before, at
/// the same place, are looked at. Expected O(faces + changed faces log changed faces).
std::vector<Crossing> crossings_after(const Surface& surface, const Surface& before,
                                      const std::vector<Crossing>& known, ThreadTeam& team);

/// The promise that a surface does not come to cut itself more than it did.
class CrossingGuard {
public:
    CrossingGuard() = default;
    /// \param standing the crossings there are, sorted
    explicit CrossingGuard(std::vector<Crossing> standing);

    /// Takes the crossings \p now, sorted, for the standing ones if none of them is new, or if they are made
    /// of no more faces than those of the constructor. \return nothing then; else the vertices of the new
    /// ones
    std::vector<VertexId> objections(std::vector<Crossing> now);

    /// The crossings of the surface as it was last accepted.
    const std::vector<Crossing>& standing() const { return standing_; }

private:
    std::vector<Crossing> standing_;
    std::size_t most_faces_ = 0;
};

}  // namespace neuralmesh
