// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Geometry of a single triangle: normals, shape, nearest point.
#pragma once

#include <vcg/space/point3.h>
#include <vcg/space/triangle3.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>

#include "vcg_core/base/simd.h"

namespace neuralmesh {

/// A position or direction in geometric computations: Eigen's type, for its expression templates and boxes.
/// The network itself stores vcglib's points.
using Vector3 = Eigen::Vector3f;
static_assert(Eigen::internal::packet_traits<float>::Vectorizable == 0,
              "Define EIGEN_DONT_VECTORIZE: else the order of Eigen's sums depends on the processor.");

inline Vector3 to_eigen(const vcg::Point3f& p) { return {p[0], p[1], p[2]}; }
inline vcg::Point3f to_vcg(const Vector3& p) { return {p[0], p[1], p[2]}; }

/// Along the normal of the triangle a, b, c, on the side from which it appears counter-clockwise; its length
/// is twice the area.
inline Vector3 area_vector(const Vector3& a, const Vector3& b, const Vector3& c) {
    return (b - a).cross(c - a);
}

/// The same for the types of the network.
inline vcg::Point3f area_vector(const vcg::Point3f& a, const vcg::Point3f& b, const vcg::Point3f& c) {
    return (b - a) ^ (c - a);
}

/// area_vector() of length 1; 0 for a triangle without area.
inline Vector3 unit_normal(const Vector3& a, const Vector3& b, const Vector3& c) {
    return area_vector(a, b, c).normalized();
}

/// Shape of the triangle: 4 sqrt(3) area / (sum of the squared edges), from 0 (degenerate) to 1
/// (equilateral). Relative error 1e-4 for a height of 0.03 edges, 1e-2 for one of 0.003.
inline float triangle_quality(const Vector3& a, const Vector3& b, const Vector3& c) {
    return vcg::QualityMeanRatio(to_vcg(a), to_vcg(b), to_vcg(c));
}

/// The point of a triangle that is nearest to a given point.
struct Foot {
    float squared_distance;
    /// Barycentric. If the foot lies on an edge or a corner, the weights of the other corners are exactly 0.
    std::array<float, 3> weights;
};

namespace detail {

inline float share_of(float part, float rest) { return part + rest > 0 ? part / (part + rest) : 0.0F; }

inline Foot foot_with(const Vector3& ab, const Vector3& ac, const Vector3& ap, float b, float c) {
    const Vector3 d = ap - b * ab - c * ac;
    return {d.squaredNorm(), {1 - b - c, b, c}};
}

}  // namespace detail

/// \p ab and \p ac are the triangle's edges from its corner a, \p ap leads from a to the point. Degenerate
/// triangles are allowed. Source: Ericson, "Real-Time Collision Detection" (2005), 5.1.5.
inline Foot foot_on_triangle(const Vector3& ab, const Vector3& ac, const Vector3& ap) {
    const float d1 = ab.dot(ap);
    const float d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return {ap.squaredNorm(), {1, 0, 0}};
    const float bb = ab.squaredNorm();
    const float bc = ab.dot(ac);
    const float cc = ac.squaredNorm();
    const float d3 = d1 - bb;
    const float d4 = d2 - bc;
    if (d3 >= 0 && d4 <= d3) return {(ap - ab).squaredNorm(), {0, 1, 0}};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return detail::foot_with(ab, ac, ap, detail::share_of(d1, -d3), 0);
    }
    const float d5 = d1 - bc;
    const float d6 = d2 - cc;
    if (d6 >= 0 && d5 <= d6) return {(ap - ac).squaredNorm(), {0, 0, 1}};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return detail::foot_with(ab, ac, ap, 0, detail::share_of(d2, -d6));
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const float c = detail::share_of(d4 - d3, d5 - d6);
        Foot foot = detail::foot_with(ab, ac, ap, 1 - c, c);
        foot.weights[0] = 0;
        return foot;
    }
    const float sum = va + vb + vc;
    return detail::foot_with(ab, ac, ap, vb / sum, vc / sum);
}

/// The point of the triangle a, b, c that is nearest to \p p.
inline Foot foot_on_triangle(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c) {
    return foot_on_triangle(b - a, c - a, p - a);
}

// The same for eight points, in functions that are compiled for several instruction sets.

NEURALMESH_ALWAYS_INLINE void dot(const Vector3& a, const EightVectors& b, Eight& result) {
    result = a[0] * b.x + (a[1] * b.y + a[2] * b.z);  // in Eigen's order
}

/// The squared distance that foot_on_triangle() tells of eight points, with the same bits. The weights of the
/// foot are quotients b / all and c / all; every region of the plane overwrites those of the regions that
/// foot_on_triangle() looks at later.
NEURALMESH_ALWAYS_INLINE void squared_distance_to_triangle(const Vector3& ab, const Vector3& ac,
                                                           const EightVectors& ap, Eight& result) {
    const Eight zero = Eight{};
    const Eight one = zero + 1.0F;
    const float bb = ab.squaredNorm(), bc = ab.dot(ac), cc = ac.squaredNorm();
    Eight d1, d2;
    dot(ab, ap, d1);
    dot(ac, ap, d2);
    const Eight d3 = d1 - bb, d4 = d2 - bc, d5 = d1 - bc, d6 = d2 - cc;
    const Eight vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    Eight b = vb, c = vc, all = va + vb + vc;
    const auto where = [&](const EightInts& mask, const Eight& then_b, const Eight& then_c,
                           const Eight& then_all) {
        choose(mask, then_b, b, b);
        choose(mask, then_c, c, c);
        choose(mask, then_all, all, all);
    };
    const Eight from_b = d4 - d3, from_c = d5 - d6;
    const EightInts on_bc = ~((va > zero) | (from_b < zero) | (from_c < zero));
    const EightInts on_ac = ~((vb > zero) | (d2 < zero) | (d6 > zero));
    const EightInts on_ab = ~((vc > zero) | (d1 < zero) | (d3 > zero));
    const EightInts at_c = ~((d6 < zero) | (d5 > d6));
    const EightInts at_b = ~((d3 < zero) | (d4 > d3));
    const EightInts at_a = ~((d1 > zero) | (d2 > zero));
    where(on_bc, zero, from_b, from_b + from_c);
    where(on_ac, zero, d2, d2 - d6);
    where(at_c, zero, one, one);
    where(on_ab, d1, zero, d1 - d3);
    where((on_bc | on_ac | on_ab) & ~(all > zero), zero, zero, one);
    where(at_b, one, zero, one);
    where(at_a, zero, zero, one);
    b = b / all;
    c = c / all;
    choose(on_bc & ~(on_ac | at_c | on_ab | at_b | at_a), one - c, b, b);
    const Eight x = ap.x - b * ab[0] - c * ac[0];
    const Eight y = ap.y - b * ab[1] - c * ac[1];
    const Eight z = ap.z - b * ab[2] - c * ac[2];
    result = x * x + (y * y + z * z);
}

}  // namespace neuralmesh
