// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The rounds of the fit, and what is kept of them.
#include "vcg_core/fit/fit.h"

#include <algorithm>
#include <string>
#include <utility>

#include "vcg_core/base/random.h"
#include "vcg_core/fit/fitter.h"

namespace neuralmesh {

namespace {

/// With fewer points than this there is nothing to fit to and to judge by.
constexpr std::size_t kLeastPoints = 64;
/// The points held back from the fit were not held back from the learning, which has followed their noise:
/// its mean squared error at them is too low by about this many noise variances x vertices / points (twice
/// the leverage of a point, 1 without any smoothing; measured at 0.1 to 0.6 % noise).
constexpr double kLearnedShare = 0.8;
/// A crumpled surface is nearer to points even along a given direction, by about the square of its slopes,
/// which are those of noise over edges. So a mesh that learning left crumpled must not win by that.
constexpr double kCrumpling = 3;
/// The first round with a redistribution, and how many of the last possible rounds are without any.
constexpr int kFirstShift = 1;
constexpr int kQuietRounds = 3;
/// The fit is over when two rounds bring less than this share of the error, but not in the first ones.
constexpr double kLeastProgress = 0.001;
constexpr int kFirstRounds = 5;

/// For every vertex that was put in anew the vertex of \p before whose place it came to: the nearest one that
/// a walk from the vertex beside which it was put in comes to. So a counter stays where it was learned.
void settle_origins(const Network& before, const Network& after, std::vector<VertexId>& origin) {
    for (VertexId v = 0; v < after.slot_count(); ++v) {
        if (!after.alive(v)) origin[index(v)] = -1;
        if (!after.alive(v) || origin[index(v)] == v) continue;
        const Vector3 here = to_eigen(after.position(v));
        const auto distance = [&](VertexId u) { return (to_eigen(before.position(u)) - here).squaredNorm(); };
        VertexId nearest = origin[index(v)];
        for (VertexId from = -1; from != nearest;) {
            from = nearest;
            const Ring& ring = before.ring(from);
            for (int i = 0; i < ring.valence; ++i)
                if (distance(ring[i]) < distance(nearest)) nearest = ring[i];
        }
        origin[index(v)] = nearest;
    }
}

/// Small meshes are cheap, and there every vertex counts.
int automatic_rounds(int vertices) { return std::min(20, std::max(8, 40000 / std::max(vertices, 1))); }

/// What the rounds come to.
struct Rounds {
    TrackedPoints at_start;  ///< the points held back, with the directions of the mesh before
    Network best;
    double best_error = 0;
};

Rounds take_rounds(Network& network, Fitter& steps, const FitOptions& options, FitReport& report,
                   Progress& progress) {
    const int rounds = options.rounds > 0 ? options.rounds : automatic_rounds(network.vertex_count());
    Rounds result{{}, network};
    double last_error = 0;
    double error_before = 0;
    for (int round = 0; round < rounds; ++round) {
        const std::string text = "Fitting to the points, round " + std::to_string(round + 1);
        if (!progress(static_cast<double>(round) / rounds, text.c_str())) break;
        Surface surface(network);
        PointsByFace ties = steps.tie(surface, round == 0);
        if (options.redistribute && round >= kFirstShift && round + kQuietRounds < rounds) {
            const int moved = steps.shift_vertices(surface, ties);
            report.moved_vertices += moved;
            if (moved > 0) {
                surface = Surface(network);
                ties = steps.tie(surface, false);
            }
        }
        if (round == 0) steps.find_held(surface);
        steps.aim(surface);
        if (round == 0) {
            result.at_start = steps.held();
            report.rms_before = report.rms_after = steps.held_error(surface);
        }
        const double error = steps.move(ties, surface);
        if (round == 0 || error < result.best_error) {
            result.best = network;
            result.best_error = error;
            report.origin = steps.origin();
            report.rounds = round + 1;
        }
        if (round >= kFirstRounds && error > (1 - kLeastProgress) * error_before) break;
        error_before = last_error;
        last_error = error;
        if (options.flip_edges && round + 1 < rounds) report.flips += steps.flip(surface, ties);
    }
    return result;
}

/// The verdict: whether the mesh after the fit is closer to the points held back than the one before, both
/// along the directions of the one before.
/// \param learned_share see kLearnedShare
void judge(Rounds& rounds, Fitter& steps, double learned_share, FitReport& report) {
    const Surface fitted(rounds.best);
    steps.find_again(std::move(rounds.at_start), fitted);
    const double error = steps.held_error(fitted);
    const double edge = static_cast<double>(mean_edge(fitted));
    const double variance = static_cast<double>(steps.variance());
    const double optimism = variance * (learned_share + kCrumpling * variance / (edge * edge));
    report.improved = report.rounds > 0 && error * error < report.rms_before * report.rms_before + optimism;
    if (report.improved) report.rms_after = error;
}

}  // namespace

FitReport fit_to_points(Network& network, const TargetSpace& target, const FitOptions& options, int threads,
                        std::uint64_t seed, Progress& progress) {
    FitReport report;
    report.origin = own_places(network);
    Random random(seed);
    const bool to_be_reduced =
        options.target_vertices > 0 && options.target_vertices < network.vertex_count();
    const int vertices = to_be_reduced ? options.target_vertices : network.vertex_count();
    const auto wanted = static_cast<std::size_t>(std::max<long long>(
        options.min_points, static_cast<long long>(options.points_per_vertex) * vertices));
    Split points = choose_points(target, wanted, random);
    if (points.fitted.points.size() < kLeastPoints || network.face_count() == 0) return report;
    const double learned_share = target.has_faces() ? 0.0
                                                    : kLearnedShare * network.vertex_count() /
                                                          static_cast<double>(target.positions().size());
    ThreadTeam team(thread_count(threads));
    Fitter steps(network, std::move(points), team);
    // By time: the reduction takes about as long as the rounds.
    PartOf untangling(progress, 0, 0.1);
    PartOf reducing(progress, 0.1, 0.5);
    PartOf fitting(progress, to_be_reduced ? 0.5 : 0.1, 1);
    if (!steps.untangle_surface(untangling)) return report;
    if (to_be_reduced) {
        const bool reduced = steps.reduce_to(vertices, reducing);
        report.origin = own_places(network);
        if (!reduced) return report;
    }
    const Network before = network;
    Rounds rounds = take_rounds(network, steps, options, report, fitting);
    judge(rounds, steps, learned_share, report);
    if (report.improved) {
        network = std::move(rounds.best);
        settle_origins(before, network, report.origin);
    } else {
        network = before;
        report.origin = own_places(before);
    }
    return report;
}

}  // namespace neuralmesh
