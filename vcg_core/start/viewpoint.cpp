// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/viewpoint.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>

#include "vcg_core/base/indexed.h"
#include "vcg_core/start/normal_orientation.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Of the area that a viewer sees, this share may be turned away: steep places under noise, and overhangs. On
/// frames and aerial scans it is 2 to 11 %; of a ball that lacks a third of its height, 25 %.
constexpr double kMostTurnedAway = 0.15;
/// Sensors of one view see no more than 120 degrees: the cosine of half of that. A cap around the origin is
/// wider.
constexpr float kHalfView = 0.5F;
/// Further off, the origin is that of a country's coordinates.
constexpr float kFarthestSensor = 4;

/// A surface that is seen at a lower angle than this cosine, 6 degrees, may be turned either way: its normals
/// are not more exact. So are walls, seen from above.
constexpr double kGrazing = 0.1;

/// What is turned to a viewpoint, of an area.
struct Turned {
    double front = 0;  ///< the part that is turned to it less the part that is turned away
    double all = 0;
    double cosines = 0;  ///< between the normals and the lines of sight, summed
    int points = 0;

    /// How sure its side is, in points that are seen from straight ahead, up to 1.
    float sureness() const {
        const double to_its_side = front < 0 ? -cosines : cosines;
        return static_cast<float>(std::clamp(to_its_side - kGrazing * points, 0.0, 1.0));
    }
    bool is_single_valued() const { return std::abs(front) > (1 - 2 * kMostTurnedAway) * all; }
};

/// So far away that lines of sight are parallel but for rounding.
const Point3f kAbove(0, 0, 1e15F);
/// Lesser cosines are rounding: the sides of an upright tube are seen from nowhere.
constexpr float kInView = 1e-6F;

/// The direction from \p p to \p viewer, of length 1.
Point3f sight(const Point3f& viewer, const Point3f& p) { return (viewer - p).Normalize(); }

/// Of each part; a point stands for an area in proportion to its squared radius.
std::vector<Turned> view_from(const Point3f& viewer, const ConsolidatedPoints& points,
                              const std::vector<int>& parts) {
    std::vector<Turned> view(at(points.size()));
    for (int i = 0; i < points.size(); ++i) {
        Turned& part = view[at(parts[at(i)])];
        const auto area = static_cast<double>(points.radii[at(i)] * points.radii[at(i)]);
        const float side = points.normals[at(i)] * sight(viewer, points.positions[at(i)]);
        part.front += side > kInView ? area : side < -kInView ? -area : 0;
        part.all += area;
        part.cosines += static_cast<double>(side);
        ++part.points;
    }
    return view;
}

/// Whether a sensor at \p origin may have seen all of \p points.
bool may_be_sensor(const Point3f& origin, const std::vector<Point3f>& points) {
    vcg::Box3f box;
    for (const Point3f& p : points) box.Add(p);
    const Point3f axis = box.Center() - origin;
    if (axis.Norm() > kFarthestSensor * box.Diag()) return false;
    for (const Point3f& p : points) {
        const Point3f sight = p - origin;
        if (!(sight * axis > kHalfView * sight.Norm() * axis.Norm())) return false;
    }
    return true;
}

bool turn_to(const Point3f& viewer, const std::vector<std::pair<int, int>>& neighbours,
             const std::vector<int>& parts, ConsolidatedPoints& points) {
    const std::vector<Turned> view = view_from(viewer, points, parts);
    Turned together;
    for (const Turned& part : view) {
        together.front += std::abs(part.front);
        together.all += part.all;
    }
    if (!together.is_single_valued()) return false;
    std::vector<Point3f> sights;
    for (int i = 0; i < points.size(); ++i) {
        const Turned& part = view[at(parts[at(i)])];
        if (part.front < 0) points.normals[at(i)] = -points.normals[at(i)];
        sights.push_back(points.normals[at(i)] * (part.is_single_valued() ? part.sureness() : 0));
    }
    orient_normals(points.positions, neighbours, sights, points.normals);
    return true;
}

}  // namespace

bool is_above(const std::optional<Point3f>& viewer) { return viewer == kAbove; }

std::optional<Point3f> turn_to_viewer(const std::vector<std::pair<int, int>>& neighbours,
                                      const std::vector<int>& parts, const Point3f& origin,
                                      const std::optional<Point3f>& sensor, ConsolidatedPoints& points) {
    if (sensor && turn_to(*sensor, neighbours, parts, points)) return sensor;
    if (may_be_sensor(origin, points.positions) && turn_to(origin, neighbours, parts, points)) return origin;
    if (turn_to(kAbove, neighbours, parts, points)) return kAbove;
    return std::nullopt;
}

}  // namespace neuralmesh
