// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Target space in, neural mesh out.
#include "reconstruct.h"

#include <chrono>
#include <string>

#include "distance.h"
#include "learner.h"

namespace neuralmesh {

namespace {

constexpr int kDistanceSamples = 20000;

/// The paper's start: a tetrahedron in the middle of the cloud, which lies around the origin.
Network tetrahedron() {
    constexpr float a = 0.1F;
    return Network({{a, a, a}, {-a, -a, a}, {-a, a, -a}, {a, -a, -a}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

void write_geometry(const Network& network, const Frame& frame, NeuralMesh& mesh) {
    std::vector<VertexId> index(static_cast<std::size_t>(network.slot_count()), -1);
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.alive(v)) continue;
        index[static_cast<std::size_t>(v)] = static_cast<VertexId>(mesh.positions.size());
        mesh.positions.push_back(frame.outside(network.position(v)));
    }
    mesh.faces = network.faces();
    for (Triangle& f : mesh.faces)
        for (VertexId& v : f) v = index[static_cast<std::size_t>(v)];
}

/// eq 7: a vertex is a feature if its counter exceeds C_nc x Mean(n_c).
void write_counters(const Learner& learner, const Settings& settings, NeuralMesh& mesh) {
    const Network& network = learner.network();
    const double mean = learner.mean_counter();
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.alive(v)) continue;
        const float n_c = learner.feature_counters().value(v);
        mesh.counters.push_back(n_c);
        mesh.features.push_back(static_cast<double>(n_c) > settings.feature_threshold * mean ? 1 : 0);
        mesh.report.feature_vertices += mesh.features.back();
    }
    mesh.report.mean_counter = mean;
}

void write_report(const Learner& learner, Report& report) {
    const Network& network = learner.network();
    report.vertices = network.vertex_count();
    report.faces = network.face_count();
    report.signals = learner.signals();
    report.splits = learner.splits();
    report.collapses = learner.collapses();
    report.genus = network.genus();
    report.boundary_loops = network.boundary_loop_count();
    report.components = network.component_count();
    if (report.stop_reason == StopReason::cut_short)
        report.warnings.push_back("The mesh was cut short at " + std::to_string(report.vertices) +
                                  " vertices: it did not grow on within the bound on signals. Lower "
                                  "signals_per_split or min_wins_per_split, or raise signals_per_collapse.");
}

}  // namespace

NeuralMesh reconstruct(const TargetSpace& target, const Settings& settings, Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    settings.check();
    NeuralMesh mesh;
    Learner learner(target, settings, tetrahedron());
    mesh.report.stop_reason = learner.run(progress);
    write_geometry(learner.network(), target.frame(), mesh);
    write_counters(learner, settings, mesh);
    write_report(learner, mesh.report);
    Random random(static_cast<std::uint64_t>(settings.random_seed) + 1);
    mesh.report.rms_error = 100 * rms_distance(target, learner.network(), kDistanceSamples, random);
    mesh.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return mesh;
}

}  // namespace neuralmesh
