// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/output/vertex_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/face_tree.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

namespace {

// Every 28th of the 256 colours of magma, from the lightest down; linear interpolation between them is hard
// to tell from the original.
const std::array<Color, 7> kRamp = {Color{252, 253, 191}, Color{254, 201, 141}, Color{253, 149, 103},
                                    Color{241, 96, 93},   Color{205, 64, 113},  Color{159, 47, 127},
                                    Color{114, 31, 129}};

float percentile(std::vector<float> values, double fraction) {
    const auto rank = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

Color on_ramp(float t) {
    const float place = t * static_cast<float>(kRamp.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place), kRamp.size() - 2);
    const float x = place - static_cast<float>(i);
    Color color{};
    for (std::size_t k = 0; k < color.size(); ++k)
        color[k] = static_cast<unsigned char>(std::lround((1 - x) * kRamp[i][k] + x * kRamp[i + 1][k]));
    return color;
}

/// Means of so many points have less than a fifth of the deviation of their colours. Few vertices have more.
constexpr std::size_t kPointsPerVertex = 30, kFewestPoints = 100000;
/// Points between two reports of progress: about .02 s of one thread.
constexpr std::size_t kInBatch = 20000;
constexpr float kWhite = 255;

/// A point with its colour, and the area that it stands for.
struct Sample {
    Vector3 position;
    Vector3 color;
    float weight;
};

/// The target in batches. Each batch is spread over the whole surface, so that any number of them will do.
class Batches {
public:
    Batches(const TargetSpace& target, std::size_t wanted, Random& random)
        : target_(target), random_(random), count_((wanted + kInBatch - 1) / kInBatch) {
        if (!target.has_faces()) {
            stride_ = (target.positions().size() + kInBatch - 1) / kInBatch;
            count_ = std::min(count_, stride_);
        }
    }
    std::size_t count() const { return count_; }

    std::vector<Sample> batch(std::size_t number) {
        std::vector<Sample> samples;
        samples.reserve(kInBatch);
        if (target_.has_faces()) {
            for (std::size_t i = 0; i < kInBatch; ++i) {
                const TargetSpace::ColoredPoint point = target_.sample_colored(random_);
                samples.push_back({to_eigen(point.position), to_eigen(point.color), 1});
            }
            return samples;
        }
        for (std::size_t i = number; i < target_.positions().size(); i += stride_) {
            const Color& c = target_.colors()[i];
            samples.push_back(
                {to_eigen(target_.positions()[i]), Vector3(c[0], c[1], c[2]), target_.weight(i)});
        }
        return samples;
    }

private:
    const TargetSpace& target_;
    Random& random_;
    std::size_t count_;
    std::size_t stride_ = 0;  ///< of a cloud: batch b has the points b, b + stride_, b + 2 stride_, ...
};

/// Sums over the samples of the faces, and the means that follow from them. Sums instead of the samples, so
/// that memory depends on the mesh alone.
class ColorFit {
public:
    ColorFit(const Network& network, ThreadTeam& team)
        : network_(network),
          surface_(network),
          tree_(surface_, team),
          moments_(surface_.face_count(), Eigen::Matrix3f::Zero()),
          color_sums_(network.slot_count(), Vector3::Zero()) {}

    void add(const std::vector<Sample>& samples, ThreadTeam& team) {
        std::vector<Vector3> positions;
        positions.reserve(samples.size());
        for (const Sample& sample : samples) positions.push_back(sample.position);
        const std::vector<Hit> hits = tree_.nearest(positions, team);
        for (std::size_t i = 0; i < hits.size(); ++i) add(samples[i], hits[i]);
    }

    /// The colours of all slots, as real numbers.
    PerVertex<Vector3> colors() const {
        PerVertex<float> weights(network_.slot_count(), 0);
        for (int f = 0; f < surface_.face_count(); ++f)
            for (int k = 0; k < 3; ++k) weights[corner(f, k)] += moments_[f].row(k).sum();
        PerVertex<Vector3> result(network_.slot_count(), Vector3::Zero());
        for (int time = 0; time < 2; ++time) {
            const PerVertex<Vector3> rest = left_of_sums(result);
            for (const VertexId v : network_.vertices())
                if (weights[v] > 0) result[v] += rest[v] / weights[v];
        }
        fill_from_neighbours(weights, result);
        return result;
    }

private:
    VertexId corner(int f, int k) const { return surface_.faces[f][static_cast<std::size_t>(k)]; }

