// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/layers.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace neuralmesh {

namespace {

/// Between these spreads layers begin to matter, in mean edges. Below, learning hardly follows them.
constexpr float kNear = 0.15F, kFar = 0.25F;

/// 0 up to \p low, 1 from \p high on.
float ramp(float x, float low, float high) {
    return std::min(std::max((x - low) / (high - low), 0.0F), 1.0F);
}

/// The spreads around all vertices, in mean edges, but for the extreme tenth and hundredth.
struct Spreads {
    float narrow, median, wide;
};

Spreads spreads_of(const Network& network, const Surface& surface, const PerVertex<float>& variances) {
    constexpr std::size_t kTenth = 10, kHundredth = 100;
    std::vector<float> spreads;
    for (const VertexId v : network.vertices()) spreads.push_back(std::sqrt(variances[v]));
    std::sort(spreads.begin(), spreads.end());
    const std::size_t n = spreads.size();
    const float edge = mean_edge_length(surface);
    return {spreads[n / kTenth] / edge, spreads[n / 2] / edge, spreads[n - 1 - n / kHundredth] / edge};
}

/// Whether the points fill a space rather than lie along a surface. Virtual scans of level 3 have median
/// spreads of .27 to .36 with 2,000 to 12,000 vertices.
float filling(const Spreads& spreads) {
    constexpr float kWidest = 0.4F, kFilling = 0.45F;
    return ramp(spreads.median, kWidest, kFilling);
}

/// Wide / narrow that points without layers come to by chance. A spread that is estimated from n points has a
/// relative deviation of 1 / sqrt(2 n).
float unevenness_by_chance(float points_per_vertex) {
    // Of the tenth and the hundredth that spreads_of() leaves out from the mean, in deviations.
    constexpr float kTenth = 1.28F, kHundredth = 2.33F;
    // Vertices whose points are as good as those that local_variances() takes around one. Independent noise
    // of .3 % of the diagonal comes to ratios of 1.26 with 18 points per vertex and 1.42 to 1.49 with 9.
    constexpr float kVertices = 5.4F;
    const float deviation = 1 / std::sqrt(2 * kVertices * points_per_vertex);
    return (1 + kHundredth * deviation) / (1 - kTenth * deviation);
}

/// Wide / narrow without what is chance. Independent deviations add up as their squares do.
float unevenness(const Spreads& spreads, float points_per_vertex) {
    const float all = spreads.wide / spreads.narrow - 1;
    const float chance = unevenness_by_chance(points_per_vertex) - 1;
    return 1 + std::sqrt(std::max(all * all - chance * chance, 0.0F));
}

}  // namespace

float layering(const Network& network, const Surface& surface, const PerVertex<float>& variances,
               float points_per_vertex) {
    // Ratio of the widest to the narrowest spread. Independent noise of .3 and .6 % of the diagonal: 1.19 to
    // 1.30; virtual scans of level 3: 1.55 to 1.66.
    constexpr float kEven = 1.35F, kUneven = 1.5F;
    // Wider spreads fold the mesh, whether by layers or by chance, and what takes layers out takes folds out:
    // with noise of .6 % and 10,000 vertices, fandisk would have 2.7 times the error.
    constexpr float kFolding = 0.32F;
    const Spreads spreads = spreads_of(network, surface, variances);
    if (!(spreads.narrow > 0)) return 0;
    const float ratio =
        spreads.median > kFolding ? spreads.wide / spreads.narrow : unevenness(spreads, points_per_vertex);
    return ramp(spreads.median, kNear, kFar) * (1 - filling(spreads)) * ramp(ratio, kEven, kUneven);
}

PerVertex<float> local_layering(const Network& network, const Surface& surface,
                                const PerVertex<float>& variances) {
    // Single vertices differ by chance, and by the bends of the surface. Chosen on virtual scans of level 2
    // with 2,000 vertices, by tests/experiments/accuracy/scan_table.py.
    constexpr float kEven = 1.35F, kUneven = 1.8F;
    // Of the narrowest tenth, in mean edges: .13 to .18 on those scans, .24 to .27 where points fill a space.
    constexpr float kRest = 0.2F;
    // Ratio of the median to the narrowest tenth: 1.2 to 1.53 on scans of levels 1 and 2. On folds that a
    // mesh is too coarse to follow, 1.77 to 1.94 (a brain), 1.66 to 1.8 (armadillo) and 2.1 to 2.5 (feline).
    constexpr float kEvenRest = 1.55F, kUnevenRest = 1.75F;
    PerVertex<float> result(variances.size(), 0);
    const Spreads spreads = spreads_of(network, surface, variances);
    if (!(spreads.narrow > 0)) return result;
    const float even_rest = 1 - ramp(spreads.median / spreads.narrow, kEvenRest, kUnevenRest);
    const float on_a_part = even_rest * (1 - ramp(spreads.narrow, kNear, kRest));
    const float edge = mean_edge_length(surface);
    for (const VertexId v : network.vertices()) {
        const float spread = std::sqrt(variances[v]) / edge;
        result[v] = on_a_part * ramp(spread, kNear, kFar) * ramp(spread / spreads.narrow, kEven, kUneven);
    }
    return result;
}

double mean_squared_gap(const Surface& surface) {
    // Equilateral triangles of a sphere that meet at the angle t leave a gap of t * sqrt(3) / 4 edges, and
    // deviate by t from the normal at their common corner. The sum of such unit normals is shorter than their
    // number by the share t^2 / 2.
    constexpr double kSquaredGap = 2 * 3.0 / 16;
    double sum = 0;
    int vertices = 0;
    for (VertexId v = 0; v < surface.positions.size(); ++v) {
        const Span<const int> faces = surface.faces_around(v);
        if (faces.size() == 0) continue;
        Vector3 normal = Vector3::Zero();
        for (const int f : faces) normal += unit_normal(surface, f);
        sum += 1 - static_cast<double>(normal.norm()) / static_cast<double>(faces.size());
        ++vertices;
    }
    const auto edge = static_cast<double>(mean_edge_length(surface));
    return kSquaredGap * edge * edge * sum / std::max(vertices, 1);
}

}  // namespace neuralmesh
