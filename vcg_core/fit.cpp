// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The rounds of the fit, and what is kept of them.
#include "fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "fit_flips.h"
#include "fit_parallel.h"
#include "fit_solve.h"
#include "random.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kChunk = 512;
/// One point in this many is held back, but at most kMostHeld.
constexpr std::size_t kHeldShare = 8;
constexpr std::size_t kMostHeld = 20000;
/// With fewer points than this there is nothing to fit to and to judge by.
constexpr std::size_t kLeastPoints = 64;
/// A point is an outlier from this many robust standard deviations (1.4826 MAD) ...
constexpr float kOutlierDeviations = 6;
/// ... but not within this share of the mean edge length.
constexpr float kOutlierEdges = 0.5F;
/// Bending weights tried in the first round; later ones try the neighbours of the last choice.
constexpr float kFirstWeights[] = {0.003F, 0.03F, 0.3F, 3.0F};
constexpr float kWeightStep = 2.5F;
/// A flip has to be worth this many squared standard deviations.
constexpr float kFlipDeviations = 2;

struct Split {
    std::vector<Vec> fitted;
    std::vector<Vec> held;
};

/// The points to fit to and those held back: all of a cloud, or a random choice.
Split choose_points(const TargetSpace& target, std::size_t wanted, Random& random) {
    std::vector<Vec> all;
    if (target.has_faces()) {
        for (std::size_t i = 0; i < wanted; ++i) all.push_back(vec(target.sample(random)));
    } else {
        const auto& positions = target.positions();
        std::vector<std::uint32_t> order(positions.size());
        std::iota(order.begin(), order.end(), 0U);
        wanted = std::min(wanted, order.size());
        for (std::size_t i = 0; i < wanted; ++i) {
            std::swap(order[i], order[i + random.below(static_cast<std::uint32_t>(order.size() - i))]);
            all.push_back(vec(positions[order[i]]));
        }
    }
    const std::size_t held = std::min(all.size() / kHeldShare, kMostHeld);
    Split split;
    split.held.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(held));
    split.fitted.assign(all.begin() + static_cast<std::ptrdiff_t>(held), all.end());
    return split;
}

float median(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

float mean_edge(const Surface& surface) {
    double sum = 0;
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            sum += static_cast<double>(
                (surface.corner(static_cast<int>(f), k) - surface.corner(static_cast<int>(f), (k + 1) % 3)).norm());
    return static_cast<float>(sum / (3 * static_cast<double>(surface.faces.size())));
}

std::vector<FaceTree::Hit> nearest_faces(const FaceTree& tree, const std::vector<Vec>& points, int threads) {
    std::vector<FaceTree::Hit> hits(points.size());
    for_chunks(points.size(), kChunk, threads, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) hits[i] = tree.nearest(points[i]);
    });
    return hits;
}

class Fit {
public:
    Fit(Network& network, Split points, const FitOptions& options, int threads)
        : network_(network), points_(std::move(points)), options_(options), threads_(threads) {}

    void run(FitReport& report, Progress& progress);

private:
    FacePoints tie(const FaceTree& tree);
    double held_rms(const FaceTree& tree) const;
    double move(const FacePoints& ties, FaceTree& tree, Surface& surface, bool first);
    void follow(const Surface& surface, FacePoints& ties) const;

    Network& network_;
    Split points_;
    const FitOptions& options_;
    int threads_;
    float outlier_ = 0;    ///< for the judgement: fixed from the start
    float deviation_ = 0;  ///< of the fitted points, robust
    float weight_ = 0;
};

/// Ties every fitted point to its nearest face.
FacePoints Fit::tie(const FaceTree& tree) {
    const std::vector<FaceTree::Hit> hits = nearest_faces(tree, points_.fitted, threads_);
    std::vector<float> distances(hits.size());
    for (std::size_t i = 0; i < hits.size(); ++i) distances[i] = std::sqrt(hits[i].foot.squared_distance);
    // Residuals are symmetric about the surface, so the median of their absolute values is the MAD.
    deviation_ = 1.4826F * median(std::move(distances));
    FacePoints ties;
    ties.first.assign(index(network_.face_count()) + 1, 0);
    for (const FaceTree::Hit& hit : hits) ++ties.first[index(hit.face) + 1];
    std::partial_sum(ties.first.begin(), ties.first.end(), ties.first.begin());
    ties.ties.resize(hits.size());
    std::vector<int> next(ties.first.begin(), ties.first.end() - 1);
    const float squared = outlier_ * outlier_;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Foot& foot = hits[i].foot;
        const float influence = squared > 0 && foot.squared_distance > squared ? squared / foot.squared_distance : 1;
        ties.ties[index(next[index(hits[i].face)]++)] = {points_.fitted[i], influence, foot};
    }
    return ties;
}

double Fit::held_rms(const FaceTree& tree) const {
    const std::vector<FaceTree::Hit> hits = nearest_faces(tree, points_.held, threads_);
    double sum = 0;
    for (const FaceTree::Hit& hit : hits)
        sum += static_cast<double>(std::min(hit.foot.squared_distance, outlier_ * outlier_));
    return std::sqrt(sum / static_cast<double>(hits.size()));
}

/// Solves for several bending weights, takes what brings the points held back closest. \return their error
double Fit::move(const FacePoints& ties, FaceTree& tree, Surface& surface, bool first) {
    std::vector<float> weights{weight_, weight_ / kWeightStep, weight_ * kWeightStep};
    if (first) weights.assign(std::begin(kFirstWeights), std::end(kFirstWeights));
    const FitSystem system(network_, surface, ties, threads_);
    std::vector<std::vector<Vec>> moved(weights.size());
    for_chunks(weights.size(), 1, threads_, [&](std::size_t i, std::size_t, std::size_t) {
        moved[i] = bounded_move(network_, surface, system.solve(weights[i]));
    });
    std::size_t best = 0;
    double best_rms = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        tree.refit(moved[i]);
        const double rms = held_rms(tree);
        if (i > 0 && rms >= best_rms) continue;
        best = i;
        best_rms = rms;
    }
    weight_ = weights[best];
    surface.at = std::move(moved[best]);
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

void Fit::run(FitReport& report, Progress& progress) {
    Network best = network_;
    for (int round = 0; round < options_.rounds; ++round) {
        const std::string text = "Fitting to the points, round " + std::to_string(round + 1);
        if (!progress(static_cast<double>(round) / options_.rounds, text.c_str())) break;
        Surface surface(network_);
        FaceTree tree(surface);
        FacePoints ties = tie(tree);
        if (round == 0) {
            outlier_ = std::max(kOutlierDeviations * deviation_, kOutlierEdges * mean_edge(surface));
            report.outlier_distance = static_cast<double>(outlier_);
            report.rms_before = report.rms_after = held_rms(tree);
            ties = tie(tree);
        }
        const double rms = move(ties, tree, surface, round == 0);
        if (rms < report.rms_after) {
            best = network_;
            report.rms_after = rms;
            report.rounds = round + 1;
            report.bending_weight = static_cast<double>(weight_);
            report.improved = true;
        }
        if (options_.flip_edges && round + 1 < options_.rounds) {
            follow(surface, ties);
            report.flips +=
                flip_edges(network_, surface, ties, kFlipDeviations * deviation_ * deviation_, threads_);
        }
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
    if (points.fitted.size() < kLeastPoints || network.face_count() == 0) return report;
    Fit(network, std::move(points), options, threads).run(report, progress);
    return report;
}

}  // namespace neuralmesh
