// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The rounds of the fit, and what is kept of them.
#include "fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "fit_crossings.h"
#include "fit_flips.h"
#include "fit_move.h"
#include "fit_parallel.h"
#include "fit_points.h"
#include "fit_redistribute.h"
#include "fit_solve.h"
#include "fit_untangle.h"
#include "random.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kChunk = 512;
/// With fewer points than this there is nothing to fit to and to judge by.
constexpr std::size_t kLeastPoints = 64;
/// A point is an outlier from this many robust standard deviations (1.4826 MAD) ...
constexpr float kOutlierDeviations = 6;
/// ... but not within this share of the mean edge length.
constexpr float kOutlierEdges = 0.5F;
/// Bending weights tried in the first round; later ones try the last choice and one on either side.
constexpr float kFirstWeights[] = {0.01F, 0.1F, 1.0F, 8.0F, 50.0F};
constexpr float kWeightDown = 8;
constexpr float kWeightUp = 2.5F;
/// Least bending weight: falls by the factor from round to round, since in the first ones points may still be
/// tied to the wrong faces.
constexpr float kFirstLeastWeight = 0.3F;
constexpr float kLeastWeightDecay = 0.1F;
constexpr float kLastLeastWeight = 1e-3F;
/// What an edge's gap is likely to be on surfaces of no noise, in edge lengths: the least bending weight
/// under noise is what Bayes' rule makes of it.
constexpr float kLikelyGap = 0.05F;
/// The points held back from the fit were not held back from the learning, which has followed their noise:
/// its mean squared error at them is too low by about this many noise variances x vertices / points (twice
/// the leverage of a point, 1 without any smoothing; measured at 0.1 to 0.6 % noise).
constexpr double kLearnedShare = 0.8;
/// A crumpled surface is nearer to points even along a given direction, by about the square of its slopes,
/// which are those of noise over edges. So a mesh that learning left crumpled must not win by that.
constexpr double kCrumpling = 3;
/// The first round with a redistribution.
constexpr int kFirstShift = 1;
/// The split of an edge has to be worth this many variances of the noise. The most: the best of ten thousand
/// that follow nothing but noise seem to gain about as much. But where noise is small beside the edges, up to
/// about kSmallNoise edge lengths, little can crumple, and more is won by the right ones than lost by others.
constexpr float kLeastSplitVariances = 4;
constexpr float kMostSplitVariances = 16;
constexpr float kSmallNoise = 0.06F;
/// A flip has to be worth this many.
constexpr float kFlipVariances = 6;

/// Share of the vertices that one redistribution may move, and how many last rounds are without any.
constexpr double kShiftedShare = 0.05;
constexpr int kShiftEvery = 1;
constexpr int kQuietRounds = 3;
/// The fit is over when two rounds bring less than this share of the error, but not in the first ones.
constexpr double kLeastProgress = 0.001;
constexpr int kFirstRounds = 5;
/// How often a change of the connectivity is tried again without what made the surface cut itself.
constexpr int kTries = 3;

class Fit {
public:
    /// \param learned_share see kLearnedShare
    Fit(Network& network, Split points, const FitOptions& options, double learned_share, int threads)
        : network_(network),
          points_(std::move(points)),
          options_(options),
          learned_share_(learned_share),
          threads_(threads) {}

    void run(FitReport& report, Progress& progress);

private:
    FacePoints tie(const Surface& surface, bool exact);
    void aim(const Surface& surface);
    double held_error(const Surface& surface) const;
    double move(const FacePoints& ties, Surface& surface, int round);
    template <class Change>
    auto guarded(const Change& change);
    float least_gain(const Surface& surface) const;
    bool shift_vertices(const Surface& surface, const FacePoints& ties, FitReport& report);
    void follow(const Surface& surface, FacePoints& ties) const;

    Network& network_;
    Split points_;
    const FitOptions& options_;
    double learned_share_;
    int threads_;
    float outlier_ = 0;  ///< for the judgement: fixed from the start
    float noise_ = 0;    ///< variance
    float weight_ = 0;
    std::vector<VertexId> origin_;  ///< as FitReport::origin, of the current state
    CrossingGuard guard_;           ///< of the current state
};

