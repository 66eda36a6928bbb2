// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Solids of known topology with links, gaps and thin walls, and clouds sampled from them, for tests of the
// shell.
#pragma once

#include <vcg/space/point3.h>

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh::shell_shapes {

using shapes::append;

/// A surface of revolution around z of the profile (radius, height), which runs counter-clockwise (outside to
/// its right); closed: the last profile point joins the first (a ring), else both ends should lie on the
/// axis.
inline Shape revolve(const std::vector<std::array<double, 2>>& profile, int segments, bool closed) {
    Shape shape;
    const int n = static_cast<int>(profile.size());
    for (int i = 0; i < segments; ++i) {
        const double u = 2 * shapes::kPi * i / segments;
        for (const auto& [r, h] : profile) shape.positions.emplace_back(r * std::cos(u), r * std::sin(u), h);
    }
    for (int i = 0; i < segments; ++i)
        for (int j = 0; j < (closed ? n : n - 1); ++j) {
            const int a = i * n + j, b = (i + 1) % segments * n + j;
            const int c = (i + 1) % segments * n + (j + 1) % n, d = i * n + (j + 1) % n;
            shape.faces.push_back({a, b, c});
            shape.faces.push_back({a, c, d});
        }
    return shape;
}

/// A sphere; its poles are doubled vertices with faces of no area, which sampling never hits.
inline Shape sphere(double radius, int segments = 48) {
    std::vector<std::array<double, 2>> profile;
    for (int i = 0; i <= segments / 2; ++i) {
        const double v = shapes::kPi * (2.0 * i / segments - 0.5);
        profile.push_back({radius * std::cos(v), radius * std::sin(v)});
    }
    return revolve(profile, segments, false);
}

/// A torus around z.
inline Shape torus(double radius, double tube, int segments = 64) {
    std::vector<std::array<double, 2>> profile;
    for (int i = 0; i < segments; ++i) {
        const double v = 2 * shapes::kPi * i / segments;
        profile.push_back({radius + tube * std::cos(v), tube * std::sin(v)});
    }
    return revolve(profile, segments, true);
}

/// \p links tori in a row along x, each through the next.
inline Shape chain(int links, double radius, double tube, double spacing) {
    Shape shape;
    for (int i = 0; i < links; ++i) {
        Shape link = torus(radius, tube);
        if (i % 2 == 1)
            for (vcg::Point3d& p : link.positions) p = vcg::Point3d(p[0], -p[2], p[1]);
        append(shape, link, vcg::Point3d(spacing * i, 0, 0));
    }
    return shape;
}

/// A cup, open at the top, with walls of the given thickness. Its vertices are evenly spaced.
inline Shape cup(double radius, double height, double wall) {
    const std::vector<std::array<double, 2>> corners = {
        {0, 0}, {radius, 0}, {radius, height}, {radius - wall, height}, {radius - wall, wall}, {0, wall}};
    std::vector<std::array<double, 2>> profile;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const double dr = corners[i + 1][0] - corners[i][0], dh = corners[i + 1][1] - corners[i][1];
        const int steps = static_cast<int>(std::ceil(std::max(std::abs(dr), std::abs(dh)) / (0.06 * radius)));
        for (int k = 0; k < steps; ++k)
            profile.push_back({corners[i][0] + dr * k / steps, corners[i][1] + dh * k / steps});
    }
    profile.push_back(corners.back());
    return revolve(profile, 96, false);
}

/// \p count random points, uniform over the area, each moved by about \p noise in every direction
/// (a sum of uniform numbers: nearly Gaussian).
inline std::vector<vcg::Point3d> sample(const Shape& shape, std::size_t count, Random& random,
                                        double noise = 0) {
    std::vector<double> area;
    double total = 0;
    for (const auto& [a, b, c] : shape.faces) {
        const auto p = [&](int i) { return shape.positions[static_cast<std::size_t>(i)]; };
        area.push_back(total += ((p(b) - p(a)) ^ (p(c) - p(a))).Norm());
    }
    const auto bell = [&] { return shapes::normal(random) * noise; };
    std::vector<vcg::Point3d> points;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = (random.bits() + 0.5) / 4294967296.0 * total;
        const std::size_t f =
            static_cast<std::size_t>(std::lower_bound(area.begin(), area.end(), at) - area.begin());
        double s = shapes::unit(random), t = shapes::unit(random);
        if (s + t > 1) {
            s = 1 - s;
            t = 1 - t;
        }
        const auto corner = [&](std::size_t k) {
            return shape.positions[static_cast<std::size_t>(shape.faces[std::min(f, area.size() - 1)][k])];
        };
        vcg::Point3d p = corner(0) * (1 - s - t) + corner(1) * s + corner(2) * t;
        if (noise > 0) p += vcg::Point3d(bell(), bell(), bell());
        points.push_back(p);
    }
    return points;
}

/// Removes the points for which \p gone returns true.
template <class Predicate>
void cut_off(std::vector<vcg::Point3d>& points, const Predicate& gone) {
    points.erase(std::remove_if(points.begin(), points.end(), gone), points.end());
}

}  // namespace neuralmesh::shell_shapes
