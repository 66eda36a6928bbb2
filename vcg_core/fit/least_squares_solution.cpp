// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Conjugate gradients on the normal equations, for four bending weights at once, on all threads. The bits do
// not depend on their number: a thread computes whole rows, and the sum of each row keeps its order.
// For five weights Eigen's ConjugateGradient takes as long at 2,562 vertices and 1.8 times as long at 10,242,
// without the time to assemble its matrices; with its IncompleteCholesky 20 and 42 times (one thread).
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/least_squares.h"

namespace neuralmesh {

namespace {

/// Rows that one thread computes: with fewer, waiting for each other costs more than it saves.
constexpr int kSolverChunk = 512;

constexpr int kLanes = 4;
using FourSums = std::array<double, kLanes>;

/// In double precision.
FourSums dot(const PerVertex<FourVectors>& a, const PerVertex<FourVectors>& b) {
    FourSums sum{};
    for (VertexId v = 0; v < a.size(); ++v) {
        const Four product = a[v].x * b[v].x + (a[v].y * b[v].y + a[v].z * b[v].z);
        for (std::size_t k = 0; k < kLanes; ++k) sum[k] += static_cast<double>(product[k]);
    }
    return sum;
}

FourVectors lanes_of(const Vector3& v) { return {Four{} + v[0], Four{} + v[1], Four{} + v[2]}; }

}  // namespace

void PointToPlaneSystem::multiply(const Four& lambdas, const PerVertex<FourVectors>& u, ThreadTeam& team,
                                  std::vector<FourVectors>& forces, PerVertex<FourVectors>& result) const {
    forces.resize(bending_terms_.size());
    parallel_for(static_cast<int>(forces.size()), kSolverChunk, team, [&](int t) {
        const BendingTerm& term = bending_terms_[static_cast<std::size_t>(t)];
        FourVectors gap = term.coefficient[0] * u[term.corner[0]];
        for (std::size_t k = 1; k < 4; ++k) gap += term.coefficient[k] * u[term.corner[k]];
        forces[static_cast<std::size_t>(t)] = ((lambdas + term.stiffness) * term.weight) * gap;
    });
    parallel_for(result.size(), kSolverChunk, team, [&](VertexId v) {
        const Ring& ring = network_.ring(v);
        FourVectors sum = diagonal_[v] * u[v];
        const Symmetric3* block = row(v);
        for (int i = 0; i < ring.valence; ++i) sum += block[i] * u[ring[i]];
        for (std::size_t i = first_of_terms_[v]; i < first_of_terms_[v + 1]; ++i)
            sum += terms_by_vertex_[i].coefficient * forces[terms_by_vertex_[i].term];
        result[v] = sum;
    });
    for (const BendingTerm& term : boundary_terms_) {  // their squares are in the diagonal
        const auto& c = term.coefficient;
        FourVectors gap = c[0] * u[term.corner[0]];
        for (std::size_t k = 1; k < 3; ++k) gap += c[k] * u[term.corner[k]];
        for (std::size_t k = 0; k < 3; ++k) {
            FourVectors beyond = gap;
            beyond += -c[k] * u[term.corner[k]];
            result[term.corner[k]] += (term.weight * c[k]) * beyond;
        }
    }
}

void PointToPlaneSystem::multiply(float lambda, const PerVertex<Vector3>& u, ThreadTeam& team,
                                  PerVertex<Vector3>& result) const {
    PerVertex<FourVectors> lanes(u.size()), image(u.size());
    for (VertexId v = 0; v < u.size(); ++v) lanes[v] = {Four{u[v][0]}, Four{u[v][1]}, Four{u[v][2]}};
    std::vector<FourVectors> forces;
    multiply(Four{lambda}, lanes, team, forces, image);
    for (VertexId v = 0; v < u.size(); ++v) result[v] = {image[v].x[0], image[v].y[0], image[v].z[0]};
}

struct PointToPlaneSystem::Iteration {
    PerVertex<Symmetric<Four>> inverse;  ///< of the diagonal blocks
    PerVertex<FourVectors> u, residual, scaled, step;
};

PointToPlaneSystem::Iteration PointToPlaneSystem::first_iteration(const Four& lambdas,
                                                                  ThreadTeam& team) const {
    const int n = diagonal_.size();
    Iteration at{PerVertex<Symmetric<Four>>(n), PerVertex<FourVectors>(n), PerVertex<FourVectors>(n),
                 PerVertex<FourVectors>(n), PerVertex<FourVectors>(n)};
    parallel_for(n, kSolverChunk, team, [&](VertexId v) {
        if (!network_.alive(v)) return;
        for (int k = 0; k < kLanes; ++k) {
            Symmetric3 block = diagonal_[v];
            block.add_identity(lambdas[k] * bending_diagonal_[v] + stiff_diagonal_[v]);
            block = block.inverse();
            Symmetric<Four>& of_lane = at.inverse[v];
            of_lane.xx[k] = block.xx, of_lane.xy[k] = block.xy, of_lane.xz[k] = block.xz;
            of_lane.yy[k] = block.yy, of_lane.yz[k] = block.yz, of_lane.zz[k] = block.zz;
        }
        at.residual[v] = lambdas * lanes_of(bending_force_[v]);
        at.residual[v] += lanes_of(force_[v]);
        at.step[v] = at.scaled[v] = at.inverse[v] * at.residual[v];
    });
    return at;
}

/// A lane is done at the end of its own iterations: it stays as it is while the others go on.
PerVertex<FourVectors> PointToPlaneSystem::solutions(const Four& lambdas, const Accuracy& accuracy,
                                                     ThreadTeam& team) const {
    Iteration at = first_iteration(lambdas, team);
    const auto for_rows = [&](const auto& body) { parallel_for(at.u.size(), kSolverChunk, team, body); };
    PerVertex<FourVectors> image(at.u.size());
    std::vector<FourVectors> forces;
    FourSums energy = dot(at.residual, at.scaled), enough = energy;
    for (double& e : enough) e *= accuracy.tolerance * accuracy.tolerance;
    std::array<bool, kLanes> done{};
    for (int i = 0; i < accuracy.iterations; ++i) {
        for (std::size_t k = 0; k < kLanes; ++k) done[k] = done[k] || !(energy[k] > enough[k]);
        if (std::all_of(done.begin(), done.end(), [](bool lane) { return lane; })) break;
        multiply(lambdas, at.step, team, forces, image);
        const FourSums curvature = dot(at.step, image);
        Four alpha{}, beta{};
        for (std::size_t k = 0; k < kLanes; ++k) {
            done[k] = done[k] || !(curvature[k] > 0);
            if (!done[k]) alpha[k] = static_cast<float>(energy[k] / curvature[k]);
        }
        for_rows([&](VertexId v) {
            at.u[v] += alpha * at.step[v];
            at.residual[v] += -alpha * image[v];
            at.scaled[v] = at.inverse[v] * at.residual[v];
        });
        const FourSums before = std::exchange(energy, dot(at.residual, at.scaled));
        for (std::size_t k = 0; k < kLanes; ++k)
            if (!done[k]) beta[k] = static_cast<float>(energy[k] / before[k]);
        for_rows([&](VertexId v) {
            FourVectors next = at.scaled[v];
            next += beta * at.step[v];
            at.step[v] = next;
        });
    }
    return at.u;
}

std::vector<PerVertex<Vector3>> PointToPlaneSystem::solve(const std::vector<float>& lambdas, ThreadTeam& team,
                                                          const Accuracy& accuracy) const {
    std::vector<PerVertex<Vector3>> result(lambdas.size(), PerVertex<Vector3>(diagonal_.size()));
    for (std::size_t first = 0; first < lambdas.size(); first += kLanes) {
        Four lanes{};
        for (std::size_t k = 0; k < kLanes; ++k) lanes[k] = lambdas[std::min(first + k, lambdas.size() - 1)];
        const PerVertex<FourVectors> found = solutions(lanes, accuracy, team);
        for (std::size_t k = 0; k < kLanes && first + k < lambdas.size(); ++k)
            for (VertexId v = 0; v < found.size(); ++v)
                result[first + k][v] = {found[v].x[k], found[v].y[k], found[v].z[k]};
    }
    return result;
}

}  // namespace neuralmesh
