// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Clouds of surfaces with boundary.
#pragma once

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/shapes.h"

namespace neuralmesh::open_shapes {

/// The points of \p cloud that \p keep accepts.
template <class Keep>
Cloud cut(const Cloud& cloud, const Keep& keep) {
    Cloud kept;
    for (const vcg::Point3d& p : cloud)
        if (keep(p)) kept.push_back(p);
    return kept;
}

/// The points of the unit sphere whose z is below \p top.
inline Cloud sphere_below(double top, int count, double noise = 0) {
    return cut(shapes::sphere_cloud(count, noise), [top](const vcg::Point3d& p) { return p[2] < top; });
}

/// A band around the z axis of radius 1 and width .6, turned over \p half_turns times: 1 is a Moebius strip.
inline Cloud band(int count, int half_turns) {
    Random random(1);
    Cloud cloud;
    for (int i = 0; i < count; ++i) {
        const double along = 2 * shapes::kPi * shapes::unit(random);
        const double across = 0.3 * shapes::signed_unit(random), turn = half_turns * along / 2;
        const double r = 1 + across * std::cos(turn);
        cloud.emplace_back(r * std::cos(along), r * std::sin(along), across * std::sin(turn));
    }
    return cloud;
}

/// A helix: a curve.
inline Cloud helix(int count) {
    Cloud cloud;
    for (int i = 0; i < count; ++i) {
        const double t = double(i) / count;
        cloud.emplace_back(std::cos(20 * t), std::sin(20 * t), 2 * t);
    }
    return cloud;
}

/// The upright wall, .1 thick, of a tube of radius .5 and length 1, with a gap half as wide as the wall on
/// the inside: a ball that cannot pass the gap does not fit into the wall.
inline Cloud tube_with_gap(int count) {
    constexpr double kOuter = 0.5, kInner = 0.4, kGap = 0.05;
    const vcg::Point3d gap(kInner, 0, 0.5);
    Random random(1);
    const auto unit = [&] { return shapes::unit(random); };
    Cloud cloud;
    while (static_cast<int>(cloud.size()) < count) {
        const double angle = 2 * shapes::kPi * unit();
        // By area: the sides by their radii, the two ends by half the difference of the squares.
        const double part = (kOuter + kInner + kOuter * kOuter - kInner * kInner) * unit();
        double radius = part < kOuter ? kOuter : kInner, height = unit();
        if (part > kOuter + kInner) {
            radius = std::sqrt(kInner * kInner + unit() * (kOuter * kOuter - kInner * kInner));
            height = height < 0.5 ? 0 : 1;
        }
        const vcg::Point3d p(radius * std::cos(angle), radius * std::sin(angle), height);
        if ((p - gap).Norm() > kGap) cloud.push_back(p);
    }
    return cloud;
}

struct Case {
    std::string name;
    Cloud cloud;
    int components, genus, loops;
};

/// Cut spheres and tori, sheets with and without holes, a band, and two parts of different kinds.
inline std::vector<Case> cases() {
    const Cloud sphere = shapes::sphere_cloud(20000), torus = shapes::torus_cloud(20000),
                square = shapes::plane_cloud(10000);
    const auto holed = [](const vcg::Point3d& p) {
        return std::hypot(p[0] - 0.2, p[1]) > 0.12 && std::hypot(p[0] + 0.2, p[1]) > 0.12;
    };
    Cloud mixed = shapes::sphere_cloud(10000);
    for (const vcg::Point3d& p : square) mixed.push_back(p * 2 + vcg::Point3d(3, 0, 0));
    return {
        {"sphere cut by a plane", sphere_below(0.5, 20000), 1, 0, 1},
        {"sphere cut by two planes", cut(sphere, [](const vcg::Point3d& p) { return std::abs(p[2]) < 0.6; }),
         1, 0, 2},
        {"half a sphere", cut(sphere, [](const vcg::Point3d& p) { return p[0] > 0; }), 1, 0, 1},
        {"torus cut on one side", cut(torus, [](const vcg::Point3d& p) { return p[0] < 1.1; }), 1, 1, 1},
        {"half a torus", cut(torus, [](const vcg::Point3d& p) { return p[0] < 0; }), 1, 0, 2},
        {"square", square, 1, 0, 1},
        {"square with two holes", cut(square, holed), 1, 0, 3},
        {"band turned twice", band(10000, 2), 1, 0, 2},
        {"sphere beside a square", mixed, 2, 0, 1},
    };
}

/// The faces of \p shape whose corners \p keep accepts.
template <class Keep>
Shape cut(const Shape& shape, const Keep& keep) {
    const auto at = [&](int v) { return shape.positions[static_cast<std::size_t>(v)]; };
    Shape kept;
    std::vector<int> moved(shape.positions.size(), -1);
    for (const auto& f : shape.faces) {
        if (!keep(at(f[0])) || !keep(at(f[1])) || !keep(at(f[2]))) continue;
        kept.faces.push_back(f);
        for (int& v : kept.faces.back()) {
            int& to = moved[static_cast<std::size_t>(v)];
            if (to < 0) {
                to = static_cast<int>(kept.positions.size());
                kept.positions.push_back(at(v));
            }
            v = to;
        }
    }
    return kept;
}

/// The part of a sphere below .3, with one boundary.
inline Shape open_sphere() {
    return cut(shapes::icosphere(3), [](const vcg::Point3d& p) { return p[2] <= 0.3; });
}

}  // namespace neuralmesh::open_shapes