/// Ties every fitted point to its nearest face.
FacePoints Fit::tie(const Surface& surface, bool exact) {
    const std::vector<Hit> hits = exact ? exact_hits(surface, points_.fitted, threads_)
                                        : walked_hits(surface, points_.fitted, threads_);
    FacePoints ties = by_face(surface, points_.fitted, hits);
    noise_ = noise_variance(surface, ties);
    if (!(outlier_ > 0)) {
        std::vector<float> distances(hits.size());
        for (std::size_t i = 0; i < hits.size(); ++i) distances[i] = std::sqrt(hits[i].foot.squared_distance);
        // Residuals are symmetric about the surface, so the median of their absolute values is the MAD.
        const float deviation = 1.4826F * median(std::move(distances));
        outlier_ = std::max(kOutlierDeviations * deviation, kOutlierEdges * mean_edge(surface));
    }
    for (FacePoints::Tie& tie : ties.ties)
        tie.influence = std::min(1.0F, outlier_ * outlier_ / std::max(tie.foot.squared_distance, 1e-20F));
    return ties;
}

/// Measures from now on along the smoothed normals of \p surface.
void Fit::aim(const Surface& surface) {
    const std::vector<Vec> normals = smoothed_normals(network_, surface);
    Followed& held = points_.held;
    held.directions.resize(held.points.size());
    for_chunks(held.points.size(), kChunk, threads_, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Hit hit = walk_to_nearest(surface, held.points[i], held.near[i]);
            const Triangle& f = surface.faces[index(hit.face)];
            held.near[i] = place_of(surface, hit);
            held.directions[i] =
                (hit.foot.weights[0] * normals[index(f[0])] + hit.foot.weights[1] * normals[index(f[1])] +
                 hit.foot.weights[2] * normals[index(f[2])])
                    .normalized();
        }
    });
}

/// Root mean square distance of the points held back, along their directions. The nearest distance would not
/// do: under noise a crumpled surface is nearer to every point than the true one.
double Fit::held_error(const Surface& surface) const {
    constexpr int kSteps = 2;
    const Followed& held = points_.held;
    std::vector<float> squared(held.points.size());
    for_chunks(held.points.size(), kChunk, threads_, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            // The point of the line nearest to the surface's point nearest to it, and so on: where they meet.
            Place near = held.near[i];
            float along = 0;
            for (int step = 0; step < kSteps; ++step) {
                const Vec from = held.points[i] + along * held.directions[i];
                const Hit hit = walk_to_nearest(surface, from, near);
                near = place_of(surface, hit);
                Vec foot = Vec::Zero();
                for (std::size_t k = 0; k < 3; ++k) foot += hit.foot.weights[k] * surface.corner(hit.face, k);
                along += (foot - from).dot(held.directions[i]);
                if (step + 1 == kSteps) squared[i] = along * along;
            }
        }
    });
    double sum = 0;
    for (const float d : squared) sum += static_cast<double>(std::min(d, outlier_ * outlier_));
    return std::sqrt(sum / static_cast<double>(squared.size()));
}

/// Solves for several bending weights, takes what brings the points held back closest. \return their error
double Fit::move(const FacePoints& ties, Surface& surface, int round) {
    std::vector<float> weights{weight_, weight_ / kWeightDown, weight_ * kWeightUp};
    if (round == 0) weights.assign(std::begin(kFirstWeights), std::end(kFirstWeights));
    float least = kFirstLeastWeight;
    for (int i = 0; i < round; ++i) least *= kLeastWeightDecay;
    const float gap = kLikelyGap * mean_edge(surface);
    const float per_vertex =
        static_cast<float>(ties.ties.size()) / static_cast<float>(network_.vertex_count());
    least = std::max({least, kLastLeastWeight, noise_ / (gap * gap * per_vertex)});
    for (float& weight : weights) weight = std::max(weight, least);
    weights.erase(std::unique(weights.begin(), weights.end()), weights.end());
    const Surface start = surface;
    const MoveLimits limits(network_, start);
    const FitSystem system(network_, surface, ties, threads_);
    std::vector<std::vector<Vec>> moved(weights.size());
    for_chunks(weights.size(), 1, threads_, [&](std::size_t i, std::size_t, std::size_t) {
        moved[i] = limits.bounded(system.solve(weights[i]));
    });
    std::size_t best = 0;
    double best_rms = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        surface.at = moved[i];
        const double error = held_error(surface);
        if (i > 0 && error >= best_rms) continue;
        best = i;
        best_rms = error;
    }
    weight_ = weights[best];
    surface.at = moved[best];
    if (!guard_.objections(crossings_of(surface, threads_)).empty()) {
        for (std::size_t v = 0; v < start.at.size(); ++v) moved[best][v] -= start.at[v];
        surface.at = limits.uncrossed(moved[best], guard_, threads_);
        best_rms = held_error(surface);
    }
    for (VertexId v = 0; v < network_.slot_count(); ++v)
        if (network_.alive(v)) network_.set_position(v, point(surface.at[index(v)]));
    return best_rms;
}