    void add(const Sample& sample, const Hit& hit) {
        const auto& w = hit.foot.weights;
        const Vector3 weights(w[0], w[1], w[2]);
        moments_[hit.face] += sample.weight * weights * weights.transpose();
        for (int k = 0; k < 3; ++k)
            color_sums_[corner(hit.face, k)] += sample.weight * weights[k] * sample.color;
    }

    /// The sums that the samples would have without the colours interpolated between the vertices.
    PerVertex<Vector3> left_of_sums(const PerVertex<Vector3>& colors) const {
        PerVertex<Vector3> rest = color_sums_;
        for (int f = 0; f < surface_.face_count(); ++f)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l) rest[corner(f, k)] -= moments_[f](k, l) * colors[corner(f, l)];
        return rest;
    }

    /// Ring by ring inwards from the vertices that have \p weights.
    void fill_from_neighbours(PerVertex<float>& weights, PerVertex<Vector3>& colors) const {
        std::vector<VertexId> bare;
        for (const VertexId v : network_.vertices())
            if (!(weights[v] > 0)) bare.push_back(v);
        while (!bare.empty()) {
            std::vector<VertexId> still_bare, filled;
            for (const VertexId v : bare)
                (take_from_neighbours(v, weights, colors) ? filled : still_bare).push_back(v);
            for (const VertexId v : filled) weights[v] = 1;
            if (filled.empty()) break;
            bare.swap(still_bare);
        }
        for (const VertexId v : bare) colors[v].setConstant(kWhite);
    }

    bool take_from_neighbours(VertexId v, const PerVertex<float>& weights, PerVertex<Vector3>& colors) const {
        int count = 0;
        Vector3 sum = Vector3::Zero();
        for (const VertexId u : network_.ring(v)) {
            if (!(weights[u] > 0)) continue;
            sum += colors[u];
            ++count;
        }
        if (count > 0) colors[v] = sum / static_cast<float>(count);
        return count > 0;
    }

    const Network& network_;
    Surface surface_;
    FaceTree tree_;
    /// Per face, the sum of the products of two barycentric coordinates of its samples.
    PerFace<Eigen::Matrix3f> moments_;
    PerVertex<Vector3> color_sums_;  ///< weighted by barycentric coordinates
};

unsigned char code(float value) {
    return static_cast<unsigned char>(std::lround(std::clamp(value, 0.0F, kWhite)));
}

}  // namespace

std::vector<Color> counter_colors(const std::vector<float>& counters) {
    if (counters.empty()) return {};
    const float low = percentile(counters, 0.02);
    const float high = percentile(counters, 0.98);
    std::vector<Color> colors;
    colors.reserve(counters.size());
    for (const float counter : counters) {
        const float t = high > low ? (counter - low) / (high - low) : 0.F;
        colors.push_back(on_ramp(std::clamp(t, 0.F, 1.F)));
    }
    return colors;
}

PerVertex<Color> cloud_colors(const TargetSpace& target, const Network& network, int threads, Random& random,
                              Progress& progress) {
    const auto vertices = static_cast<std::size_t>(network.vertex_count());
    Batches batches(target, std::max(kFewestPoints, kPointsPerVertex * vertices), random);
    ThreadTeam team(thread_count(threads));
    ColorFit fit(network, team);
    for (std::size_t i = 0; i < batches.count(); ++i) {
        fit.add(batches.batch(i), team);
        if (!progress(1, "Colouring")) break;
    }
    const PerVertex<Vector3> colors = fit.colors();
    PerVertex<Color> result(network.slot_count(), Color{255, 255, 255});
    for (const VertexId v : network.vertices())
        result[v] = {code(colors[v][0]), code(colors[v][1]), code(colors[v][2])};
    return result;
}

}  // namespace neuralmesh
