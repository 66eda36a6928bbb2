// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The sides that the normals of points face: their agreement, and the place that a sensor saw the surface
// from.
#pragma once

#include <vcg/space/point3.h>

#include <optional>
#include <utility>
#include <vector>

#include "vcg_core/start/consolidated_points.h"

namespace neuralmesh {

/// A surface that is seen at a lower angle than this cosine, 6 degrees, may be turned either way: its normals
/// are not more exact. So are walls, seen from above.
constexpr float kGrazing = 0.1F;

struct Orientation {
    /// For each point the first one of its part: of those that pairs which surely continue each other
    /// connect.
    std::vector<int> parts;
    /// The middles of such pairs whose normals are opposite all the same: the surface has one side only, as a
    /// Moebius strip, or comes too close to itself.
    std::vector<vcg::Point3f> contradictions;
};

/// Turns \p normals, of length 1, so that those of \p neighbours agree along the minimum spanning tree of
/// what they connect: first between points whose planes continue each other, last across walls. Pairs of
/// neighbours may occur twice. O(pairs log pairs).
/// \param sights the directions in which points are seen by a viewer, who is one more neighbour of theirs:
/// first of those whose sight has the greatest part along the normal, up to 1. 0 where there is none; empty:
/// nowhere.
Orientation orient_normals(const std::vector<vcg::Point3f>& positions,
                           const std::vector<std::pair<int, int>>& neighbours,
                           const std::vector<vcg::Point3f>& sights, std::vector<vcg::Point3f>& normals);

/// A sensor that looks in even steps of angle, as a range camera or a turning scanner does, puts
/// |cos(angle)| / distance^2 points on a unit of area: the angle is that between the normal and the line of
/// sight. The place from which that law leaves the least mean deviation of the logarithm of the density at
/// \p places, if it leaves at most half of what there is without a law; else none: of several views, of a
/// cloud thinned since, of a sensor so far away that the density is even. Within a tenth of the diagonal of
/// the cloud on frames with noise. O(places); 0.05 s.
std::optional<vcg::Point3f> sensor_place(const NearestPoints& cloud,
                                         const std::vector<SurveyedPlace>& places);

/// Whether \p viewer is the one above of turn_to_viewer(), so far away that lines of sight are parallel.
bool is_above(const std::optional<vcg::Point3f>& viewer);

/// Turns the normals of \p points, which agree within each of the \p parts of Orientation, to the side that
/// the points are seen from: to the first of these from which the surface is single-valued. That is \p
/// sensor, if the density of the points tells one. Then \p origin, the origin of the input, if they fit into
/// the view of a sensor there, no further off than some diagonals: a frame in the coordinates of its sensor.
/// Then +z: terrain, or a flat sheet. Single-valued means that of the area of all parts, each turned to its
/// better side, hardly any is turned away. \p neighbours as for orient_normals(). \return from where they are
/// seen, far away if that is above; nothing if there is no such side: then the normals stay. O(pairs log
/// pairs).
std::optional<vcg::Point3f> turn_to_viewer(const std::vector<std::pair<int, int>>& neighbours,
                                           const std::vector<int>& parts, const vcg::Point3f& origin,
                                           const std::optional<vcg::Point3f>& sensor,
                                           ConsolidatedPoints& points);

}  // namespace neuralmesh