/// New feet after the vertices have moved, on the same faces.
void Fit::follow(const Surface& surface, FacePoints& ties) const {
    for_chunks(surface.faces.size(), kChunk, threads_, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const int face = static_cast<int>(f);
            for (int i = ties.first[f]; i < ties.first[f + 1]; ++i) {
                FacePoints::Tie& tie = ties.ties[index(i)];
                tie.foot = foot_on_triangle(tie.point, surface.corner(face, 0), surface.corner(face, 1),
                                            surface.corner(face, 2));
            }
        }
    });
}

/// What the split of an edge has to gain, as a sum of squared distances.
float Fit::least_gain(const Surface& surface) const {
    const float small = kSmallNoise * mean_edge(surface);
    return noise_ * std::min(kMostSplitVariances,
                             kLeastSplitVariances * (1 + noise_ / std::max(small * small, 1e-20F)));
}

/// Carries out \p change(barred), barred being vertices to leave alone; if then the guard objects, it is
/// undone and tried again without the vertices objected to. \return what it does
template <class Change>
auto Fit::guarded(const Change& change) {
    const Network before = network_;
    const Surface surface(before);
    std::vector<char> barred(index(network_.slot_count()), 0);
    for (int tries = 0;; ++tries) {
        if (tries == kTries) std::fill(barred.begin(), barred.end(), 1);
        auto done = change(barred);
        const std::vector<VertexId> objections =
            guard_.objections(crossings_after(Surface(network_), surface, guard_.standing(), threads_));
        if (objections.empty() || tries == kTries) return done;
        for (const VertexId v : objections)
            if (index(v) < barred.size()) barred[index(v)] = 1;
        network_ = before;
    }
}

/// Moves vertices to where the error is and keeps the records. \return whether the mesh has changed
bool Fit::shift_vertices(const Surface& surface, const FacePoints& ties, FitReport& report) {
    const int most =
        std::max(1, static_cast<int>(kShiftedShare * static_cast<double>(network_.vertex_count())));
    const Redistribution plan = plan_redistribution(network_, surface, ties, least_gain(surface), threads_);
    const Shifts done =
        guarded([&](const std::vector<char>& barred) { return redistribute(network_, plan, most, barred); });
    if (done.merges.empty()) return false;
    std::vector<VertexId> heir(index(network_.slot_count()));
    std::iota(heir.begin(), heir.end(), 0);
    for (const Shifts::Merge& merge : done.merges) heir[index(merge.gone)] = merge.into;
    for (Followed* followed : {&points_.fitted, &points_.held})
        for (Place& place : followed->near) place.vertex = heir[index(place.vertex)];
    for (const Shifts::Insertion& insertion : done.insertions)
        origin_[index(insertion.added)] = origin_[index(insertion.beside)];
    report.moved_vertices += static_cast<int>(done.merges.size());
    return true;
}

