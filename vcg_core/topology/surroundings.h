// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How well the points around some faces support one surface or another in the place of these faces.
#pragma once

#include <vector>

#include "vcg_core/topology/face_signals.h"

namespace neuralmesh {

/// The signals around some faces that may be exchanged, and their distances from the rest of the surface.
/// Keeps references to the arguments.
class Surroundings {
public:
    /// \param left_out the faces \param edge the mean edge. O(faces + signals around)
    Surroundings(const Surface& surface, const FaceSignals& support, const std::vector<int>& left_out,
                 float edge);

    /// What the surface costs with \p patch in the place of the faces left out, in signals: a signal costs up
    /// to 1 by its squared distance, and a face costs the signals that it lacks. Only differences mean
    /// something, and cost() of the faces left out is what the surface costs as it is.
    /// O(signals around x faces of the patch)
    float cost(const std::vector<Triangle>& patch) const;

private:
    float squared_distance(const Vector3& signal, const Triangle& face) const;
    float expected(const Triangle& face) const;

    const Surface& surface_;
    const FaceSignals& support_;
    float far_;              ///< squared distance from which on a signal costs 1
    std::vector<int> kept_;  ///< the other faces around
    /// A signal with its nearest face of those kept, by its place in kept_, -1 if there is none.
    struct Near {
        Vector3 point;
        float squared_distance;
        int kept;
    };
    std::vector<Near> signals_;
};

}  // namespace neuralmesh
