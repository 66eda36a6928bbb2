// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/fitter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/logarithm.h"
#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/boundary.h"
#include "vcg_core/fit/crease_moves.h"
#include "vcg_core/fit/edge_flips.h"
#include "vcg_core/fit/noise.h"
#include "vcg_core/fit/redistribute.h"
#include "vcg_core/fit/sound_meshes.h"

namespace neuralmesh {

namespace {

/// A point is an outlier from this many robust standard deviations (1.4826 MAD) ...
constexpr float kOutlierDeviations = 6;
/// ... but not within this share of the mean edge length.
constexpr float kOutlierEdges = 0.5F;
/// Points are astray from this many times the spread around them; see StrayPoints. Chosen by
/// tests/experiments/accuracy/scan_table.py --groups outliers.
constexpr float kStrayDeviations = 4;
constexpr int kFitChunk = 128;
/// Bending weights of the first round, and factors from the last choice to those on either side of it.
constexpr float kFirstWeights[] = {0.01F, 0.1F, 1.0F, 8.0F, 50.0F};
constexpr float kWeightDown = 8;
constexpr float kWeightUp = 2.5F;
/// Where parts are thin, the survey of the points takes their two sides for one thick one, and the mesh tells
/// them apart. Points vary about a mesh that follows them less than they do about the surface, but not by so
/// much.
constexpr float kMostOfLocal = 2;
/// The least bending weight of the first round; it falls by a factor from round to round. Without that few
/// points have 1.04 to 1.08 times the error.
constexpr float kFirstLeastWeight = 0.3F;
constexpr float kLeastWeightDecay = 0.1F;
constexpr float kLastLeastWeight = 1e-3F;
/// That with which a network begins that another fit has brought to the points.
constexpr float kFittedWeight = 0.01F;
/// Likely gap of an edge (see PointToPlaneSystem) on a surface without noise, in edge lengths. By Bayes' rule
/// it determines the least bending weight under noise.
constexpr float kLikelyGap = 0.05F;
/// The same with fewer points per vertex than kFewPerVertex, where it rarely takes a bend for noise. Without
/// it, clouds of few points have 1.29 times the error.
constexpr float kLikelyGapOfFew = 0.1F;
constexpr float kFewPerVertex = 5;
/// The same where the noise of each place is known. A frame of a depth camera in a room has normals that are
/// 2.3 degrees off with .05 and 2.8 with .07 (2,500 vertices), 3.8 with .1 (10,000).
constexpr float kLikelyGapByPlace = 0.06F;
/// Times the least weight under noise with which the rounds begin, but not stiffer than if there were so many
/// points per vertex, and the factor by which these times fall from round to round. The held-out points
/// choose among solutions that start from the learned mesh; stiff ones pay only after some rounds. At noise
/// of .3 % of the diagonal fandisk, block and genus3 of 10,000 vertices have 1.16, 1.05 and 1.23 times the
/// error without, and the other models of the accuracy table .97 to 1.03; stiffer still, 1.3 points per
/// vertex have 1.05 times.
constexpr float kFirstStiffness = 10;
constexpr float kStiffPerVertex = 2;
constexpr float kStiffnessDecay = 0.3F;
/// Noise variances that an edge flip has to gain.
constexpr float kFlipVariances = 6;
/// Share of the vertices that one redistribution may move.
constexpr double kMovedShare = 0.05;
/// Noise of precise points, in edges, and how many there are of them for each vertex. Holding the surface at
/// noise of .04, or at two points per vertex, raises the error by 1 to 6 %.
constexpr float kPreciseNoise = 0.035F;
constexpr float kPrecisePoints = 8;

/// Noise variances that an edge split has to gain: the most that one of n splits gains by following noise is
/// about 2 ln n (Donoho and Johnstone, "Ideal spatial adaptation by wavelet shrinkage", 1994). With 6 of them
/// fandisk of 10,000 vertices has 1.3 times the error at noise of .3 % of the diagonal.
float split_variances(int vertices) { return static_cast<float>(2 * portable_log(vertices)); }

float outlier_distance(const Surface& surface, const std::vector<Hit>& hits) {
    std::vector<float> distances(hits.size());
    for (std::size_t i = 0; i < hits.size(); ++i) distances[i] = std::sqrt(hits[i].foot.squared_distance);
    // Residuals are symmetric about the surface, so the median of their absolute values is the MAD.
    const float deviation = 1.4826F * median(std::move(distances));
    return std::max(kOutlierDeviations * deviation, kOutlierEdges * mean_edge_length(surface));
}

}  // namespace

Fitter::Fitter(Network& network, PointChoice points, const FitOptions& options, ThreadTeam& team)
    : network_(network),
      options_(options),
      team_(team),
      fitted_(std::move(points.fitted)),
      held_out_(std::move(points.held_out)),
      least_weight_(options.fitted_before ? kLastLeastWeight : kFirstLeastWeight),
      bending_weight_(options.fitted_before ? kFittedWeight : 0) {}

bool Fitter::untangle_surface(Progress& progress) {
    std::optional<std::vector<SelfIntersection>> left = make_sound(network_, team_, progress);
    if (left) guard_ = IntersectionGuard(std::move(*left));
    return left.has_value();
}

PointsByFace Fitter::begin_rounds(const Surface& surface) {
    stiffness_ = kFirstStiffness;
    return locate_points(surface);
}

PointsByFace Fitter::locate_points(const Surface& surface) {
    const std::vector<Hit> hits = nearest_by_tree(surface, fitted_, team_);
    if (!(outlier_distance_ > 0)) outlier_distance_ = outlier_distance(surface, hits);
    PointsByFace points = assign(surface, hits);
    held_out_.locate(surface, team_);
    return points;
}

float Fitter::noise_in_edges(const Surface& surface) const {
    return std::sqrt(noise_variance_) / mean_edge_length(surface);
}

bool Fitter::has_precise_points(const Surface& surface) const {
    const auto points = static_cast<float>(fitted_.points.size());
    const bool many = points > kPrecisePoints * static_cast<float>(network_.vertex_count());
    return many && noise_in_edges(surface) < kPreciseNoise;
}

PointsByFace Fitter::assign_faces(const Surface& surface) {
    return assign(surface, nearest_by_walk(surface, fitted_, team_));
}

PointsByFace Fitter::assign_changed(Surface& surface) {
    surface = Surface(network_);
    return assign_faces(surface);
}

/// Points beyond the boundary keep their influence: the surface has to reach them.
void Fitter::weaken_outliers(const Surface& surface, PointsByFace& points) const {
    const float squared = outlier_distance_ * outlier_distance_;
    parallel_for(surface.face_count(), kFitChunk, team_, [&](int face) {
        for (PointsByFace::Assignment& a : points.of(face))
            if (!is_beyond_boundary(surface, {face, a.foot}))
                a.influence *= std::min(1.0F, squared / std::max(a.foot.squared_distance, 1e-20F));
    });
}

PointsByFace Fitter::assign(const Surface& surface, const std::vector<Hit>& hits) {
    PointsByFace points = group_by_face(surface, fitted_, hits, team_);
    measure_noise(surface, points);
    weaken_outliers(surface, points);
    if (options_.expect_strays && !skips("strays")) silence_strays(surface, points);
    return points;
}

void Fitter::measure_noise(const Surface& surface, const PointsByFace& points) {
    noise_variance_ = neuralmesh::noise_variance(surface, points, team_);
    variances_.assign(network_.slot_count(), noise_variance_);
    if (options_.noise == nullptr) return;
    rounding_variances_.assign(network_.slot_count(), 0);
    const PerVertex<float> about_faces = local_variances(network_, surface, points);
    parallel_for(network_.slot_count(), kFitChunk, team_, [&](VertexId v) {
        if (!network_.alive(v)) return;
        const SurveyedPlace& surveyed = options_.noise->orderly_at(network_.position(v));
        variances_[v] = surveyed.variance();
        rounding_variances_[v] = surveyed.rounding_variance();
        if (about_faces[v] > 0) variances_[v] = std::min(variances_[v], kMostOfLocal * about_faces[v]);
        variances_[v] = std::max(variances_[v], rounding_variances_[v]);
    });
}

/// By Bayes' rule: what gaps of likely length weigh, in points per vertex.
VertexNoise Fitter::noise_around(const Surface& surface, const PointsByFace& points) const {
    if (options_.noise == nullptr) return {};
    const float gap = kLikelyGapByPlace * mean_edge_length(surface);
    const float points_per_vertex = points.per_vertex(network_.vertex_count());
    VertexNoise noise{variances_, variances_};
    // The points on one step are off by the same: together they say as much as one.
    for (const VertexId v : network_.vertices())
        noise.stiffness[v] = (variances_[v] / points_per_vertex + rounding_variances_[v]) / (gap * gap);
    return noise;
}

void Fitter::silence_strays(const Surface& surface, PointsByFace& points) {
    const StrayPoints strays(network_, surface, points, kStrayDeviations, team_);
    parallel_for(surface.face_count(), kFitChunk, team_, [&](int face) {
        for (PointsByFace::Assignment& a : points.of(face))
            if (strays.contain(a, face)) a.influence = 0;
    });
}

/// A wide range in the first round, later the last choice and one weight on either side.
std::vector<float> Fitter::choose_weights(const Surface& surface, const PointsByFace& points) {
    const float points_per_vertex = points.per_vertex(network_.vertex_count());
    const float gap =
        (points_per_vertex < kFewPerVertex ? kLikelyGapOfFew : kLikelyGap) * mean_edge_length(surface);
    const float by_noise = options_.noise != nullptr ? 0 : noise_variance_ / (gap * gap * points_per_vertex);
    const float stiffness = std::clamp(points_per_vertex / kStiffPerVertex, 1.0F, stiffness_);
    const float least = std::max(by_noise * stiffness, least_weight_);
    stiffness_ = std::max(kStiffnessDecay * stiffness_, 1.0F);
    least_weight_ = std::max(kLeastWeightDecay * least_weight_, kLastLeastWeight);
    std::vector<float> weights{bending_weight_, bending_weight_ / kWeightDown, bending_weight_ * kWeightUp};
    if (!(bending_weight_ > 0)) weights.assign(std::begin(kFirstWeights), std::end(kFirstWeights));
    for (float& weight : weights) weight = std::max(weight, least);
    weights.erase(std::unique(weights.begin(), weights.end()), weights.end());
    return weights;
}

double Fitter::solve(const PointsByFace& points, Surface& surface, float hold) {
    const std::vector<float> weights = choose_weights(surface, points);
    const Surface start = surface;
    const MoveLimits limits(network_, start, team_);
    const PointToPlaneSystem system(network_, surface, points, team_, noise_around(surface, points), hold);
    std::vector<PerVertex<Vector3>> solutions = system.solve(weights, team_);
    for_chunks(weights.size(), 1, team_,
               [&](std::size_t i, std::size_t, std::size_t) { solutions[i] = limits.bounded(solutions[i]); });
    std::size_t best = 0;
    double best_error = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        surface.positions = solutions[i];
        const double error = held_out_.rms_error(surface, outlier_distance_, team_);
        if (i > 0 && error >= best_error) continue;
        best = i;
        best_error = error;
    }
    bending_weight_ = weights[best];
    surface.positions = solutions[best];
    if (!guard_.objections(self_intersections(surface, team_)).empty()) {
        PerVertex<Vector3> displacements = solutions[best];
        for (VertexId v = 0; v < displacements.size(); ++v) displacements[v] -= start.positions[v];
        surface.positions = limits.without_intersections(displacements, guard_, team_);
        best_error = held_out_.rms_error(surface, outlier_distance_, team_);
    }
    place_vertices(network_, surface.positions);
    return best_error;
}

