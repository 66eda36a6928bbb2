// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Keeps the fit from making a surface cut itself.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// Accepts a change of a surface if it adds no self-crossing, or if the number of faces that cross stays at
/// or below its initial value. A default-constructed guard starts from a surface without self-crossings.
class CrossingGuard {
public:
    CrossingGuard() = default;
    /// \param crossings self-crossings of the surface, sorted
    explicit CrossingGuard(std::vector<SelfCrossing> crossings);

    /// Judges a change after which the surface has the self-crossings \p crossings (sorted). \return empty if
    /// the change is accepted, which makes them accepted(); else the corners of the new ones
    std::vector<VertexId> objections(std::vector<SelfCrossing> crossings);

    /// The self-crossings of the surface after the last accepted change.
    const std::vector<SelfCrossing>& accepted() const { return accepted_; }

private:
    std::vector<SelfCrossing> accepted_;
    std::size_t max_faces_ = 0;
};

}  // namespace neuralmesh
