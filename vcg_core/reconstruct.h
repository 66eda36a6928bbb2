// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The whole job in one call: a target space and settings in, a mesh with counters and figures out.
#pragma once

#include "vcg_core/base/progress.h"
#include "vcg_core/neural_mesh.h"
#include "vcg_core/settings.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// Learns \p target with a growing neural mesh (the paper, section 2).
///
/// Outliers are left out (start_mesh 0, see shell.h), and so are repeated points, if they are many: of what
/// remains speak the report's rms_error and its warnings.
/// The result is one oriented 2-manifold of exactly settings.target_vertices vertices unless
/// report.stop_reason says otherwise. The same target, settings and seed give the same bytes, whatever
/// the machine and settings.threads.
/// \throws SettingError (a parameter out of range), InputError (nothing to learn), std::bad_alloc
/// Cost: about signals_per_split signals of O(1) expected time for each vertex learned. Below 5,000 vertices
/// up to four times as many are learned as asked for, and the fit takes some out; where growth stalls, it all
/// begins anew without that. Memory: 12 bytes more per point where outliers are left out,
/// and as many where repeated points are.
NeuralMesh reconstruct(const TargetSpace& target, const Settings& settings, Progress& progress);

}  // namespace neuralmesh
