// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The stages of a run: learn() is the list.
#include "vcg_core/reconstruct.h"

#include <chrono>

#include "vcg_core/base/progress.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learn_to_error.h"
#include "vcg_core/learning_task.h"
#include "vcg_core/write_result.h"

namespace neuralmesh {

namespace {

/// Somebody who asks to stop before the start mesh is made gets a tetrahedron, or the mesh given as the
/// start.
LearningTask prepare_or_stop(const TargetSpace& given, const Settings& settings,
                             const IndexedMesh<double>& start, Progress& progress) {
    EndingProgress ending(progress);
    try {
        return prepare(given, settings, start, ending);
    } catch (const Stopped&) {
        Settings brief = settings;
        brief.remove_outliers = brief.even_sampling = brief.use_normals = false;
        if (settings.start_mesh == kShell) brief.start_mesh = kTetrahedron;
        NoProgress alone;
        return prepare(given, brief, start, alone);
    }
}

/// Points and start mesh, learning and fit, result. A stage of the reconstruction is a call here, or in what
/// these three call.
NeuralMesh learn(const TargetSpace& given, const Settings& settings, const IndexedMesh<double>& start,
                 MonotoneProgress& progress) {
    PartOf preparing(progress, 0, kPrepared);
    const LearningTask task = prepare_or_stop(given, settings, start, preparing);
    const LearnedNetwork learned = Learning(task, settings).with(settings.target_vertices, progress);
    return write_result(task, learned, settings, progress);
}

/// The same with as many vertices as settings.target_error needs.
NeuralMesh learn_to_target_error(const TargetSpace& given, const Settings& settings,
                                 const IndexedMesh<double>& start, MonotoneProgress& progress) {
    OuterStages stages;
    stages.prepare = [&start](const TargetSpace& target, const Settings& of_task, Progress& preparing) {
        return prepare_or_stop(target, of_task, start, preparing);
    };
    stages.finish = [&](const LearningTask& task, const LearnedNetwork& learned) {
        return write_result(task, learned, settings, progress);
    };
    return learn_to_error(given, settings, progress, stages);
}

}  // namespace

NeuralMesh reconstruct(const TargetSpace& given, const Settings& settings, Progress& progress,
                       const IndexedMesh<double>& start) {
    const auto begin = std::chrono::steady_clock::now();
    settings.check();
    MonotoneProgress monotone(progress);
    NeuralMesh mesh = settings.target_error > 0 ? learn_to_target_error(given, settings, start, monotone)
                                                : learn(given, settings, start, monotone);
    if (monotone.stopped()) mesh.report.stop_reason = StopReason::cancelled;
    mesh.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return mesh;
}

}  // namespace neuralmesh
