// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The steps of the fit.
#include "vcg_core/fit/fitter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/edge_flips.h"
#include "vcg_core/fit/move_limits.h"
#include "vcg_core/fit/untangle.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kChunk = 512;
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
/// The split of an edge has to be worth this many variances of the noise. The most: the best of ten thousand
/// that follow nothing but noise seem to gain about as much. But where noise is small beside the edges, up to
/// about kSmallNoise edge lengths, little can crumple, and more is won by the right ones than lost by others.
constexpr float kLeastSplitVariances = 4;
constexpr float kMostSplitVariances = 16;
constexpr float kSmallNoise = 0.06F;
/// A flip has to be worth this many.
constexpr float kFlipVariances = 6;
/// Share of the vertices that one redistribution may move.
constexpr double kShiftedShare = 0.05;
/// Share of the vertices that one round of the reduction takes out, and the points it works with.
constexpr double kReducedShare = 0.12;
constexpr std::size_t kReducingPointsPerVertex = 25;
constexpr std::size_t kLeastReducingPoints = 25000;
/// How often a change of the connectivity is tried again without what made the surface cut itself.
constexpr int kTries = 3;

}  // namespace

Fitter::Fitter(Network& network, Split points, ThreadTeam& team)
    : network_(network), points_(std::move(points)), team_(team), origin_(own_places(network)) {}

bool Fitter::untangle_surface(Progress& progress) {
    std::optional<std::vector<Crossing>> left = untangle(network_, team_, progress);
    if (left) guard_ = CrossingGuard(std::move(*left));
    return left.has_value();
}

PointsByFace Fitter::tie(const Surface& surface, bool exact) {
    const std::vector<Hit> hits =
        exact ? exact_hits(surface, points_.fitted, team_) : walked_hits(surface, points_.fitted, team_);
    PointsByFace ties = by_face(surface, points_.fitted, hits);
    noise_ = noise_variance(surface, ties);
    if (!(outlier_ > 0)) {
        std::vector<float> distances(hits.size());
        for (std::size_t i = 0; i < hits.size(); ++i) distances[i] = std::sqrt(hits[i].foot.squared_distance);
        // Residuals are symmetric about the surface, so the median of their absolute values is the MAD.
        const float deviation = 1.4826F * median(std::move(distances));
        outlier_ = std::max(kOutlierDeviations * deviation, kOutlierEdges * mean_edge(surface));
    }
    for (PointsByFace::Tie& tie : ties.ties)
        tie.influence = std::min(1.0F, outlier_ * outlier_ / std::max(tie.foot.squared_distance, 1e-20F));
    return ties;
}

void Fitter::aim(const Surface& surface) {
    const std::vector<Vector3> normals = smoothed_normals(network_, surface);
    TrackedPoints& held = points_.held;
    held.directions.resize(held.points.size());
    for_chunks(held.points.size(), kChunk, team_, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Hit hit = walk_to_nearest(surface, held.points[i], held.near[i]);
            const Triangle& f = surface.faces[index(hit.face)];
            held.near[i] = walk_start_of(surface, hit);
            held.directions[i] =
                (hit.foot.weights[0] * normals[index(f[0])] + hit.foot.weights[1] * normals[index(f[1])] +
                 hit.foot.weights[2] * normals[index(f[2])])
                    .normalized();
        }
    });
}

