// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Keeps the fit from making a surface cut itself.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// Accepts changes of a surface as long as they add no self-crossing, or do not raise the number of faces
/// that cross above the first one. Without construction arguments it starts from a surface without crossings.
class CrossingGuard {
public:
    CrossingGuard() = default;
    /// \param crossings those of the surface, sorted
    explicit CrossingGuard(std::vector<SelfCrossing> crossings);

    /// Judges a change after which the surface has the \p crossings (sorted). \return empty if the change is
    /// accepted; else the corners of the new crossings
    std::vector<VertexId> objections(std::vector<SelfCrossing> crossings);

    /// The crossings of the surface after the last accepted change.
    const std::vector<SelfCrossing>& accepted() const { return accepted_; }

private:
    std::vector<SelfCrossing> accepted_;
    std::size_t max_faces_ = 0;
};

}  // namespace neuralmesh
