// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Predicted gains of flips and splits and costs of collapses, against those measured after the operation.
#include "tests/unit/fit/fit_scene.h"
#include "vcg_core/fit/edge_flips.h"
#include "vcg_core/fit/face_rules.h"
#include "vcg_core/fit/redistribute.h"

namespace neuralmesh::fit_costs_test {

/// A rough torus in a dense cloud: about 60 points per face, so no face lacks any.
FitScene torus_scene() { return {network_of(shapes::torus_grid(20, 10), 0.03), shapes::torus_cloud(24000)}; }

std::vector<int> faces_with_edge(const Surface& surface, VertexId a, VertexId b) {
    std::vector<int> result;
    for (int f : surface.faces_around(a)) {
        const Triangle& face = surface.faces[f];
        if (std::find(face.begin(), face.end(), b) != face.end()) result.push_back(f);
    }
    return result;
}

/// Flips the edge, and returns by how much the sum of squared distances drops.
double measured_drop(const FitScene& scene, VertexId a, VertexId b) {
    const std::vector<Vector3> points = points_of(scene.points, faces_with_edge(scene.surface, a, b));
    Network flipped = scene.network;
    flipped.flip(a, b);
    EXPECT_EQ(flipped.validate(), "");
    return squared_distances(points, new_faces(flipped, scene.network), scene.network) -
           squared_distances(points, new_faces(scene.network, flipped), flipped);
}

/// Whether a face made by the flip is a sliver or turns away from a face that was there.
bool flip_harms(const FitScene& scene, VertexId a, VertexId b) {
    Network flipped = scene.network;
    flipped.flip(a, b);
    const Surface after(flipped);
    Vector3 old_normal = Vector3::Zero();
    for (int f : faces_with_edge(scene.surface, a, b)) old_normal += unit_normal(scene.surface, f);
    for (const Triangle& face : new_faces(scene.network, flipped)) {
        const Vector3 normal = area_vector(face, after.positions).normalized();
        if (kFlipRules.turns_over(old_normal.normalized(), normal)) return true;
        if (triangle_quality(after.positions[face[0]], after.positions[face[1]], after.positions[face[2]]) <
            kFlipRules.sliver)
            return true;
        for (std::size_t k = 0; k < 3; ++k)
            if (kFlipRules.is_folded(normal.dot(normal_beyond(after, face[k], face[(k + 1) % 3]))))
                return true;
    }
    return false;
}

TEST(FindFlips, GainIsTheMeasuredDrop) {
    const FitScene scene = torus_scene();
    constexpr float kLeastGain = 1e-4F;
    const std::vector<EdgeFlip> flips =
        find_flips(scene.network, scene.surface, scene.points, kLeastGain, one_thread());
    PerVertex<char> found(scene.network.slot_count() * scene.network.slot_count(), 0);
    int with_gain = 0;
    float last = std::numeric_limits<float>::max();
    for (const EdgeFlip& flip : flips) {
        EXPECT_LE(flip.gain, last);
        last = flip.gain;
        found[flip.a * scene.network.slot_count() + flip.b] = 1;
        if (flip.gain == 0) continue;
        ++with_gain;
        EXPECT_NEAR(flip.gain, measured_drop(scene, flip.a, flip.b), 1e-5 + 1e-3 * flip.gain);
    }
    EXPECT_GT(with_gain, 30);
    for (VertexId a : scene.network.vertices())
        for (VertexId b : scene.network.ring(a)) {
            if (b < a || found[a * scene.network.slot_count() + b] != 0 || !scene.network.can_flip(a, b))
                continue;
            EXPECT_TRUE(measured_drop(scene, a, b) < kLeastGain + 1e-5 || flip_harms(scene, a, b))
                << a << ' ' << b;
        }
}

TEST(FlipEdges, FlipsApartAndLeavesBarredVerticesAlone) {
    const FitScene scene = torus_scene();
    ThreadTeam team(2);
    const std::vector<EdgeFlip> flips = find_flips(scene.network, scene.surface, scene.points, 0, team);
    PerVertex<char> barred(scene.network.slot_count(), 0);
    for (VertexId v = 0; v < barred.size(); v += 5) barred[v] = 1;
    Network network = scene.network;
    const int flipped = flip_edges(network, flips, barred);
    EXPECT_GT(flipped, 10);
    EXPECT_EQ(network.validate(), "");
    // Two new faces for each flip: none was flipped again.
    EXPECT_EQ(new_faces(scene.network, network).size(), 2 * static_cast<std::size_t>(flipped));
    for (VertexId v = 0; v < barred.size(); v += 5)
        EXPECT_EQ(network.ring(v).valence, scene.network.ring(v).valence);
    EXPECT_EQ(flip_edges(network, flips, PerVertex<char>(barred.size(), 1)), 0);
}

TEST(FindCollapses, CostIsTheMeasuredRise) {
    const FitScene scene = torus_scene();
    const std::vector<Collapse> collapses = collapses_of(scene);
    ASSERT_EQ(static_cast<int>(collapses.size()), scene.network.slot_count());
    int measured = 0;
    int small_stars = 0;
    double sum_of_ratios = 0;
    float last = 0;
    for (const Collapse& collapse : collapses) {
        EXPECT_GE(collapse.cost, last);
        last = collapse.cost;
        if (collapse.into < 0) continue;
        ASSERT_TRUE(scene.network.can_collapse(collapse.gone, collapse.into));
        const Span<const int> star = scene.surface.faces_around(collapse.gone);
        const std::vector<Vector3> points = points_of(scene.points, {star.begin(), star.end()});
        Network after = scene.network;
        after.collapse(collapse.gone, collapse.into);
        ASSERT_EQ(after.validate(), "");
        const double rise = squared_distances(points, new_faces(scene.network, after), after) -
                            squared_distances(points, new_faces(after, scene.network), scene.network);
        // Every point of a star of less than 128 points is measured, else some of them.
        if (points.size() < 128) {
            EXPECT_NEAR(collapse.cost, std::max(rise, 0.0), 1e-5 + 1e-3 * std::abs(rise));
            ++small_stars;
        }
        if (rise > 0) {
            sum_of_ratios += static_cast<double>(collapse.cost) / rise;
            ++measured;
        }
    }
    EXPECT_GT(measured, 30);
    EXPECT_NEAR(sum_of_ratios / measured, 1, 0.1);
    EXPECT_LT(small_stars, scene.network.slot_count());
}

/// A flat grid, and points on a gentle wave above it.
FitScene wave_scene() {
    constexpr double kTurns = 6 * shapes::kPi;
    Random random(7);
    Cloud cloud;
    for (int i = 0; i < 40000; ++i) {
        const double x = shapes::unit(random) - 0.5;
        const double y = shapes::unit(random) - 0.5;
        cloud.emplace_back(x, y, 0.01 * std::sin(kTurns * x) * std::cos(kTurns * y));
    }
    return {network_of(shapes::grid(12, 12)), cloud};
}

/// A collapse that costs nothing, away from the edge to be split.
Collapse free_collapse(const Network& network, const EdgeSplit& split) {
    const vcg::Point3f middle = (network.position(split.a) + network.position(split.b)) / 2;
    for (VertexId v : network.vertices())
        if ((network.position(v) - middle).Norm() > 0.3F && network.ring(v).open == 0 &&
            network.can_collapse(v, network.ring(v)[0]))
            return {0, v, network.ring(v)[0]};
    return {Support::kForbidden, 0, -1};
}

TEST(FindSplits, GainIsTheMeasuredDrop) {
    const FitScene scene = wave_scene();
    const double edge = static_cast<double>(mean_edge_length(scene.surface));
    const auto least = static_cast<float>(1e-3 * edge * edge);
    const std::vector<EdgeSplit> splits =
        find_splits(scene.network, scene.surface, scene.points, least, one_thread());
    ASSERT_GT(splits.size(), 50U);
    int measured = 0;
    float last = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < splits.size(); ++i) {
        const EdgeSplit& split = splits[i];
        EXPECT_LE(split.gain, last);
        last = split.gain;
        // The gain of a boundary edge counts the points that are missing beyond it, too.
        const Ring& ring = scene.network.ring(split.a);
        const bool on_boundary = ring.open != 0 && (ring[0] == split.b || ring[ring.valence - 1] == split.b);
        if (i % 5 != 0 || on_boundary) continue;
        // A collapse far away that costs nothing makes a pair with the split.
        Network after = scene.network;
        if (redistribute(after, {free_collapse(scene.network, split)}, {split}, 1,
                         PerVertex<char>(after.slot_count(), 0))
                .empty())
            continue;
        ++measured;
        ASSERT_EQ(after.validate(), "");
        const std::vector<Vector3> points =
            points_of(scene.points, faces_with_edge(scene.surface, split.a, split.b));
        const double drop = squared_distances(points, new_faces(after, scene.network), scene.network) -
                            squared_distances(points, new_faces(scene.network, after), after);
        // The gain is that of the linearised distances.
        EXPECT_NEAR(split.gain, drop, 0.2 * drop);
    }
    EXPECT_GT(measured, 10);
}

