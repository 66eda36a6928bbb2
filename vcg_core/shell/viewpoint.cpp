// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/viewpoint.h"

#include <vcg/space/box3.h>

#include <cmath>

#include "vcg_core/base/indexed.h"
#include "vcg_core/shell/normal_orientation.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Of the area that a viewer sees, this share may be turned away: steep places under noise, and overhangs. On
/// frames and aerial scans it is 2 to 11 %; of a ball that lacks a third of its height, 25 %.
constexpr double kMostAway = 0.15;
/// Sensors of one view see no more than 120 degrees: the cosine of half of that. A cap around the origin is
/// wider.
constexpr float kHalfView = 0.5F;
/// Further off, the origin is that of a country's coordinates.
constexpr float kFarthestSensor = 4;

/// What is turned to a viewpoint, of an area.
struct Turned {
    double front = 0;  ///< the part that is turned to it less the part that is turned away
    double all = 0;

    bool is_single_valued() const { return std::abs(front) > (1 - 2 * kMostAway) * all; }
};

/// A place, or with weight 0 a direction: what lies at an infinite distance.
struct Viewpoint {
    Point3f place;
    float weight;

    /// The direction from \p p to it, of length 1.
    Point3f sight_from(const Point3f& p) const { return (place - p * weight).Normalize(); }
};

/// Of each part; a point stands for an area in proportion to its squared radius.
std::vector<Turned> view_from(const Viewpoint& viewpoint, const ConsolidatedPoints& points,
                              const std::vector<int>& parts) {
    std::vector<Turned> view(at(points.size()));
    for (int i = 0; i < points.size(); ++i) {
        Turned& part = view[at(parts[at(i)])];
        const auto area = static_cast<double>(points.radii[at(i)] * points.radii[at(i)]);
        const float side = points.normals[at(i)] * viewpoint.sight_from(points.positions[at(i)]);
        part.front += side > 0 ? area : side < 0 ? -area : 0;
        part.all += area;
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

bool turn_to(const Viewpoint& viewpoint, const std::vector<std::pair<int, int>>& neighbours,
             const std::vector<int>& parts, ConsolidatedPoints& points) {
    const std::vector<Turned> view = view_from(viewpoint, points, parts);
    Turned together;
    for (const Turned& part : view) {
        together.front += std::abs(part.front);
        together.all += part.all;
    }
    if (!together.is_single_valued()) return false;
    std::vector<Point3f> sights(at(points.size()), Point3f(0, 0, 0));
    for (int i = 0; i < points.size(); ++i) {
        const Turned& part = view[at(parts[at(i)])];
        if (part.front < 0) points.normals[at(i)] = -points.normals[at(i)];
        if (part.is_single_valued()) sights[at(i)] = viewpoint.sight_from(points.positions[at(i)]);
    }
    orient_normals(points.positions, neighbours, sights, points.normals);
    return true;
}

}  // namespace

bool turn_to_viewer(const std::vector<std::pair<int, int>>& neighbours, const std::vector<int>& parts,
                    const Point3f& origin, const std::optional<Point3f>& sensor, ConsolidatedPoints& points) {
    return (sensor && turn_to({*sensor, 1}, neighbours, parts, points)) ||
           (may_be_sensor(origin, points.positions) && turn_to({origin, 1}, neighbours, parts, points)) ||
           turn_to({{0, 0, 1}, 0}, neighbours, parts, points);
}

}  // namespace neuralmesh
