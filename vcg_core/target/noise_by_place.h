// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How noisy a cloud is at each place, and how many vertices it carries.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <vector>

#include "vcg_core/target/nearest_points.h"
#include "vcg_core/target/surface_survey.h"

namespace neuralmesh {

/// With fewer points per vertex, learning and fit follow the accidents of the points; a vertex that has to
/// share its points costs more than its absence. Chosen by the points of
/// tests/experiments/accuracy/scan_table.py.
constexpr std::size_t kPointsPerCarried = 2;

/// The noise of the places of a SurfaceSurvey that show a surface; at others that of the nearest which does.
class NoiseByPlace {
public:
    /// \pre some place of \p survey shows a surface
    explicit NoiseByPlace(const SurfaceSurvey& survey);

    struct Noise {
        float spacing;
        float variance;           ///< of the points across the surface
        float rounding_variance;  ///< the least that it can be: the points lie on the steps of their
                                  ///< coordinates
    };
    /// Around \p p. O(log places).
    const Noise& at(const vcg::Point3f& p) const { return noise_[index_.index(index_.nearest_to(p))]; }
    float variance_at(const vcg::Point3f& p) const { return at(p).variance; }
    /// The square of the shortest edge around \p p that is not bent by the noise alone. O(log places).
    float least_squared_edge_at(const vcg::Point3f& p) const;
    /// How many vertices \p points points carry: each with the area of such edges, and two points. O(places).
    std::size_t carried_by(std::size_t points) const;

private:
    std::vector<Noise> noise_;
    NearestPoints index_;  ///< of their places
};

}  // namespace neuralmesh