/// For every vertex that was put in anew the vertex of \p before whose place it came to: the nearest one that
/// a walk from the vertex beside which it was put in comes to. So a counter stays where it was learned.
void settle_origins(const Network& before, const Network& after, std::vector<VertexId>& origin) {
    for (VertexId v = 0; v < after.slot_count(); ++v) {
        if (!after.alive(v) || origin[index(v)] == v) continue;
        const Vec here = vec(after.position(v));
        const auto distance = [&](VertexId u) { return (vec(before.position(u)) - here).squaredNorm(); };
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

void Fit::run(FitReport& report, Progress& progress) {
    const int rounds = options_.rounds > 0 ? options_.rounds : automatic_rounds(network_.vertex_count());
    const Network before = network_;
    Network best = network_;
    Followed at_start;
    origin_ = report.origin;
    guard_ = CrossingGuard(untangle(network_, threads_));
    double best_rms = 0;
    double last_error = 0;
    double error_before = 0;
    for (int round = 0; round < rounds; ++round) {
        const std::string text = "Fitting to the points, round " + std::to_string(round + 1);
        if (!progress(static_cast<double>(round) / rounds, text.c_str())) break;
        Surface surface(network_);
        FacePoints ties = tie(surface, round == 0);
        if (round == 0) {
            by_face(surface, points_.held, exact_hits(surface, points_.held, threads_));
            aim(surface);
            at_start = points_.held;
            report.outlier_distance = static_cast<double>(outlier_);
            report.rms_before = report.rms_after = held_error(surface);
        }
        if (options_.redistribute && round >= kFirstShift && (round - kFirstShift) % kShiftEvery == 0 &&
            round + kQuietRounds < rounds && shift_vertices(surface, ties, report)) {
            surface = Surface(network_);
            ties = tie(surface, false);
        }
        if (round > 0) aim(surface);
        const double error = move(ties, surface, round);
        if (round == 0 || error < best_rms) {
            best = network_;
            report.origin = origin_;
            best_rms = error;
            report.rounds = round + 1;
            report.bending_weight = static_cast<double>(weight_);
        }
        if (round >= kFirstRounds && error > (1 - kLeastProgress) * error_before) break;
        error_before = last_error;
        last_error = error;
        if (options_.flip_edges && round + 1 < rounds) {
            follow(surface, ties);
            const std::vector<EdgeFlip> found =
                find_flips(network_, surface, ties, kFlipVariances * noise_, threads_);
            report.flips +=
                guarded([&](const std::vector<char>& barred) { return flip_edges(network_, found, barred); });
        }
    }
    // The verdict: both meshes along the directions of the one before.
    points_.held = std::move(at_start);
    const Surface fitted(best);
    const std::vector<Hit> hits = exact_hits(fitted, points_.held, threads_);
    for (std::size_t i = 0; i < hits.size(); ++i) points_.held.near[i] = place_of(fitted, hits[i]);
    best_rms = held_error(fitted);
    const double edge = static_cast<double>(mean_edge(fitted));
    const double variance = static_cast<double>(noise_);
    const double optimism = variance * (learned_share_ + kCrumpling * variance / (edge * edge));
    report.improved =
        report.rounds > 0 && best_rms * best_rms < report.rms_before * report.rms_before + optimism;
    if (!report.improved) {
        best = before;
        for (VertexId v = 0; v < before.slot_count(); ++v) report.origin[index(v)] = before.alive(v) ? v : -1;
    }
    if (report.improved) {
        report.rms_after = best_rms;
        settle_origins(before, best, report.origin);
    }
    network_ = std::move(best);
}

}  // namespace

FitReport fit_to_points(Network& network, const TargetSpace& target, const FitOptions& options, int threads,
                        std::uint64_t seed, Progress& progress) {
    FitReport report;
    report.origin.resize(index(network.slot_count()));
    for (VertexId v = 0; v < network.slot_count(); ++v) report.origin[index(v)] = network.alive(v) ? v : -1;
    Random random(seed);
    const auto wanted = static_cast<std::size_t>(std::max<long long>(
        options.min_points, static_cast<long long>(options.points_per_vertex) * network.vertex_count()));
    Split points = choose_points(target, wanted, random);
    if (points.fitted.points.size() < kLeastPoints || network.face_count() == 0) return report;
    const double learned_share = target.has_faces() ? 0.0
                                                    : kLearnedShare * network.vertex_count() /
                                                          static_cast<double>(target.positions().size());
    Fit(network, std::move(points), options, learned_share, threads).run(report, progress);
    return report;
}

}  // namespace neuralmesh
