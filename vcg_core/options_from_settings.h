// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// From the settings of a run to the options of its parts.
#pragma once

#include "vcg_core/learning/learner_options.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// The learner's part of \p settings. It grows to settings.target_vertices.
LearnerOptions learner_options_from(const Settings& settings);

}  // namespace neuralmesh