void Fitter::move_to_creases(Surface& surface, const PointsByFace& points) {
    if (skips("crease_moves")) return;
    const PerVertex<Vector3> moves = moves_to_creases(network_, surface, points, variances_, team_);
    if (std::all_of(moves.begin(), moves.end(), [](const Vector3& way) { return way.isZero(0); })) return;
    const Surface start = surface;
    const MoveLimits limits(network_, start, team_);
    surface.positions = limits.without_intersections(moves, guard_, team_);
    place_vertices(network_, surface.positions);
}

/// Moves the starts of walks from removed vertices to the vertices they were collapsed into.
void Fitter::redirect_to_survivors(const std::vector<DoneCollapse>& collapses) {
    PerVertex<VertexId> survivor(network_.slot_count());
    std::iota(survivor.begin(), survivor.end(), 0);
    for (auto collapse = collapses.rbegin(); collapse != collapses.rend(); ++collapse)
        survivor[collapse->gone] = survivor[collapse->into];
    for (TrackedPoints* tracked : {&fitted_, &held_out_.tracked()})
        for (WalkStart& start : tracked->last_hit) start.vertex = survivor[start.vertex];
}

void Fitter::redistribute_vertices(Surface& surface, PointsByFace& points) {
    const int max_pairs =
        std::max(1, static_cast<int>(kMovedShare * static_cast<double>(network_.vertex_count())));
    const std::vector<Collapse> collapses = find_collapses(network_, surface, points, team_);
    const std::vector<EdgeSplit> splits =
        find_splits(network_, surface, points, split_variances(network_.vertex_count()), team_, variances_);
    const bool changed = guarded_collapses(surface, [&](const PerVertex<char>& barred) {
        return redistribute(network_, collapses, splits, max_pairs, barred);
    });
    if (changed) points = assign_changed(surface);
}

void Fitter::flip_edges(const Surface& surface, PointsByFace& points) {
    points.update_feet(surface, team_);
    const std::vector<EdgeFlip> found =
        find_flips(network_, surface, points, kFlipVariances, team_, variances_);
    guarded(surface,
            [&](const PerVertex<char>& barred) { return neuralmesh::flip_edges(network_, found, barred); });
}

PointsByFace Fitter::mended(Surface& surface) {
    PointsByFace points = assign_faces(surface);
    if (!surface.has_boundary()) return points;
    const std::vector<VertexId> notches = find_notches(network_, surface, points);
    const int changes = guarded(surface, [&](const PerVertex<char>& barred) {
        const int opened = open_webs(network_, surface, points, barred);
        return opened + fill_notches(network_, notches, barred);
    });
    if (changes == 0) return points;
    return assign_changed(surface);
}

}  // namespace neuralmesh
