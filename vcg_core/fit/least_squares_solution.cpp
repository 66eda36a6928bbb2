// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Conjugate gradients on the normal equations, for up to four bending weights at once and on all threads. The
// bits depend on neither: a thread computes whole rows, and the sum of each row keeps its order.
#include <algorithm>
#include <cstdint>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/least_squares.h"
#include "vcg_core/fit/solution_lanes.h"

namespace neuralmesh {

class PointToPlaneSystem::Solver {
public:
    Solver(const PointToPlaneSystem& system, ThreadTeam& team) : system_(system), team_(team) { divide(); }

    /// (A + lambda B) u, into \p result.
    template <class Weight, class Vector>
    void multiply(const Weight& lambda, const PerVertex<Vector>& u, PerVertex<Vector>& result) const {
        for_parts([&](const Part& part) { multiply_rows(part, lambda, u, result); });
    }
    template <class Lanes>
    PerVertex<typename Lanes::Vector> solution(const typename Lanes::Number& lambda,
                                               const Accuracy& accuracy) const;

private:
    /// Rows that one thread computes, and the bending terms that have a corner among them.
    struct Part {
        VertexId begin, end;
        std::vector<int> terms;

        bool holds(VertexId v) const { return begin <= v && v < end; }
    };

    /// The rows of \p part of a product, see multiply().
    template <class Weight, class Vector>
    NEURALMESH_ALWAYS_INLINE void multiply_rows_inline(const Part& part, const Weight& lambda,
                                                       const PerVertex<Vector>& u,
                                                       PerVertex<Vector>& result) const;
    void multiply_rows(const Part& part, float lambda, const PerVertex<Vector3>& u,
                       PerVertex<Vector3>& result) const {
        multiply_rows_inline(part, lambda, u, result);
    }
    NEURALMESH_MULTIVERSIONED
    void multiply_rows(const Part& part, const Four& lambda, const PerVertex<FourVectors>& u,
                       PerVertex<FourVectors>& result) const;

    void divide();
    template <class Body>
    void for_parts(const Body& body) const {
        team_.parallel(static_cast<int>(parts_.size()),
                       [&](int, int i) { body(parts_[static_cast<std::size_t>(i)]); });
    }
    template <class Body>
    void for_rows(const Body& body) const {
        for_parts([&](const Part& part) {
            for (VertexId v = part.begin; v < part.end; ++v) body(v);
        });
    }

