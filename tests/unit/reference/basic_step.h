// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The Basic Step of the paper's section 2, one signal at a time. This is the definition: the core runs
// engine/eight_steps, which computes the same for eight signals at once and is tested against this.
#pragma once

#include <vcg/space/point3.h>

#include "tests/unit/support/prelude.h"
#include "vcg_core/engine/eight_steps.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh::reference {

using Positions = PerVertex<vcg::Point3d>;

/// What a Basic Step changes: the positions of the winner and of its 1-ring. All other vertices stay.
struct BasicStep {
    VertexId winner;
    vcg::Point3d winner_position;
    std::array<vcg::Point3d, Ring::kMaxValence> ring_positions;  ///< in the order of the ring
    double delta;  ///< variation of the winner's normal, in [0, 2]
};

/// Sum of the unit normals of the faces around the winner, normalised; 0 if they cancel.
inline vcg::Point3d winner_normal(const Ring& ring, const BasicStep& step) {
    vcg::Point3d sum(0, 0, 0);
    for (std::size_t i = 0; static_cast<int>(i) < ring.face_count(); ++i) {
        const vcg::Point3d& a = step.ring_positions[i];
        const vcg::Point3d& b = step.ring_positions[(i + 1) % ring.valence];
        vcg::Point3d n = (a - step.winner_position) ^ (b - step.winner_position);
        sum += n.Normalize();
    }
    return sum.Normalize();
}

/// Ring vertex i of the winner after one iteration of Laplacian smoothing: v + alpha_L L_t, where L is the
/// mean of v's neighbours minus v and L_t its part at right angles to the normal n of v's star.
///
/// The winner and v's two neighbours along the winner's ring are taken where they are in \p step. Further
/// neighbours of v are taken from \p positions: they do not move, unless they are in the winner's ring, too.
inline vcg::Point3d smoothed(const Network& network, const Positions& positions, const BasicStep& step, int i,
                             double alpha_l) {
    const Ring& winners = network.ring(step.winner);
    const Ring& ring = network.ring(winners[i]);
    const int k = winners.valence;
    const auto in_step = [&](int j) { return step.ring_positions[static_cast<std::size_t>(j % k)]; };
    const vcg::Point3d v = in_step(i);
    if (ring.open != 0) return v;

    std::vector<vcg::Point3d> star = {step.winner_position, in_step(i + k - 1)};
    for (int j = 2; j < ring.valence - 1; ++j)
        star.push_back(positions[ring[(ring.find(step.winner) + j) % ring.valence]]);
    star.push_back(in_step(i + 1));

    vcg::Point3d l = -v;
    for (const vcg::Point3d& p : star) l += p / ring.valence;
    // EightSteps needs a vertex between v's two neighbours along the winner's ring. If v has only three
    // neighbours there is none, and the next ring vertex, as it lay before the step, stands in for it. This
    // changes n a little and l not at all.
    if (ring.valence == 3) star.insert(star.end() - 1, positions[winners.next(i)]);
    vcg::Point3d n(0, 0, 0);  // of any length
    for (std::size_t j = 0; j < star.size(); ++j) n += (star[j] - v) ^ (star[(j + 1) % star.size()] - v);
    const double squared = n.SquaredNorm();
    const vcg::Point3d l_t = squared > 0 ? l - n * (l * n / squared) : l;
    return v + l_t * alpha_l;  // section 2: v + alpha_L L_t
}

/// Smooths the two neighbours of the winner along the boundary, both from \p step.
inline void smooth_along_boundary(const Network& network, const Positions& positions, float smoothing_rate,
                                  BasicStep& step) {
    const Ring& ring = network.ring(step.winner);
    const auto rate = static_cast<double>(rate_along_boundary(smoothing_rate));
    const std::size_t ends[] = {0, ring.valence - std::size_t{1}};
    const vcg::Point3d of_winner =
        (step.ring_positions[ends[0]] + step.ring_positions[ends[1]]) / 2 - step.winner_position;  // L(w)
    for (const std::size_t i : ends) {
        const Ring& beside = network.ring(ring.neighbours[i]);
        const VertexId next = i == 0 ? beside[0] : beside[beside.valence - 1];
        vcg::Point3d& v = step.ring_positions[i];
        const vcg::Point3d l = (positions[next] + step.winner_position) / 2 - v;  // L(v)
        v += (l - of_winner) * rate;
    }
}

/// The vertex nearest to \p s, the smallest id among equally near ones; -1 if there is none. O(vertices).
inline VertexId find_winner(const Network& network, const Positions& positions, const vcg::Point3d& s) {
    VertexId winner = -1;
    for (const VertexId v : network.vertices())
        if (winner < 0 || (positions[v] - s).SquaredNorm() < (positions[winner] - s).SquaredNorm())
            winner = v;
    return winner;
}

/// Moves the winner \p w towards the signal \p s, then smooths its 1-ring C_L times, all ring vertices at
/// once (Jacobi). Boundary vertices of the ring stand still meanwhile.
///
/// A winner on a boundary then smooths its two neighbours there by rate_along_boundary(alpha_L) (L(v) -
/// L(w)), where L(v) leads from a vertex to the middle between its two neighbours on the boundary. L(v) alone
/// would shrink the boundary; on a circle, L(v) and L(w) are about the same. O(sum of the ring's valences).
inline BasicStep basic_step(const Network& network, const Positions& positions, VertexId w,
                            const vcg::Point3d& s, const StepRates& rates) {
    const Ring& ring = network.ring(w);
    BasicStep step{w, positions[w], {}, 0};
    for (std::size_t i = 0; i < ring.valence; ++i) step.ring_positions[i] = positions[ring.neighbours[i]];
    const vcg::Point3d n = winner_normal(ring, step);

    const auto alpha_w = static_cast<double>(rates.learning_rate);
    step.winner_position = positions[w] * (1 - alpha_w) + s * alpha_w;  // eq 1
    for (int iteration = 0; iteration < rates.smoothing_steps; ++iteration) {
        const BasicStep before = step;
        for (int i = 0; i < ring.valence; ++i)
            step.ring_positions[static_cast<std::size_t>(i)] =
                smoothed(network, positions, before, i, static_cast<double>(rates.smoothing_rate));
    }

    if (ring.open != 0 && rates.smoothing_steps > 0)
        smooth_along_boundary(network, positions, rates.smoothing_rate, step);

    const vcg::Point3d n_after = winner_normal(ring, step);
    step.delta = (n_after - n).SquaredNorm() / 2;  // eq 2: 1 - n.n' of unit vectors, without cancellation
    return step;
}

}  // namespace neuralmesh::reference
