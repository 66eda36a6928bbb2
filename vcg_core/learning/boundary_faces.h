// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Faces along a boundary that learning has flattened, folded or torn apart. Not in the paper, whose meshes
// are closed.
#pragma once

#include "vcg_core/learning/learning_state.h"

namespace neuralmesh {

/// Looks at the face of every boundary edge. Signals from beyond the edge pull the face's third corner
/// towards the edge and across it. Then the face is folded: normals seem to vary there, which attracts
/// splits.
/// - If the third corner is an inner vertex, and its angle is obtuse or the face is folded, the face is
///   removed and the corner joins the boundary.
/// - An ear, a face with two boundary edges, is flipped with the face behind it, unless its tip is sharp. A
///   folded ear that cannot be flipped is removed with its tip, if \p may_remove.
/// - Any other folded face is flipped with a neighbour, if that unfolds it.
/// - A notch of less than a right angle is filled by a face: splits would deepen it. If its sides meet or
///   overlap, they are joined, and a vertex less is left, if \p may_remove. A boundary of few edges is all
///   corners: there a notch is filled only if boundary vertices have won signals in it (see
///   LearningState::boundary_signals), and none is joined.
///
/// O(n). \return the number of faces and notches changed
int mend_boundary_faces(LearningState& state, bool may_remove);

}  // namespace neuralmesh