    const PointToPlaneSystem& system_;
    ThreadTeam& team_;
    std::vector<Part> parts_;
};

void PointToPlaneSystem::Solver::divide() {
    // With fewer rows, waiting for each other costs more than a thread saves.
    constexpr std::int64_t kLeastRows = 256;
    const std::int64_t rows = system_.diagonal_.size();
    const std::int64_t count = std::clamp<std::int64_t>(rows / kLeastRows, 1, team_.members());
    for (std::int64_t i = 0; i < count; ++i)
        parts_.push_back(
            {static_cast<VertexId>(rows * i / count), static_cast<VertexId>(rows * (i + 1) / count), {}});
    const std::vector<BendingTerm>& terms = system_.bending_terms_;
    parallel_for(static_cast<int>(count), 1, team_, [&](int i) {
        Part& part = parts_[static_cast<std::size_t>(i)];
        const auto holds = [&](VertexId v) { return part.holds(v); };
        for (std::size_t t = 0; t < terms.size(); ++t)
            if (std::any_of(terms[t].corner.begin(), terms[t].corner.end(), holds))
                part.terms.push_back(static_cast<int>(t));
    });
}

template <class Weight, class Vector>
NEURALMESH_ALWAYS_INLINE void PointToPlaneSystem::Solver::multiply_rows_inline(
    const Part& part, const Weight& lambda, const PerVertex<Vector>& u, PerVertex<Vector>& result) const {
    for (VertexId v = part.begin; v < part.end; ++v) {
        const Ring& ring = system_.network_.ring(v);
        Vector sum = system_.diagonal_[v] * u[v];
        const Symmetric3* block = system_.row(v);
        if (system_.coupled_[v] != 0)
            for (int i = 0; i < ring.valence; ++i) sum += block[i] * u[ring[i]];
        result[v] = sum;
    }
    for (const int t : part.terms) {
        const BendingTerm& term = system_.bending_terms_[static_cast<std::size_t>(t)];
        const auto& c = term.coefficient;
        const Vector gap = c[0] * u[term.corner[0]] + c[1] * u[term.corner[1]] + c[2] * u[term.corner[2]] +
                           c[3] * u[term.corner[3]];
        const Vector force = ((lambda + term.stiffness) * term.weight) * gap;
        for (std::size_t k = 0; k < 4; ++k)
            if (part.holds(term.corner[k])) result[term.corner[k]] += c[k] * force;
    }
    for (const BendingTerm& term : system_.boundary_terms_) {  // their squares are in the diagonal
        const auto& c = term.coefficient;
        const Vector gap = c[0] * u[term.corner[0]] + c[1] * u[term.corner[1]] + c[2] * u[term.corner[2]];
        for (std::size_t k = 0; k < 3; ++k)
            if (part.holds(term.corner[k]))
                result[term.corner[k]] += (term.weight * c[k]) * (gap - c[k] * u[term.corner[k]]);
    }
}

void PointToPlaneSystem::Solver::multiply_rows(const Part& part, const Four& lambda,
                                               const PerVertex<FourVectors>& u,
                                               PerVertex<FourVectors>& result) const {
    multiply_rows_inline(part, lambda, u, result);
}

/// For the bending weight in each lane of \p lambda.
template <class Lanes>
PerVertex<typename Lanes::Vector> PointToPlaneSystem::Solver::solution(const typename Lanes::Number& lambda,
                                                                       const Accuracy& accuracy) const {
    using Number = typename Lanes::Number;
    using Vector = typename Lanes::Vector;
    const int n = system_.diagonal_.size();
    const Vector zero = Lanes::vector(Vector3::Zero());
    PerVertex<typename Lanes::Matrix> inverse(n);
    PerVertex<Vector> u(n, zero), residual(n, zero), scaled(n, zero), step(n, zero), image(n, zero);
    for_rows([&](VertexId v) {
        if (!system_.network_.alive(v)) return;
        inverse[v] = Lanes::inverse(system_.diagonal_[v],
                                    lambda * system_.bending_diagonal_[v] + system_.stiff_diagonal_[v]);
        residual[v] = Lanes::vector(system_.force_[v]) + lambda * Lanes::vector(system_.bending_force_[v]);
        step[v] = scaled[v] = inverse[v] * residual[v];
    });
    Descent<Lanes> descent(dots<Lanes>(residual, scaled), accuracy.tolerance);
    for (int i = 0; i < accuracy.iterations && descent.goes_on(); ++i) {
        multiply(lambda, step, image);
        const Number alpha = descent.step_lengths(dots<Lanes>(step, image));
        for_rows([&](VertexId v) {
            u[v] += alpha * step[v];
            residual[v] -= alpha * image[v];
            scaled[v] = inverse[v] * residual[v];
        });
        const Number beta = descent.conjugation(dots<Lanes>(residual, scaled));
        for_rows([&](VertexId v) { step[v] = scaled[v] + beta * step[v]; });
    }
    return u;
}

std::vector<PerVertex<Vector3>> PointToPlaneSystem::solve(const std::vector<float>& lambdas, ThreadTeam& team,
                                                          const Accuracy& accuracy) const {
    const Solver solver(*this, team);
    std::vector<PerVertex<Vector3>> solutions;
    for (std::size_t begin = 0; begin < lambdas.size(); begin += FourLanes::kCount) {
        const std::size_t lanes = std::min(lambdas.size() - begin, FourLanes::kCount);
        if (lanes == 1) {
            solutions.push_back(solver.solution<OneLane>(lambdas[begin], accuracy));
            continue;
        }
        Four lambda{};  // the last weight fills the lanes that are left
        for (std::size_t i = 0; i < FourLanes::kCount; ++i)
            lambda[i] = lambdas[begin + std::min(i, lanes - 1)];
        const PerVertex<FourVectors> four = solver.solution<FourLanes>(lambda, accuracy);
        for (std::size_t i = 0; i < lanes; ++i) {
            solutions.emplace_back(four.size());
            for (VertexId v = 0; v < four.size(); ++v) solutions.back()[v] = four[v].lane(i);
        }
    }
    return solutions;
}

void PointToPlaneSystem::multiply(float lambda, const PerVertex<Vector3>& u,
                                  PerVertex<Vector3>& result) const {
    ThreadTeam alone(1);
    Solver(*this, alone).multiply(lambda, u, result);
}

PerVertex<Vector3> PointToPlaneSystem::right_side(float lambda) const {
    PerVertex<Vector3> result(force_.size(), Vector3::Zero());
    for (VertexId v = 0; v < result.size(); ++v) result[v] = force_[v] + lambda * bending_force_[v];
    return result;
}

}  // namespace neuralmesh
