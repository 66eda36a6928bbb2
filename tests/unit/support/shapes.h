// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Meshes and clouds of known shape and topology, generated in code.
#pragma once

#include <vcg/space/point3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/mesh/indexed_mesh.h"

namespace neuralmesh::shapes {

constexpr double kPi = 3.14159265358979323846;

using Shape = IndexedMesh<double>;

/// Adds the faces and vertices of \p part, moved by \p offset.
inline void append(Shape& shape, const Shape& part, const vcg::Point3d& offset) {
    const int first = static_cast<int>(shape.positions.size());
    for (const vcg::Point3d& p : part.positions) shape.positions.push_back(p + offset);
    for (const auto& [a, b, c] : part.faces) shape.faces.push_back({first + a, first + b, first + c});
}

inline Shape scaled(Shape shape, double factor) {
    for (vcg::Point3d& p : shape.positions) p *= factor;
    return shape;
}

// Small meshes without faces of no area, for tests of connectivity.

inline Shape tetrahedron() {
    return {{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// Two apexes over a polygon of \p sides corners: the apexes have that valence, all others 4.
inline Shape bipyramid(int sides) {
    Shape shape;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * kPi * i / sides;
        shape.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    }
    shape.positions.emplace_back(0.0, 0.0, 1.0);
    shape.positions.emplace_back(0.0, 0.0, -1.0);
    for (int i = 0; i < sides; ++i) {
        const int j = (i + 1) % sides;
        shape.faces.push_back({i, j, sides});
        shape.faces.push_back({j, i, sides + 1});
    }
    return shape;
}

/// A half disk: vertex 0 on the boundary, with \p faces triangles around it and valence faces + 1.
inline Shape fan(int faces) {
    Shape shape;
    shape.positions.emplace_back(0.0, 0.0, 0.0);
    for (int i = 0; i <= faces; ++i) {
        const double angle = kPi * i / faces;
        shape.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
    }
    for (int i = 1; i <= faces; ++i) shape.faces.push_back({0, i, i + 1});
    return shape;
}

/// The unit cube's surface around the origin: 8 vertices, 12 faces.
inline Shape cube() {
    Shape shape;
    for (int i = 0; i < 8; ++i)
        shape.positions.emplace_back((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5,
                                     (i & 4) != 0 ? 0.5 : -0.5);
    shape.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return shape;
}

/// Each face divided into four at the middles of its edges. The given vertices come first.
inline Shape divided(const Shape& given) {
    Shape shape = given;
    shape.faces.clear();
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
        const auto found = middles.emplace(std::minmax(a, b), static_cast<int>(shape.positions.size()));
        if (found.second)
            shape.positions.push_back((given.positions[static_cast<std::size_t>(a)] +
                                       given.positions[static_cast<std::size_t>(b)]) /
                                      2);
        return found.first->second;
    };
    for (const std::array<int, 3>& f : given.faces) {
        const int a = middle(f[0], f[1]);
        const int b = middle(f[1], f[2]);
        const int c = middle(f[2], f[0]);
        shape.faces.insert(shape.faces.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
    }
    return shape;
}

/// The unit cube, each of its edges halved so many times.
inline Shape fine_cube(int halvings) {
    Shape shape = cube();
    for (int i = 0; i < halvings; ++i) shape = divided(shape);
    return shape;
}

/// The unit sphere: an icosahedron, each face divided into four \p levels times. 10 x 4^levels + 2 vertices.
inline Shape icosphere(int levels) {
    const double t = (1 + std::sqrt(5.0)) / 2;
    Shape shape{{{-1, t, 0},
                 {1, t, 0},
                 {-1, -t, 0},
                 {1, -t, 0},
                 {0, -1, t},
                 {0, 1, t},
                 {0, -1, -t},
                 {0, 1, -t},
                 {t, 0, -1},
                 {t, 0, 1},
                 {-t, 0, -1},
                 {-t, 0, 1}},
                {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    for (vcg::Point3d& p : shape.positions) p.Normalize();
    for (int level = 0; level < levels; ++level) {
        const std::size_t given = shape.positions.size();
        shape = divided(shape);
        for (std::size_t v = given; v < shape.positions.size(); ++v) shape.positions[v].Normalize();
    }
    return shape;
}

/// A point of the torus around the z axis with radii 1 and \p tube, at u along and v across the tube, in
/// turns.
inline vcg::Point3d torus_point(double u, double v, double tube) {
    const double r = 1 + tube * std::cos(2 * kPi * v);
    return {r * std::cos(2 * kPi * u), r * std::sin(2 * kPi * u), tube * std::sin(2 * kPi * v)};
}

/// A torus of m x n vertices, each of valence 6; m, n >= 3.
inline Shape torus_grid(int m, int n) {
    Shape shape;
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < n; ++j) shape.positions.push_back(torus_point(double(i) / m, double(j) / n, 0.4));
    const auto id = [&](int i, int j) { return (i % m) * n + j % n; };
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < n; ++j) {
            shape.faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            shape.faces.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    return shape;
}

/// A flat disk of m x n vertices in the plane z = 0; m, n >= 2.
inline Shape grid(int m, int n) {
    Shape shape;
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < n; ++j)
            shape.positions.emplace_back(double(i) / (m - 1) - 0.5, double(j) / (n - 1) - 0.5, 0.0);
    for (int i = 0; i + 1 < m; ++i)
        for (int j = 0; j + 1 < n; ++j) {
            const int a = i * n + j;
            shape.faces.push_back({a, a + n, a + n + 1});
            shape.faces.push_back({a, a + n + 1, a + 1});
        }
    return shape;
}

/// An open tube with two boundary loops: m vertices around, n along; m >= 3, n >= 2.
inline Shape tube(int m, int n) {
    Shape shape;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < m; ++i) {
            const double angle = 2 * kPi * i / m;
            shape.positions.emplace_back(std::cos(angle), std::sin(angle), double(j) / (n - 1));
        }
    for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i < m; ++i) {
            const int a = j * m + i;
            const int b = j * m + (i + 1) % m;
            shape.faces.push_back({a, b, b + m});
            shape.faces.push_back({a, b + m, a + m});
        }
    return shape;
}

// Clouds. Those without trigonometric functions have the same bytes on every machine.

using Cloud = std::vector<vcg::Point3d>;

inline std::vector<vcg::Point3f> in_float(const Cloud& cloud) {
    std::vector<vcg::Point3f> points;
    for (const vcg::Point3d& p : cloud) points.push_back(vcg::Point3f::Construct(p));
    return points;
}

/// Uniform in [0, 1).
inline double unit(Random& random) { return static_cast<double>(random.unit()); }

/// Uniform in [-1, 1).
inline double signed_unit(Random& random) { return 2 * unit(random) - 1; }

/// About normally distributed, of deviation 1.
inline double normal(Random& random) {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += unit(random);
    return sum;
}

/// Uniform in [-1, 1)^3. Draws the numbers in separate statements, as the order in which arguments are
/// evaluated depends on the compiler.
inline vcg::Point3d in_cube(Random& random) {
    const double z = signed_unit(random);
    const double y = signed_unit(random);
    const double x = signed_unit(random);
    return {x, y, z};
}

inline vcg::Point3d in_ball(Random& random) {
    for (;;) {
        const vcg::Point3d p = in_cube(random);
        if (p.SquaredNorm() <= 1 && p.SquaredNorm() > 1e-6) return p;
    }
}

/// Uniform on the unit sphere, moved by up to \p noise; without any transcendental function.
inline Cloud sphere_cloud(int count, double noise = 0, std::uint64_t seed = 1) {
    Random random(seed);
    Cloud cloud;
    for (int i = 0; i < count; ++i) {
        vcg::Point3d p = in_ball(random);
        p /= p.Norm();
        cloud.push_back(p + in_ball(random) * noise);
    }
    return cloud;
}

/// Of a unit sphere. The upper half has 1/\p ratio of the density of the lower one.
inline Cloud uneven_sphere_cloud(int count, int ratio, double noise = 0) {
    Cloud cloud;
    int upper = 0;
    for (int batch = 1; cloud.size() < static_cast<std::size_t>(count); ++batch)
        for (const vcg::Point3d& p : sphere_cloud(count, noise, static_cast<std::uint64_t>(batch))) {
            const bool kept = p[2] <= 0 || ++upper % ratio == 0;
            if (kept && cloud.size() < static_cast<std::size_t>(count)) cloud.push_back(p);
        }
    return cloud;
}

/// Two unit spheres of \p count points each, whose centres are \p apart.
inline Cloud two_sphere_cloud(int count, double apart) {
    Cloud cloud = sphere_cloud(count);
    for (const vcg::Point3d& p : sphere_cloud(count, 0, 2)) cloud.emplace_back(p[0] + apart, p[1], p[2]);
    return cloud;
}

/// On the torus of torus_point(u, v, 0.4), uniform in u and v.
inline Cloud torus_cloud(int count, double noise = 0, std::uint64_t seed = 1) {
    Random random(seed);
    Cloud cloud;
    for (int i = 0; i < count; ++i) {
        const double u = unit(random);
        const double v = unit(random);
        cloud.push_back(torus_point(u, v, 0.4) + in_ball(random) * noise);
    }
    return cloud;
}

/// Uniform on the surface of a box around the origin with the given edge lengths.
inline Cloud box_cloud(int count, const vcg::Point3d& edges = {1, 1, 1}, double noise = 0,
                       std::uint64_t seed = 1) {
    Random random(seed);
    Cloud cloud;
    for (int i = 0; i < count; ++i) {
        vcg::Point3d p = in_cube(random);
        p[static_cast<int>(random.below(3))] = random.below(2) == 0 ? -1 : 1;
        for (int k = 0; k < 3; ++k) p[k] *= edges[k] / 2;
        cloud.push_back(p + in_ball(random) * noise);
    }
    return cloud;
}

/// Uniform on the unit square in the plane z = 0.
inline Cloud plane_cloud(int count, std::uint64_t seed = 1) {
    Random random(seed);
    Cloud cloud;
    for (int i = 0; i < count; ++i) {
        const double x = signed_unit(random);
        cloud.emplace_back(x / 2, signed_unit(random) / 2, 0.0);
    }
    return cloud;
}

}  // namespace neuralmesh::shapes

namespace neuralmesh {

using shapes::Cloud;
using shapes::Shape;

}  // namespace neuralmesh
