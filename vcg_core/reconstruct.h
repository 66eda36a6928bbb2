// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A whole run in one call: from a target space and settings to a mesh with counters and figures.
#pragma once

#include "vcg_core/base/progress.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/result.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// Learns \p target with a growing neural mesh (the paper, section 2), fits it, and measures it.
///
/// Repeated points are removed if they are more than a tenth of all. Outliers are removed if
/// settings.remove_outliers is on. report.warnings says how many points were removed; report.rms_error is the
/// error at the others.
///
/// If settings.start_mesh is kGivenMesh, learning goes on from \p start, a mesh in the coordinates of the
/// input; what given_start.h says of it holds.
///
/// The result is an oriented 2-manifold. It has exactly settings.target_vertices vertices unless
/// report.stop_reason says otherwise. If \p progress asks to stop, the result is the valid mesh so far. The
/// same target and settings give the same bytes on any x86-64 machine and with any settings.threads.
///
/// \throws SettingError (a parameter is out of range), InputError (no surface to learn), std::bad_alloc
///
/// Cost: about signals_per_split signals per vertex that the network grows to (see learn_and_fit.h), each of
/// O(1) expected time, and the fit (see fit.h). Memory besides that of the fit: the network, about 30
/// bytes per node of the start mesh's lattice (see shell.h), and 12 bytes per point if points are removed.
NeuralMesh reconstruct(const TargetSpace& target, const Settings& settings, Progress& progress,
                       const IndexedMesh<double>& start = {});

}  // namespace neuralmesh
