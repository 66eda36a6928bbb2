// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A mesh with as many vertices as the error that is asked for needs: the paper's end of growth by quality, in
// a unit that a user knows.
#pragma once

#include <functional>

#include "vcg_core/base/progress.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learning_task.h"
#include "vcg_core/result.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// The stages before and after learning and fit.
struct OuterStages {
    /// Points and start mesh for settings.target_vertices. Fractions of the progress run from 0 to 1.
    std::function<LearningTask(const TargetSpace& target, const Settings& settings, Progress& progress)>
        prepare;
    /// The result.
    std::function<NeuralMesh(const LearningTask& task, const LearnedNetwork& learned)> finish;
};

/// Learns \p given with several numbers of vertices, at most settings.target_vertices. Points that are held
/// out of the cloud - a twentieth, at most 5,000, without clutter and outliers - are to lie
/// settings.target_error from the mesh: root mean square, less the deviation by their noise, for which the
/// median stands. Of points drawn from faces or by a function more are drawn. \return the smallest of the
/// meshes that is as good, with its error in the report or, if none is, the best one, with a warning; the one
/// at hand if \p progress asks to stop. The start mesh is made and the network is grown once for all; each
/// number has a fit of its own. \throws what OuterStages::prepare throws for settings.target_vertices
NeuralMesh learn_to_error(const TargetSpace& given, const Settings& settings, Progress& progress,
                          const OuterStages& stages);

}  // namespace neuralmesh
