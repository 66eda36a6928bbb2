// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The last stage of a run: the result, of what was learned.
#pragma once

#include "vcg_core/base/progress.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learning_task.h"
#include "vcg_core/result.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// The result of \p learned in the coordinates of the input: geometry, feature measures, colours and, if
/// \p settings ask for them, creases; and the report, with the error at the points of \p task. O(vertices)
/// and 20,000 searches for the nearest face.
NeuralMesh write_result(const LearningTask& task, const LearnedNetwork& learned, const Settings& settings,
                        Progress& progress);

}  // namespace neuralmesh
