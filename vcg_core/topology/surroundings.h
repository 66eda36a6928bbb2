// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How well the points around some faces support one surface or another in the place of these faces.
#pragma once

#include <vector>

#include "vcg_core/mesh/face_tree.h"
#include "vcg_core/topology/face_signals.h"

namespace neuralmesh {

/// The bounding box of \p faces, \p margin wider on all sides. O(faces)
Eigen::AlignedBox3f box_around(const Surface& surface, const std::vector<int>& faces, float margin);

/// The signals around some faces that may be exchanged, and their distances from the rest of the surface.
/// Keeps references to the surface and the signals.
class Surroundings {
public:
    /// \param tree of all faces of \p surface \param left_out the faces \param edge the mean edge.
    /// O(log faces + (faces around + signals of the faces) x log faces around)
    Surroundings(const Surface& surface, const FaceTree& tree, const FaceSignals& support,
                 const std::vector<int>& left_out, float edge);

    /// How much less the surface costs with \p patch in the place of the faces left out, in signals: a signal
    /// costs up to 1 by its squared distance, and a face costs the signals that it lacks.
    /// O(faces around + signals near the patch x faces of the patch)
    float gain(const std::vector<Triangle>& patch) const;
    /// Of the faces around.
    int face_count() const { return static_cast<int>(kept_.size()); }

private:
    class PatchBoxes;

    /// What a signal costs.
    double misfit(float squared_distance) const;
    /// What a face costs.
    static double lack(float expected, int won);
    /// The face of the patch that is nearest to a signal, if its squared distance is less than \p least,
    /// which becomes that distance. Otherwise the size of the patch.
    std::size_t winner(const PatchBoxes& boxes, const std::vector<Triangle>& patch, const Vector3& signal,
                       float& least) const;

    const Surface& surface_;
    const FaceSignals& support_;
    float far_;              ///< squared distance from which on a signal costs 1
    std::vector<int> kept_;  ///< the other faces around, rising
    std::vector<int> wins_;  ///< their signals, and those that are as near to a face left out
    double lack_ = 0;        ///< of the faces left out
    /// A signal of the faces left out.
    struct Freed {
        Vector3 point;
        float squared_distance;          ///< from its face
        float squared_distance_of_kept;  ///< from the nearest face of those kept
        int kept;                        ///< that face, by its place in kept_; -1 if there is none
    };
    std::vector<Freed> freed_;
};

}  // namespace neuralmesh
