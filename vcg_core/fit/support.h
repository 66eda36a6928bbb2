// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What a change of faces does to their points. Surface without points: webs and spikes have area, but lack
// the points that the density of the points around them would give that area.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/mesh/ring.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// Judges whether a change of some faces makes or removes surface without points.
class Support {
public:
    /// Takes the density of the points around every vertex, over four rings. O(vertices).
    Support(const Network& network, const Surface& surface, const PointsByFace& points);

    /// Some faces before or after a change, summed up by add().
    struct Patch {
        int points = 0;
        float twice_area = 0;
        float missing_points = 0;
    };
    /// \param points the number of those on \p face
    void add(Patch& patch, const Triangle& face, float twice_area, int points) const {
        patch.points += points;
        patch.twice_area += twice_area;
        patch.missing_points += missing_points(face, twice_area, static_cast<float>(points));
    }

    /// Cost of a change that must not be made.
    static constexpr float kForbidden = std::numeric_limits<float>::max();
    /// Cost, as a sum of squared distances, of a change of faces: negative if it removes surface without
    /// points, 0 if it changes little, kForbidden if it makes such surface.
    /// \param points_per_sample the \p after patch counts every sampled point this many times
    float cost_of_change(const Patch& before, const Patch& after, int points_per_sample = 1) const;

private:
    float missing_points(const Triangle& face, float twice_area, float points) const;

    PerVertex<float> density_;  ///< of points per area
    float cost_per_point_ = 0;  ///< of a missing point, as a squared distance
};

/// The faces that a collapse or a flip would make, at most as many as a vertex may have, and which of them is
/// nearest to a point.
class FewFaces {
public:
    struct Nearest {
        float squared_distance = std::numeric_limits<float>::max();
        int label = 0;  ///< of the face added first among those at that distance
    };

    void add(const Vector3& a, const Vector3& b, const Vector3& c, int label) {
        faces_[count_++] = {a, b - a, c - a, label};
    }
    /// O(faces).
    Nearest nearest_to(const Vector3& p) const {
        Nearest nearest;
        for (std::size_t i = 0; i < count_; ++i) {
            const Face& face = faces_[i];
            const float squared = foot_on_triangle(face.ab, face.ac, p - face.a).squared_distance;
            if (squared < nearest.squared_distance) nearest = {squared, face.label};
        }
        return nearest;
    }

private:
    struct Face {
        Vector3 a, ab, ac;
        int label;
    };

    std::array<Face, Ring::kMaxValence> faces_;
    std::size_t count_ = 0;
};

/// For every vertex the number of points that its faces lack. Each point is weighted with the squared hat
/// function of the vertex, so that the tip of a spike counts most; Support counts over whole faces.
/// O(points + vertices).
PerVertex<float> missing_points_at_vertices(const Network& network, const Surface& surface,
                                            const PointsByFace& points);

}  // namespace neuralmesh
