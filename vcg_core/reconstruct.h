// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A whole run in one call: from a target space and settings to a mesh with counters and figures.
#pragma once

#include "vcg_core/base/progress.h"
#include "vcg_core/neural_mesh.h"
#include "vcg_core/settings.h"
#include "vcg_core/target/target_space.h"

namespace neuralmesh {

/// Learns \p target with a growing neural mesh (the paper, section 2), fits it, and measures it.
///
/// Repeated points (if they are many) and outliers (if settings.remove_outliers is on) are not learned;
/// report.rms_error is of the other points, and report.warnings says how many were removed. The result is an
/// oriented 2-manifold of exactly settings.target_vertices vertices unless report.stop_reason says otherwise.
/// The same target, settings and seed give the same bytes on any x86-64 machine and with any
/// settings.threads. If \p progress asks to stop, the result is the valid mesh so far.
/// \throws SettingError (a parameter is out of range), InputError (no surface to learn), std::bad_alloc
/// Cost: about signals_per_split signals per vertex that the network grows to (see learn_and_fit.h), each of
/// O(1) expected time. Memory besides the network: 12 bytes per point if points are removed.
NeuralMesh reconstruct(const TargetSpace& target, const Settings& settings, Progress& progress);

}  // namespace neuralmesh
