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
#include "fit_redistribute.h"
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

/// Share of the vertices that one redistribution may move, and how many last rounds are without any.
constexpr double kShiftedShare = 0.05;
constexpr int kQuietRounds = 3;

/// Points and for each the vertex that it was last found near to.
struct Followed {
    std::vector<Vec> points;
    std::vector<VertexId> near;
};

struct Split {
    Followed fitted;
    Followed held;
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
    split.held.points.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(held));
    split.fitted.points.assign(all.begin() + static_cast<std::ptrdiff_t>(held), all.end());
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

std::vector<Hit> exact_hits(const Surface& surface, const Followed& followed, int threads) {
    const FaceTree tree(surface);
    std::vector<Hit> hits(followed.points.size());
    for_chunks(hits.size(), kChunk, threads, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) hits[i] = tree.nearest(followed.points[i]);
    });
    return hits;
}

std::vector<Hit> walked_hits(const Surface& surface, const Followed& followed, int threads) {
    std::vector<Hit> hits(followed.points.size());
    for_chunks(hits.size(), kChunk, threads, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            hits[i] = walk_to_nearest(surface, followed.points[i], followed.near[i]);
    });
    return hits;
}

/// Sorts the points by their faces, which also brings neighbours together in memory.
FacePoints by_face(const Surface& surface, Followed& followed, const std::vector<Hit>& hits) {
    FacePoints result;
    result.first.assign(surface.faces.size() + 1, 0);
    for (const Hit& hit : hits) ++result.first[index(hit.face) + 1];
    std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
    result.ties.resize(hits.size());
    std::vector<int> next(result.first.begin(), result.first.end() - 1);
    for (std::size_t i = 0; i < hits.size(); ++i)
        result.ties[index(next[index(hits[i].face)]++)] = {followed.points[i], 1, hits[i].foot};
    followed.near.resize(hits.size());
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        for (auto i = index(result.first[f]); i < index(result.first[f + 1]); ++i) {
            followed.points[i] = result.ties[i].point;
            followed.near[i] = nearest_corner(surface, {static_cast<int>(f), result.ties[i].foot});
        }
    }
    return result;
}

class Fit {
public:
    Fit(Network& network, Split points, const FitOptions& options, int threads)
        : network_(network), points_(std::move(points)), options_(options), threads_(threads) {}

    void run(FitReport& report, Progress& progress);

private:
    FacePoints tie(const Surface& surface, bool exact);
    double rms(const std::vector<Hit>& hits) const;
    double move(const FacePoints& ties, Surface& surface, bool first);
    bool shift_vertices(const Surface& surface, const FacePoints& ties, FitReport& report);
    void follow(const Surface& surface, FacePoints& ties) const;

    Network& network_;
    Split points_;
    const FitOptions& options_;
    int threads_;
    float outlier_ = 0;    ///< for the judgement: fixed from the start
    float deviation_ = 0;  ///< of the fitted points, robust
    float weight_ = 0;
    std::vector<VertexId> origin_;  ///< as FitReport::origin, of the current state
};

/// Ties every fitted point to its nearest face.
FacePoints Fit::tie(const Surface& surface, bool exact) {
    const std::vector<Hit> hits = exact ? exact_hits(surface, points_.fitted, threads_)
                                        : walked_hits(surface, points_.fitted, threads_);
    std::vector<float> distances(hits.size());
    for (std::size_t i = 0; i < hits.size(); ++i) distances[i] = std::sqrt(hits[i].foot.squared_distance);
    // Residuals are symmetric about the surface, so the median of their absolute values is the MAD.
    deviation_ = 1.4826F * median(std::move(distances));
    FacePoints ties = by_face(surface, points_.fitted, hits);
    if (!(outlier_ > 0)) outlier_ = std::max(kOutlierDeviations * deviation_, kOutlierEdges * mean_edge(surface));
    for (FacePoints::Tie& tie : ties.ties)
        tie.influence = std::min(1.0F, outlier_ * outlier_ / std::max(tie.foot.squared_distance, 1e-20F));
    return ties;
}

double Fit::rms(const std::vector<Hit>& hits) const {
    double sum = 0;
    for (const Hit& hit : hits)
        sum += static_cast<double>(std::min(hit.foot.squared_distance, outlier_ * outlier_));
    return std::sqrt(sum / static_cast<double>(hits.size()));
}

/// Solves for several bending weights, takes what brings the points held back closest. \return their error
double Fit::move(const FacePoints& ties, Surface& surface, bool first) {
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
        surface.at = moved[i];
        const double error = rms(walked_hits(surface, points_.held, threads_));
        if (i > 0 && error >= best_rms) continue;
        best = i;
        best_rms = error;
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

/// Moves vertices to where the error is and keeps the records. \return whether the mesh has changed
bool Fit::shift_vertices(const Surface& surface, const FacePoints& ties, FitReport& report) {
    const int most = std::max(1, static_cast<int>(kShiftedShare * static_cast<double>(network_.vertex_count())));
    const Redistribution done = redistribute(network_, surface, ties, most, threads_);
    if (done.merges.empty()) return false;
    std::vector<VertexId> heir(index(network_.slot_count()));
    std::iota(heir.begin(), heir.end(), 0);
    for (const Redistribution::Merge& merge : done.merges) heir[index(merge.gone)] = merge.into;
    for (Followed* followed : {&points_.fitted, &points_.held})
        for (VertexId& v : followed->near) v = heir[index(v)];
    for (const Redistribution::Insertion& insertion : done.insertions)
        origin_[index(insertion.added)] = origin_[index(insertion.beside)];
    report.moved_vertices += static_cast<int>(done.merges.size());
    return true;
}

void Fit::run(FitReport& report, Progress& progress) {
    const Network before = network_;
    Network best = network_;
    origin_ = report.origin;
    double best_rms = 0;
    for (int round = 0; round < options_.rounds; ++round) {
        const std::string text = "Fitting to the points, round " + std::to_string(round + 1);
        if (!progress(static_cast<double>(round) / options_.rounds, text.c_str())) break;
        Surface surface(network_);
        FacePoints ties = tie(surface, round == 0);
        if (round == 0) {
            const std::vector<Hit> hits = exact_hits(surface, points_.held, threads_);
            report.outlier_distance = static_cast<double>(outlier_);
            report.rms_before = report.rms_after = best_rms = rms(hits);
            by_face(surface, points_.held, hits);
        }
        if (options_.redistribute && round > 0 && round + kQuietRounds < options_.rounds &&
            shift_vertices(surface, ties, report)) {
            surface = Surface(network_);
            ties = tie(surface, false);
        }
        const double error = move(ties, surface, round == 0);
        if (error < best_rms) {
            best = network_;
            report.origin = origin_;
            best_rms = error;
            report.rounds = round + 1;
            report.bending_weight = static_cast<double>(weight_);
        }
        if (options_.flip_edges && round + 1 < options_.rounds) {
            follow(surface, ties);
            report.flips +=
                flip_edges(network_, surface, ties, kFlipDeviations * deviation_ * deviation_, threads_);
        }
    }
    // The walks of the rounds may miss a nearer face; the verdict is exact.
    best_rms = rms(exact_hits(Surface(best), points_.held, threads_));
    report.improved = best_rms < report.rms_before;
    if (!report.improved) {
        best = before;
        for (VertexId v = 0; v < before.slot_count(); ++v) report.origin[index(v)] = before.alive(v) ? v : -1;
    }
    report.rms_after = std::min(best_rms, report.rms_before);
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
    Fit(network, std::move(points), options, threads).run(report, progress);
    return report;
}

}  // namespace neuralmesh