/// The scene of a torus whose points weigh \p upper above the plane z = 0 and \p lower below it.
FitScene weighted_torus_scene(float upper, float lower) {
    FitScene scene = torus_scene();
    for (const Vector3& p : scene.tracked.points) scene.tracked.weights.push_back(p[2] > 0 ? upper : lower);
    scene.points = group_by_face(scene.surface, scene.tracked,
                                 nearest_by_tree(scene.surface, scene.tracked, one_thread()), one_thread());
    return scene;
}

bool is_above(const FitScene& scene, VertexId v) {
    const auto high = [&](VertexId u) { return scene.network.position(u)[2] > 0.05F; };
    const Ring& ring = scene.network.ring(v);
    return high(v) && std::all_of(ring.begin(), ring.end(), high);
}

TEST(Weights, ScaleCostsAndGainsWhereTheyAre) {
    const FitScene even = weighted_torus_scene(1, 1);
    const FitScene uneven = weighted_torus_scene(4, 0.5F);
    const auto splits = [&](const FitScene& scene, float least) {
        return find_splits(scene.network, scene.surface, scene.points, least, one_thread());
    };
    const std::vector<EdgeSplit> unweighted = splits(even, 0.002F);
    const std::vector<EdgeSplit> weighted = splits(uneven, 0.002F);
    EXPECT_NEAR(static_cast<double>(weighted.size()), static_cast<double>(unweighted.size()),
                0.05 * static_cast<double>(unweighted.size()))
        << "the least gain is that of a point, whatever it weighs";
    int compared = 0;
    for (const EdgeSplit& split : weighted)
        for (const EdgeSplit& other : unweighted) {
            if (split.a != other.a || split.b != other.b || !is_above(even, split.a)) continue;
            EXPECT_NEAR(split.gain, 4 * other.gain, 1e-4 * split.gain);
            ++compared;
        }
    EXPECT_GT(compared, 10);
    compared = 0;
    for (const Collapse& collapse : collapses_of(uneven))
        for (const Collapse& other : collapses_of(even)) {
            if (collapse.gone != other.gone || collapse.into < 0 || collapse.into != other.into ||
                !is_above(even, other.gone) || other.cost <= 0)
                continue;
            EXPECT_NEAR(collapse.cost, 4 * other.cost, 1e-3 * collapse.cost);
            ++compared;
        }
    EXPECT_GT(compared, 3);
}

}  // namespace neuralmesh::fit_costs_test
