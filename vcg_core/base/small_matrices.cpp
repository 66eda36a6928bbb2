// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/base/small_matrices.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace neuralmesh {

PrincipalAxes principal_axes(const Eigen::Matrix3d& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(symmetric);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

Vector6d solve(const Matrix6d& a, const Vector6d& b) { return a.ldlt().solve(b); }

}  // namespace neuralmesh
