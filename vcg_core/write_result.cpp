// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/write_result.h"

#include <algorithm>
#include <string>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/feature_measures.h"
#include "vcg_core/fit/point_errors.h"
#include "vcg_core/output/crease_lines.h"
#include "vcg_core/output/vertex_colors.h"

namespace neuralmesh {

namespace {

constexpr int kDistanceSamples = 20000;  ///< points at which the error is measured

void write_geometry(const Network& network, const Frame& frame, NeuralMesh& mesh) {
    PerVertex<VertexId> index(network.slot_count(), -1);
    for (const VertexId v : network.vertices()) {
        index[v] = static_cast<VertexId>(mesh.positions.size());
        mesh.positions.push_back(frame.outside(network.position(v)));
    }
    mesh.faces = network.faces();
    for (Triangle& f : mesh.faces)
        for (VertexId& v : f) v = index[v];
}

std::vector<float> in_order(const PerVertex<float>& values, const Network& network) {
    std::vector<float> result;
    for (const VertexId v : network.vertices()) result.push_back(values[v]);
    return result;
}

void write_features(const LearnedNetwork& learned, const Settings& settings, NeuralMesh& mesh) {
    mesh.counters = in_order(learned.measures.values(settings.feature_measure), learned.network);
    mesh.features =
        features_of(in_order(learned.measures.values(settings.select_by), learned.network), settings);
    mesh.report.mean_counter = mean(mesh.counters);
    mesh.report.feature_vertices =
        static_cast<int>(std::count(mesh.features.begin(), mesh.features.end(), 1));
}

void write_creases(const LearnedNetwork& learned, const Frame& frame, NeuralMesh& mesh) {
    const PerVertex<float>& measure = learned.measures.creases;
    const CreaseGraph graph = crease_lines(learned.network, measure);
    for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
        mesh.creases.positions.push_back(frame.outside(graph.positions[i]));
        mesh.creases.measures.push_back(measure[graph.vertices[i]]);
    }
    mesh.creases.edges = graph.edges;
    mesh.report.crease_lines = graph.lines;
    mesh.report.notes.push_back(
        graph.lines == 0 ? "The mesh has no creases, so there is no layer with crease lines."
                         : "The mesh has " + std::to_string(graph.lines) + " crease lines with " +
                               std::to_string(graph.corners) + " corners; they are a layer of their own.");
}

void write_colors(const TargetSpace& target, const Network& network, const Settings& settings,
                  Progress& progress, NeuralMesh& mesh) {
    if (settings.vertex_color == kNoColors) return;
    if (settings.vertex_color == kCloudColors && target.has_colors()) {
        Random random(stream_seed(settings.random_seed, Stream::colors));
        const PerVertex<Color> colors = cloud_colors(target, network, settings.threads, random, progress);
        for (const VertexId v : network.vertices()) mesh.colors.push_back(colors[v]);
        return;
    }
    if (settings.vertex_color == kCloudColors)
        mesh.report.notes.emplace_back(
            "The layer has no colours: those of the vertices show the feature measure.");
    mesh.colors = counter_colors(mesh.counters);
}

void write_figures(const LearnedNetwork& learned, Report& report) {
    report.vertices = learned.network.vertex_count();
    report.faces = learned.network.face_count();
    report.genus = learned.network.genus();
    report.boundary_loops = learned.network.boundary_loop_count();
    report.components = learned.network.component_count();
    report.signals = learned.signals;
    report.splits = learned.splits;
    report.collapses = learned.collapses;
    report.stop_reason = learned.stop_reason;
}

void warn_of_growth(const LearnedNetwork& learned, Report& report) {
    if (learned.forced && report.stop_reason == StopReason::target_reached)
        report.warnings.push_back(
            "Growth stalled and was forced; usually the points have fewer distinct places than the vertices "
            "asked for. Lower target_vertices if the mesh has slivers.");
    if (learned.carried > 0 && report.stop_reason == StopReason::target_reached)
        report.warnings.push_back("The points carry about " + std::to_string(learned.carried) +
                                  " vertices: the others only make the mesh smoother between the points.");
    if (report.stop_reason == StopReason::cut_short)
        report.warnings.push_back("The mesh has only " + std::to_string(report.vertices) +
                                  " vertices, because growth stalled until the limit on signals was reached. "
                                  "Lower signals_per_split or min_wins_per_split, or raise "
                                  "signals_per_collapse.");
}

void note_topology(const LearningTask& task, const LearnedNetwork& learned, Report& report) {
    if (learned.topology_changes == 0) return;
    const auto words = [](int components, int genus) {
        return std::to_string(components) + " component(s) and genus " + std::to_string(genus);
    };
    report.notes.push_back(
        "Membranes were given up in " + std::to_string(learned.topology_changes) +
        " place(s): the start mesh had " + words(task.network.component_count(), task.network.genus()) +
        ", the result has " + words(report.components, report.genus) +
        (report.boundary_loops > 0 ? " with " + std::to_string(report.boundary_loops) + " boundary loop(s)."
                                   : "."));
}

void warn_if_not_opened(const Settings& settings, Report& report) {
    if (settings.surface != kOpenSurface || settings.start_mesh != kTetrahedron || !settings.learn_topology ||
        report.boundary_loops > 0)
        return;
    report.warnings.emplace_back(
        "The surface is closed, because learning from the tetrahedron found no place without points that "
        "nothing faces. Choose start_mesh 0 for an open one.");
}

}  // namespace

NeuralMesh write_result(const LearningTask& task, const LearnedNetwork& learned, const Settings& settings,
                        Progress& progress) {
    NeuralMesh mesh;
    mesh.report.warnings = task.warnings;
    mesh.report.notes = task.notes;
    mesh.report.topology_confidence = task.topology_confidence;
    mesh.report.outliers = task.outliers;
    write_geometry(learned.network, task.target().frame(), mesh);
    write_features(learned, settings, mesh);
    if (settings.crease_lines) write_creases(learned, task.target().frame(), mesh);
    write_colors(task.target(), learned.network, settings, progress, mesh);
    write_figures(learned, mesh.report);
    warn_of_growth(learned, mesh.report);
    note_topology(task, learned, mesh.report);
    warn_if_not_opened(settings, mesh.report);
    Random random(stream_seed(settings.random_seed, Stream::rms_error));
    ThreadTeam team(thread_count(settings.threads));
    mesh.report.rms_error =
        100 * rms_distance(task.target(), learned.network, kDistanceSamples, random, team);
    return mesh;
}

}  // namespace neuralmesh
