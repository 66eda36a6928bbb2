// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/learning_task.h"

#include <cstdint>

#include "vcg_core/shell/shell.h"

namespace neuralmesh {

namespace {

/// A shell lies outside the cloud by its radius. This many signals per vertex bring it down.
constexpr int kLandingSignals = 100;

/// The start mesh of the paper, in the middle of the cloud, which is the origin of the core's frame.
Network tetrahedron() {
    constexpr float kA = 0.1F;
    return Network({{kA, kA, kA}, {-kA, -kA, kA}, {-kA, kA, -kA}, {kA, -kA, -kA}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

/// Where many points repeat others, signals would be drawn there more often, and the mesh would be denser or
/// grow a component.
void remove_repeated_points(LearningTask& task) {
    task.cleaned = task.given.each_place_once();
    if (!task.cleaned) return;
    const std::size_t all = task.given.positions().size();
    task.warnings.push_back(std::to_string(all - task.cleaned->positions().size()) + " of " +
                            std::to_string(all) + " points repeat others: every place was learned once.");
}

StartMesh make_shell(const TargetSpace& target, const Settings& settings, Progress& progress) {
    ShellOptions options;
    options.target_vertices = settings.target_vertices;
    options.threads = settings.threads;
    Random random(stream_seed(settings.random_seed, Stream::shell));
    return shell_of(target, options, random, progress);
}

/// What remains has a frame of its own, into which the shell is moved.
void remove_outliers(LearningTask& task, StartMesh& shell) {
    if (shell.outliers.empty()) return;
    std::optional<TargetSpace> inliers = task.target().without(shell.outliers);
    if (!inliers) return;
    for (vcg::Point3f& p : shell.positions) p = inliers->frame().inside(task.target().frame().outside(p));
    task.cleaned = std::move(inliers);
}

std::string too_large(const StartMesh& shell, int final_vertices) {
    return "The shell of the cloud, with " + std::to_string(shell.components) + " components and genus " +
           std::to_string(shell.genus) + ", needs " + std::to_string(shell.positions.size()) +
           " vertices, more than the " + std::to_string(final_vertices) +
           " asked for: learning started from a tetrahedron instead. Raise target_vertices to keep the "
           "shape.";
}

}  // namespace

LearningTask prepare(const TargetSpace& given, const Settings& settings, Progress& progress) {
    LearningTask task(given);
    remove_repeated_points(task);
    if (settings.start_mesh == kTetrahedron) {
        task.network = tetrahedron();
        return task;
    }
    StartMesh shell = make_shell(task.target(), settings, progress);
    task.warnings.insert(task.warnings.end(), shell.warnings.begin(), shell.warnings.end());
    remove_outliers(task, shell);
    if (static_cast<int>(shell.positions.size()) > settings.target_vertices) {
        task.warnings.push_back(too_large(shell, settings.target_vertices));
        task.network = tetrahedron();
        return task;
    }
    task.network = Network(shell.positions, shell.faces);
    task.landing_signals = kLandingSignals;
    task.encloses_space = shell.encloses_space;
    task.topology_confidence = shell.confidence;
    if (!task.encloses_space && settings.smoothing_steps > 0)
        task.warnings.push_back(
            "The two layers of such a surface lie on each other, which leaves no room to smooth them: it was "
            "learned with smoothing_steps 0, and its triangles are less even than usual.");
    return task;
}

}  // namespace neuralmesh
