// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Conjugate gradients on the normal equations, on all threads. The bits do not depend on their number: a
// thread computes whole rows, and the sum of each row keeps its order.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/least_squares.h"

namespace neuralmesh {

namespace {

/// In double precision.
double dot(const PerVertex<Vector3>& a, const PerVertex<Vector3>& b) {
    double sum = 0;
    for (VertexId v = 0; v < a.size(); ++v) sum += static_cast<double>(a[v].dot(b[v]));
    return sum;
}

}  // namespace

class PointToPlaneSystem::Solver {
public:
    Solver(const PointToPlaneSystem& system, ThreadTeam& team) : system_(system), team_(team) { divide(); }

    /// (A + lambda B) u, into \p result.
    void multiply(float lambda, const PerVertex<Vector3>& u, PerVertex<Vector3>& result) const {
        for_parts([&](const Part& part) { multiply_rows(part, lambda, u, result); });
    }
    PerVertex<Vector3> solution(float lambda, const Accuracy& accuracy) const;

private:
    /// Rows that one thread computes, and the bending terms that have a corner among them.
    struct Part {
        VertexId begin, end;
        std::vector<int> terms;

        bool holds(VertexId v) const { return begin <= v && v < end; }
    };

    /// The rows of \p part of a product, see multiply().
    void multiply_rows(const Part& part, float lambda, const PerVertex<Vector3>& u,
                       PerVertex<Vector3>& result) const;
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

void PointToPlaneSystem::Solver::multiply_rows(const Part& part, float lambda, const PerVertex<Vector3>& u,
                                               PerVertex<Vector3>& result) const {
    for (VertexId v = part.begin; v < part.end; ++v) {
        const Ring& ring = system_.network_.ring(v);
        Vector3 sum = system_.diagonal_[v] * u[v];
        const Symmetric3* block = system_.row(v);
        for (int i = 0; i < ring.valence; ++i) sum += block[i] * u[ring[i]];
        result[v] = sum;
    }
    for (const int t : part.terms) {
        const BendingTerm& term = system_.bending_terms_[static_cast<std::size_t>(t)];
        const auto& c = term.coefficient;
        const Vector3 gap = c[0] * u[term.corner[0]] + c[1] * u[term.corner[1]] + c[2] * u[term.corner[2]] +
                            c[3] * u[term.corner[3]];
        const Vector3 force = ((lambda + term.stiffness) * term.weight) * gap;
        for (std::size_t k = 0; k < 4; ++k)
            if (part.holds(term.corner[k])) result[term.corner[k]] += c[k] * force;
    }
    for (const BendingTerm& term : system_.boundary_terms_) {  // their squares are in the diagonal
        const auto& c = term.coefficient;
        const Vector3 gap = c[0] * u[term.corner[0]] + c[1] * u[term.corner[1]] + c[2] * u[term.corner[2]];
        for (std::size_t k = 0; k < 3; ++k)
            if (part.holds(term.corner[k]))
                result[term.corner[k]] += (term.weight * c[k]) * (gap - c[k] * u[term.corner[k]]);
    }
}

PerVertex<Vector3> PointToPlaneSystem::Solver::solution(float lambda, const Accuracy& accuracy) const {
    const int n = system_.diagonal_.size();
    const Vector3 zero = Vector3::Zero();
    PerVertex<Symmetric3> inverse(n);
    PerVertex<Vector3> u(n, zero), residual(n, zero), scaled(n, zero), step(n, zero), image(n, zero);
    for_rows([&](VertexId v) {
        if (!system_.network_.alive(v)) return;
        Symmetric3 block = system_.diagonal_[v];
        block.add_identity(lambda * system_.bending_diagonal_[v] + system_.stiff_diagonal_[v]);
        inverse[v] = block.inverse();
        residual[v] = system_.force_[v] + lambda * system_.bending_force_[v];
        step[v] = scaled[v] = inverse[v] * residual[v];
    });
    double energy = dot(residual, scaled);
    const double enough = accuracy.tolerance * accuracy.tolerance * energy;
    for (int i = 0; i < accuracy.iterations && energy > enough && energy > 0; ++i) {
        multiply(lambda, step, image);
        const double curvature = dot(step, image);
        if (!(curvature > 0)) break;
        const auto alpha = static_cast<float>(energy / curvature);
        for_rows([&](VertexId v) {
            u[v] += alpha * step[v];
            residual[v] -= alpha * image[v];
            scaled[v] = inverse[v] * residual[v];
        });
        const double before = std::exchange(energy, dot(residual, scaled));
        const auto beta = static_cast<float>(energy / before);
        for_rows([&](VertexId v) { step[v] = scaled[v] + beta * step[v]; });
    }
    return u;
}

std::vector<PerVertex<Vector3>> PointToPlaneSystem::solve(const std::vector<float>& lambdas, ThreadTeam& team,
                                                          const Accuracy& accuracy) const {
    const Solver solver(*this, team);
    std::vector<PerVertex<Vector3>> solutions;
    for (const float lambda : lambdas) solutions.push_back(solver.solution(lambda, accuracy));
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
