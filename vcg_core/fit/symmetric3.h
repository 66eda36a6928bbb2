// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A symmetric 3x3 matrix in six floats, where Eigen's takes nine.
#pragma once

#include <Eigen/LU>

#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// The entries on and above the diagonal.
struct Symmetric3 {
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// n n^T
    static Symmetric3 outer(const Vector3& n) {
        return {n[0] * n[0], n[0] * n[1], n[0] * n[2], n[1] * n[1], n[1] * n[2], n[2] * n[2]};
    }
    /// Adds \p s b.
    void add(const Symmetric3& b, float s) {
        xx += s * b.xx;
        xy += s * b.xy;
        xz += s * b.xz;
        yy += s * b.yy;
        yz += s * b.yz;
        zz += s * b.zz;
    }
    /// Adds \p s to the diagonal.
    void add_identity(float s) {
        xx += s;
        yy += s;
        zz += s;
    }
    bool is_zero() const { return xx == 0 && xy == 0 && xz == 0 && yy == 0 && yz == 0 && zz == 0; }
    Vector3 operator*(const Vector3& v) const {
        return {xx * v[0] + xy * v[1] + xz * v[2], xy * v[0] + yy * v[1] + yz * v[2],
                xz * v[0] + yz * v[1] + zz * v[2]};
    }
    /// \pre regular
    Symmetric3 inverse() const {
        Eigen::Matrix3f m;
        m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
        m = m.inverse().eval();
        return {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
    }
};

}  // namespace neuralmesh