double Fitter::held_error(const Surface& surface) const {
    constexpr int kSteps = 2;
    const TrackedPoints& held = points_.held;
    std::vector<float> squared(held.points.size());
    for_chunks(held.points.size(), kChunk, team_, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            // The point of the line nearest to the surface's point nearest to it, and so on: where they meet.
            WalkStart near = held.near[i];
            float along = 0;
            for (int step = 0; step < kSteps; ++step) {
                const Vector3 from = held.points[i] + along * held.directions[i];
                const Hit hit = walk_to_nearest(surface, from, near);
                near = walk_start_of(surface, hit);
                Vector3 foot = Vector3::Zero();
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

double Fitter::move(const PointsByFace& ties, Surface& surface) {
    std::vector<float> weights{weight_, weight_ / kWeightDown, weight_ * kWeightUp};
    if (moves_ == 0) weights.assign(std::begin(kFirstWeights), std::end(kFirstWeights));
    float least = kFirstLeastWeight;
    for (int i = 0; i < moves_; ++i) least *= kLeastWeightDecay;
    ++moves_;
    const float gap = kLikelyGap * mean_edge(surface);
    const float per_vertex =
        static_cast<float>(ties.ties.size()) / static_cast<float>(network_.vertex_count());
    least = std::max({least, kLastLeastWeight, noise_ / (gap * gap * per_vertex)});
    for (float& weight : weights) weight = std::max(weight, least);
    weights.erase(std::unique(weights.begin(), weights.end()), weights.end());
    const Surface start = surface;
    const MoveLimits limits(network_, start);
    const PointToPlaneSystem system(network_, surface, ties, team_);
    std::vector<std::vector<Vector3>> moved(weights.size());
    for_chunks(weights.size(), 1, team_, [&](std::size_t i, std::size_t, std::size_t) {
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
    if (!guard_.objections(crossings_of(surface, team_)).empty()) {
        for (std::size_t v = 0; v < start.at.size(); ++v) moved[best][v] -= start.at[v];
        surface.at = limits.uncrossed(moved[best], guard_, team_);
        best_rms = held_error(surface);
    }
    for (VertexId v = 0; v < network_.slot_count(); ++v)
        if (network_.alive(v)) network_.set_position(v, to_vcg(surface.at[index(v)]));
    return best_rms;
}

/// New feet after the vertices have moved, on the same faces.
void Fitter::follow(const Surface& surface, PointsByFace& ties) const {
    for_chunks(surface.faces.size(), kChunk, team_, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const int face = static_cast<int>(f);
            for (int i = ties.first[f]; i < ties.first[f + 1]; ++i) {
                PointsByFace::Tie& tie = ties.ties[index(i)];
                tie.foot = foot_on_triangle(tie.point, surface.corner(face, 0), surface.corner(face, 1),
                                            surface.corner(face, 2));
            }
        }
    });
}

/// What the split of an edge has to gain, as a sum of squared distances.
float Fitter::least_gain(const Surface& surface) const {
    const float small = kSmallNoise * mean_edge(surface);
    return noise_ * std::min(kMostSplitVariances,
                             kLeastSplitVariances * (1 + noise_ / std::max(small * small, 1e-20F)));
}

/// Carries out \p change(barred) on the network, whose surface is \p surface, barred being vertices to leave
/// alone; if then the guard objects, it is undone and tried again without the vertices objected to. \return
/// what it does
template <class Change>
auto Fitter::guarded(const Surface& surface, const Change& change) {
    const Network before = network_;
    std::vector<char> barred(index(network_.slot_count()), 0);
    for (int tries = 0;; ++tries) {
        if (tries == kTries) std::fill(barred.begin(), barred.end(), 1);
        auto done = change(barred);
        const std::vector<VertexId> objections =
            guard_.objections(crossings_after(Surface(network_), surface, guard_.standing(), team_));
        if (objections.empty() || tries == kTries) return done;
        for (const VertexId v : objections)
            if (index(v) < barred.size()) barred[index(v)] = 1;
        network_ = before;
    }
}

/// What was near to a vertex that is gone is near to the one it went into.
void Fitter::move_on(const std::vector<VertexMoves::DoneCollapse>& merges) {
    std::vector<VertexId> heir(index(network_.slot_count()));
    std::iota(heir.begin(), heir.end(), 0);
    for (const VertexMoves::DoneCollapse& merge : merges) heir[index(merge.gone)] = merge.into;
    for (TrackedPoints* followed : {&points_.fitted, &points_.held})
        for (WalkStart& place : followed->near) place.vertex = heir[index(place.vertex)];
}

int Fitter::shift_vertices(const Surface& surface, const PointsByFace& ties) {
    const int most =
        std::max(1, static_cast<int>(kShiftedShare * static_cast<double>(network_.vertex_count())));
    const Redistribution plan = plan_redistribution(network_, surface, ties, least_gain(surface), team_);
    const VertexMoves done = guarded(
        surface, [&](const std::vector<char>& barred) { return redistribute(network_, plan, most, barred); });
    if (done.merges.empty()) return 0;
    move_on(done.merges);
    for (const VertexMoves::Insertion& insertion : done.insertions)
        origin_[index(insertion.added)] = origin_[index(insertion.beside)];
    return static_cast<int>(done.merges.size());
}

bool Fitter::reduce_to(int vertices, Progress& progress) {
    PartOf reducing(progress, 0, 0.9);
    PartOf untangling(progress, 0.9, 1);
    wait_for_reduction();
    const int at_start = network_.vertex_count();
    for (int round = 0; network_.vertex_count() > vertices; ++round) {
        const int left = network_.vertex_count();
        const std::string text = "Fitting to the points: " + std::to_string(left) + " vertices left of " +
                                 std::to_string(at_start) + ", to come down to " + std::to_string(vertices);
        if (!reducing(static_cast<double>(at_start - left) / (at_start - vertices), text.c_str()))
            return false;
        Surface surface(network_);
        PointsByFace ties = tie(surface, round == 0);
        if (round == 0) find_held(surface);
        if (round > 0) {
            const std::vector<Collapse> mergers = plan_reduction(network_, surface, ties, team_);
            const int most = std::min(network_.vertex_count() - vertices,
                                      1 + static_cast<int>(kReducedShare * network_.vertex_count()));
            const std::vector<VertexMoves::DoneCollapse> merges = guarded(
                surface,
                [&](const std::vector<char>& barred) { return reduce(network_, mergers, most, barred); });
            if (merges.empty()) return false;
            move_on(merges);
            surface = Surface(network_);
            ties = tie(surface, false);
        }
        aim(surface);
        move(ties, surface);
    }
    points_.fitted.points.insert(points_.fitted.points.end(), waiting_.begin(), waiting_.end());
    waiting_ = {};
    origin_ = own_places(network_);
    return guard_.standing().empty() || untangle_surface(untangling);
}

/// A part of the points, which are in random order, is enough to reduce by.
void Fitter::wait_for_reduction() {
    std::vector<Vector3>& fitted = points_.fitted.points;
    const auto enough =
        std::min(fitted.size(),
                 std::max(kLeastReducingPoints, kReducingPointsPerVertex * index(network_.vertex_count())));
    const auto rest = fitted.begin() + static_cast<std::ptrdiff_t>(enough);
    waiting_.assign(rest, fitted.end());
    fitted.erase(rest, fitted.end());
}

void Fitter::find_held(const Surface& surface) {
    by_face(surface, points_.held, exact_hits(surface, points_.held, team_));
}

void Fitter::find_again(TrackedPoints held, const Surface& surface) {
    points_.held = std::move(held);
    const std::vector<Hit> hits = exact_hits(surface, points_.held, team_);
    for (std::size_t i = 0; i < hits.size(); ++i) points_.held.near[i] = walk_start_of(surface, hits[i]);
}

int Fitter::flip(const Surface& surface, PointsByFace& ties) {
    follow(surface, ties);
    const std::vector<EdgeFlip> found = find_flips(network_, surface, ties, kFlipVariances * noise_, team_);
    return guarded(surface,
                   [&](const std::vector<char>& barred) { return flip_edges(network_, found, barred); });
}

std::vector<VertexId> own_places(const Network& network) {
    std::vector<VertexId> origin(index(network.slot_count()));
    for (VertexId v = 0; v < network.slot_count(); ++v) origin[index(v)] = network.alive(v) ? v : -1;
    return origin;
}

}  // namespace neuralmesh
