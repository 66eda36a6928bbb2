// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Eigen's solvers for small symmetric matrices, compiled once: each file that instantiates them takes
// seconds.
#pragma once

#include <vcg/space/point3.h>

#include <Eigen/Core>

namespace neuralmesh {

inline Eigen::Vector3d in_double(const vcg::Point3f& p) {
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

/// Of a symmetric matrix: ascending eigenvalues, and eigenvectors of length 1 as columns.
struct PrincipalAxes {
    Eigen::Vector3d values;
    Eigen::Matrix3d axes;
};
PrincipalAxes principal_axes(const Eigen::Matrix3d& symmetric);

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
/// x with \p a x = \p b. Reads the lower triangle of \p a, which is positive semidefinite.
Vector6d solve(const Matrix6d& a, const Vector6d& b);

}  // namespace neuralmesh
