// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/target_space.h"

#include <vcg/space/line3.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "vcg_core/base/platform.h"
#include "vcg_core/cloud/surface_survey.h"

namespace neuralmesh {

namespace {

/// If the box of most points has a smaller share of the diagonal, the frame is centred on it.
constexpr double kSmallExtent = 1e-3;
/// If a larger share of the points are duplicates, they are removed.
constexpr double kMaxDuplicates = 0.1;
/// Points closer to a line, in diagonals, count as on it.
constexpr float kCollinear = 1e-6F;

/// By hashes of 64 bits, which take a tenth of the time to sort. That two points have the same by chance is
/// next to impossible, and would hardly change the share.
double share_of_repeated(const std::vector<vcg::Point3f>& points) {
    std::vector<std::uint64_t> hashes;
    hashes.reserve(points.size());
    for (const vcg::Point3f& p : points) {
        std::uint64_t hash = 0;
        for (int k = 0; k < 3; ++k)  // -0 is 0
            hash = (hash ^ bit_cast<std::uint32_t>(p[k] + 0.0F)) * 0x9e3779b97f4a7c15U;
        hashes.push_back(hash ^ hash >> 32);
    }
    std::sort(hashes.begin(), hashes.end());
    const auto distinct = std::unique(hashes.begin(), hashes.end()) - hashes.begin();
    return 1 - static_cast<double>(distinct) / static_cast<double>(points.size());
}

/// Those of \p values at \p places; none if there are no values.
template <class T>
std::vector<T> taken(const std::vector<T>& values, const std::vector<std::size_t>& places) {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(places.size());
    for (const std::size_t i : places) result.push_back(values[i]);
    return result;
}

vcg::Point3f interpolated(const vcg::Point3f& a, const vcg::Point3f& b, const vcg::Point3f& c, float u,
                          float v) {
    return a + (b - a) * u + (c - a) * v;
}

}  // namespace

AliasTable::AliasTable(const std::vector<double>& weights) : columns_(weights.size()) {
    const double mean =
        std::accumulate(weights.begin(), weights.end(), 0.0) / static_cast<double>(weights.size());
    std::vector<double> left(weights.size());  // of the probability, in columns
    std::vector<std::uint32_t> small;
    std::vector<std::uint32_t> large;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        left[i] = weights[i] / mean;
        columns_[i] = {0xffffffffU, i};
        (left[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t filled = small.back();
        const std::uint32_t giver = large.back();
        small.pop_back();
        columns_[filled] = {static_cast<std::uint32_t>(std::min(left[filled] * 0x1p32, 0x1p32 - 1)), giver};
        left[giver] -= 1 - left[filled];
        if (left[giver] >= 1) continue;
        large.pop_back();
        small.push_back(giver);
    }
}

vcg::Point3f Frame::inside(const vcg::Point3d& p) const {
    return vcg::Point3f::Construct((p - centre) / diagonal);
}

vcg::Point3d Frame::outside(const vcg::Point3f& p) const {
    return centre + vcg::Point3d::Construct(p) * diagonal;
}

void TargetSpace::set_frame(const vcg::Box3d& box, std::size_t not_finite, std::size_t count) {
    if (count == 0)
        throw InputError(
            "The layer has no points to learn: choose a layer with at least 4 distinct vertices.");
    if (not_finite > 0)
        throw InputError(std::to_string(not_finite) + " of the " + std::to_string(count) +
                         " points have coordinates that are not finite (NaN or infinite): remove them.");
    frame_.centre = box.min / 2 + box.max / 2;  // the sum of both could overflow
    frame_.diagonal = (box.max - box.min).Norm();
    if (box.min == box.max)
        throw InputError("All points of the layer are equal: a surface needs at least 4 distinct points.");
    if (!((frame_.diagonal - frame_.diagonal) == 0 && frame_.diagonal > 1e-150))
        throw InputError(
            "The layer's bounding box is too large or too small for double precision: scale it first.");
}

void TargetSpace::centre_on(const vcg::Box3d& most) {
    const double diagonal = (most.max - most.min).Norm();
    off_centre_ = diagonal > 0 && diagonal < kSmallExtent * frame_.diagonal;
    if (off_centre_) frame_.centre = most.min / 2 + most.max / 2;
}

std::string TargetSpace::lack_of_spread() const {
    const vcg::Point3f& a = positions_.front();
    const auto far = std::max_element(
        positions_.begin(), positions_.end(),
        [&](const auto& p, const auto& q) { return (p - a).SquaredNorm() < (q - a).SquaredNorm(); });
    const vcg::Line3f line(a, *far - a);
    std::vector<vcg::Point3f> distinct;
    bool collinear = true;
    for (const vcg::Point3f& p : positions_) {
        if (distinct.size() < 4 && std::find(distinct.begin(), distinct.end(), p) == distinct.end())
            distinct.push_back(p);
        collinear = collinear && vcg::Distance(line, p) < kCollinear;
        if (!collinear && distinct.size() == 4) return "";
    }
    if (distinct.size() < 4)
        return "The layer has only " + std::to_string(distinct.size()) +
               " distinct points: a surface needs at least 4.";
    if (off_centre_)
        return "All points of the layer but a few lie, compared with its bounding box, in one place: delete "
               "the few that lie far away.";
    return "All points of the layer lie on one straight line: a surface cannot be learned from it. Choose a "
           "layer whose points surround a surface.";
}

void TargetSpace::check_spread() const {
    const std::string lack = lack_of_spread();
    if (!lack.empty()) throw InputError(lack);
}

void TargetSpace::accumulate_areas() {
    double sum = 0;
    cumulative_area_.reserve(positions_.size() / 3);
    for (std::size_t i = 0; i + 2 < positions_.size(); i += 3) {
        const vcg::Point3f n = (positions_[i + 1] - positions_[i]) ^ (positions_[i + 2] - positions_[i]);
        sum += static_cast<double>(n.Norm());
        cumulative_area_.push_back(sum);
    }
    if (!(sum > 0))
        throw InputError(
            "The faces of the layer have no area to draw samples from: switch 'Draw from faces' off to learn "
            "its vertices instead.");
}

TargetSpace TargetSpace::drawn_by(Sampler draw, std::size_t count) {
    std::vector<vcg::Point3d> drawn(count);
    Random random(0);
    for (vcg::Point3d& p : drawn) p = draw(random);
    TargetSpace target = points(count, [&](std::size_t i) { return drawn[i]; });
    target.sampler_ = std::move(draw);
    return target;
}

void TargetSpace::set_normals(std::vector<PackedNormal> normals) {
    const bool any =
        std::any_of(normals.begin(), normals.end(), [](const PackedNormal& n) { return n != kNoNormal; });
    normals_ = any ? std::move(normals) : std::vector<PackedNormal>();
}

std::optional<TargetSpace> TargetSpace::without(const std::vector<std::uint8_t>& left_out) const {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < positions_.size(); ++i)
        if (left_out[i] == 0) kept.push_back(i);
    TargetSpace rest;
    rest.positions_ = taken(positions_, kept);
    rest.colors_ = taken(colors_, kept);
    rest.normals_ = taken(normals_, kept);
    vcg::Box3d box;
    for (const vcg::Point3f& p : rest.positions_) box.Add(vcg::Point3d::Construct(p));
    if (box.IsNull() || box.min == box.max) return std::nullopt;
    const Frame inner{(box.min + box.max) / 2, (box.max - box.min).Norm()};
    for (vcg::Point3f& p : rest.positions_) p = inner.inside(vcg::Point3d::Construct(p));
    if (!rest.lack_of_spread().empty()) return std::nullopt;
    rest.frame_ = {frame_.centre + inner.centre * frame_.diagonal, inner.diagonal * frame_.diagonal};
    return rest;
}

std::optional<TargetSpace> TargetSpace::each_place_once() const {
    if (is_exact() || !(share_of_repeated(positions_) > kMaxDuplicates)) return std::nullopt;
    std::vector<std::size_t> kept(positions_.size());  // of equal points the first
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    std::sort(kept.begin(), kept.end(), [this](std::size_t i, std::size_t j) {
        const vcg::Point3f &p = positions_[i], &q = positions_[j];
        return std::tie(p[0], p[1], p[2], i) < std::tie(q[0], q[1], q[2], j);
    });
    const auto equal = [this](std::size_t i, std::size_t j) { return positions_[i] == positions_[j]; };
    kept.erase(std::unique(kept.begin(), kept.end(), equal), kept.end());
    TargetSpace once;
    once.frame_ = frame_;
    once.positions_ = taken(positions_, kept);
    once.colors_ = taken(colors_, kept);
    once.normals_ = taken(normals_, kept);
    return once;
}

std::optional<TargetSpace> TargetSpace::evenly(const CloudSurvey& survey) const {
    std::vector<float> areas = survey.areas_if_uneven();
    if (areas.empty()) return std::nullopt;
    std::vector<std::size_t> order;
    for (NearestPoints::Place p = 0; p < survey.cloud.size(); ++p) order.push_back(survey.cloud.index(p));
    TargetSpace even;
    even.frame_ = frame_;
    even.weights_ = std::move(areas);
    even.positions_ = taken(positions_, order);
    even.colors_ = taken(colors_, order);
    even.normals_ = taken(normals_, order);
    std::vector<double> of_runs;
    for (std::size_t i = 0; i < even.positions_.size(); i += CloudSurvey::kRun) {
        const std::size_t points = std::min(CloudSurvey::kRun, even.positions_.size() - i);
        of_runs.push_back(static_cast<double>(even.weight(i)) * static_cast<double>(points));
    }
    even.runs_ = AliasTable(of_runs);
    return even;
}

float TargetSpace::weight(std::size_t i) const {
    return weights_.empty() ? 1.0F : weights_[i / CloudSurvey::kRun];
}

TargetSpace TargetSpace::moved(Move move) const {
    TargetSpace result = *this;
    result.move_ = std::move(move);
    return result;
}

TargetSpace TargetSpace::moved_in_batches(const std::function<void(Span<vcg::Point3f>)>& move) const {
    constexpr std::size_t kBatch = 100000;
    TargetSpace result = *this;
    vcg::Point3f* points = result.positions_.data();
    const std::size_t count = positions_.size();
    for (std::size_t begin = 0; begin < count; begin += kBatch)
        move({points + begin, points + std::min(begin + kBatch, count)});
    return result;
}

vcg::Point3f TargetSpace::sample(Random& random) const {
    if (!is_exact()) return positions_[draw_point(random)];
    return move_ ? move_(draw_exact(random)) : draw_exact(random);
}

void TargetSpace::sample(Random& random, int count, std::vector<vcg::Point3f>& samples) const {
    samples.clear();
    if (is_exact()) {
        for (int i = 0; i < count; ++i) samples.push_back(sample(random));
        return;
    }
    constexpr int kAtATime = 32;  // reads that the processor has under way
    std::array<std::size_t, kAtATime> drawn;
    for (int i = 0; i < count; i += kAtATime) {
        const auto end = drawn.begin() + std::min(kAtATime, count - i);
        for (auto at = drawn.begin(); at != end; ++at) prefetch(&positions_[*at = draw_point(random)]);
        for (auto at = drawn.begin(); at != end; ++at) samples.push_back(positions_[*at]);
    }
}

std::size_t TargetSpace::draw_point(Random& random) const {
    if (!is_weighted()) return random.below(static_cast<std::uint32_t>(positions_.size()));
    const std::size_t first = runs_.draw(random) * CloudSurvey::kRun;
    const std::size_t points = std::min(CloudSurvey::kRun, positions_.size() - first);
    return first + random.below(static_cast<std::uint32_t>(points));
}

vcg::Point3f TargetSpace::draw_exact(Random& random) const {
    if (!has_faces()) return frame_.inside(sampler_(random));
    const FacePoint at = draw_from_faces(random);
    return interpolated(positions_[at.corner], positions_[at.corner + 1], positions_[at.corner + 2], at.u,
                        at.v);
}

TargetSpace::ColoredPoint TargetSpace::sample_colored(Random& random) const {
    const FacePoint at = draw_from_faces(random);
    const auto color = [&](std::size_t k) {
        const Color& c = colors_[at.corner + k];
        return vcg::Point3f(c[0], c[1], c[2]);
    };
    return {
        interpolated(positions_[at.corner], positions_[at.corner + 1], positions_[at.corner + 2], at.u, at.v),
        interpolated(color(0), color(1), color(2), at.u, at.v)};
}

TargetSpace::FacePoint TargetSpace::draw_from_faces(Random& random) const {
    const double fraction = (random.bits() + 0.5) * 0x1p-32;
    const auto it = std::upper_bound(cumulative_area_.begin(), cumulative_area_.end(),
                                     fraction * cumulative_area_.back());
    const auto face =
        static_cast<std::size_t>(std::min(it, cumulative_area_.end() - 1) - cumulative_area_.begin());
    float u = random.unit();
    float v = random.unit();
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    return {3 * face, u, v};
}

}  // namespace neuralmesh
