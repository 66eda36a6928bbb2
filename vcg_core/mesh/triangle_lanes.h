// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The distances of eight points from a triangle, for functions that are compiled for several instruction
// sets.
#pragma once

#include "vcg_core/base/simd.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

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
