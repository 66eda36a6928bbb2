// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The crease measure on shapes whose creases are known.
#include "vcg_core/learning/crease_measure.h"

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/learning/learner.h"

namespace neuralmesh::crease_measure_test {

/// A network that has learned a cloud, with its crease values.
struct Learned {
    Learned(const Cloud& cloud, int vertices) : target(target_of(cloud)) {
        options.grow_to = vertices;
        options.utility_counter = kSignalCount;
        options.settling_signals_per_vertex = 0;
        Learner learner(target, options, network_of(shapes::scaled(shapes::icosphere(1), 0.3)));
        learner.run(100, unwatched());
        CreaseMeasure measure;
        Random random(7);
        for (int sweep = 0; sweep < 30; ++sweep) {
            for (int i = 0; i < vertices; ++i) learner.basic_step(target.sample(random));
            if (sweep >= 6) measure.observe(learner.network(), one_thread());
        }
        network = learner.network();
        values = measure.values(network, network, {}, one_thread());
    }

    TargetSpace target;
    LearnerOptions options;
    Network network;
    PerVertex<float> values;
};

/// Distance of \p p from the nearest edge of the cube, whose edges have length 1 / sqrt(3) in the core's
/// frame.
double distance_from_cube_edge(const vcg::Point3f& p, double half) {
    double off[3];
    for (int k = 0; k < 3; ++k) off[k] = half - std::abs(static_cast<double>(p[k]));
    std::sort(off, off + 3, [](double a, double b) { return std::abs(a) < std::abs(b); });
    return std::sqrt(off[0] * off[0] + off[1] * off[1]);
}

struct Hits {
    int edges = 0, found = 0, faces = 0, wrong = 0;
};

/// Counts vertices within 0.4 edge lengths of a cube's edge, which must be above 1, and beyond 1.2, which
/// must be below. Between lies the transition.
Hits hits_on_cube(const Learned& run, double half) {
    Hits hits;
    const auto edge = static_cast<double>(mean_edge_length(Surface(run.network)));
    for (const VertexId v : run.network.vertices()) {
        const double d = distance_from_cube_edge(run.network.position(v), half) / edge;
        const bool above = run.values[v] > 1;
        if (d < 0.4) {
            ++hits.edges;
            hits.found += above;
        } else if (d > 1.2) {
            ++hits.faces;
            hits.wrong += above;
        }
    }
    return hits;
}

TEST(CreaseMeasure, FindsTheEdgesOfACube) {
    const Learned run(shapes::box_cloud(40000), 1500);
    const Hits hits = hits_on_cube(run, 0.5 / std::sqrt(3.0));
    ASSERT_GT(hits.edges, 80);
    ASSERT_GT(hits.faces, 500);
    EXPECT_GT(hits.found, 0.95 * hits.edges);
    EXPECT_EQ(hits.wrong, 0);
}

/// Noise with a standard deviation of a third of the edges of the mesh, where their normals alone say little.
TEST(CreaseMeasure, FindsTheEdgesOfANoisyCube) {
    const Learned run(shapes::box_cloud(40000, {1, 1, 1}, 0.055), 1500);
    const Hits hits = hits_on_cube(run, 0.5 / run.target.frame().diagonal);
    ASSERT_GT(hits.edges, 80);
    ASSERT_GT(hits.faces, 500);
    EXPECT_GT(hits.found, 0.85 * hits.edges);
    EXPECT_LT(hits.wrong, 0.02 * hits.faces);
}

TEST(CreaseMeasure, FindsNothingOnASphere) {
    for (const double noise : {0.0, 0.02}) {
        const Learned run(shapes::sphere_cloud(40000, noise), 1500);
        EXPECT_LT(*std::max_element(run.values.begin(), run.values.end()), 0.9F) << noise;
    }
}

TEST(CreaseMeasure, FindsNothingOnAPlane) {
    const Network network = network_of(shapes::grid(12, 9));
    CreaseMeasure measure;
    measure.observe(network, one_thread());
    for (const float value : measure.values(network, network, {}, one_thread())) EXPECT_LT(value, 1e-3F);
}

TEST(CreaseMeasure, IsIndifferentToScale) {
    const Learned run(shapes::box_cloud(20000), 500);
    Network large = run.network;
    for (const VertexId v : run.network.vertices()) large.set_position(v, run.network.position(v) * 8);
    CreaseMeasure of_small;
    CreaseMeasure of_large;
    of_small.observe(run.network, one_thread());
    of_large.observe(large, one_thread());
    EXPECT_EQ(of_small.moments(), 1);
    const PerVertex<float> a = of_small.values(run.network, run.network, {}, one_thread());
    const PerVertex<float> b = of_large.values(large, large, {}, one_thread());
    EXPECT_GT(*std::max_element(a.begin(), a.end()), 1.0F);
    for (VertexId v = 0; v < a.size(); ++v) EXPECT_NEAR(a[v], b[v], 1e-4F);
}

/// Of a round that somebody has stopped before its first moment.
TEST(CreaseMeasure, IsTheSameWithOneOfNoMoments) {
    const Network network = network_of(shapes::icosphere(2));
    CreaseMeasure moments;
    moments.observe(network, one_thread());
    const PerVertex<float> before = moments.values(network, network, {}, one_thread());
    moments.add(CreaseMeasure());
    const PerVertex<float> after = moments.values(network, network, {}, one_thread());
    EXPECT_TRUE(std::equal(before.begin(), before.end(), after.begin(), after.end()));
}

/// If nothing was observed, the present positions are measured. A vertex of the result has the planes of its
/// source, but its own distance from the line in which they meet.
TEST(CreaseMeasure, MeasuresAMovedVertexWhereItLies) {
    const Learned run(shapes::box_cloud(40000), 1500);
    const CreaseMeasure none;
    ThreadTeam team(1), three(3);
    CreaseMeasure one, by_three;
    one.observe(run.network, team);
    by_three.observe(run.network, three);
    EXPECT_EQ(one.values(run.network, run.network, {}, team),
              by_three.values(run.network, run.network, {}, three));
    EXPECT_EQ(none.values(run.network, run.network, {}, team),
              one.values(run.network, run.network, {}, team));

    const double half = 0.5 / std::sqrt(3.0);
    PerVertex<VertexId> source(run.network.slot_count());
    VertexId nearest = -1;
    for (VertexId v = 0; v < run.network.slot_count(); ++v) {
        source[v] = v;
        const vcg::Point3f p = run.network.position(v);
        // In the middle of an edge along x.
        if (std::abs(p[0]) > 0.1F || p[1] < 0 || p[2] < 0) continue;
        if (nearest < 0 ||
            distance_from_cube_edge(p, half) < distance_from_cube_edge(run.network.position(nearest), half))
            nearest = v;
    }
    ASSERT_GE(nearest, 0);
    Network moved = run.network;
    moved.set_position(nearest,
                       moved.position(nearest) - vcg::Point3f(0, mean_edge_length(Surface(moved)), 0));
    const float there = one.values(run.network, run.network, {}, team)[nearest];
    const float aside = one.values(run.network, moved, source, team)[nearest];
    EXPECT_GT(there, 1.0F);
    EXPECT_LT(aside, 0.5F * there);
}

}  // namespace neuralmesh::crease_measure_test
