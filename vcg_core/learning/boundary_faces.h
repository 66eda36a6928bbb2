// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Faces along a boundary that learning has flattened, folded or torn apart. Not in the paper, whose meshes
// are closed.
#pragma once

#include <vcg/space/point3.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "vcg_core/paper/learning_state.h"

namespace neuralmesh {

/// The signals that boundary vertices have won, by their winners: they tell a notch in the boundary from an
/// opening of the cloud.
class BoundarySignals {
public:
    void add(VertexId winner, const vcg::Point3f& signal) {
        won_.emplace_back(winner, signal);
        sorted_ = false;
    }
    void clear() { won_.clear(); }

    /// Whether \p accepts any signal that \p winner has won. O(log n), and O(n log n) after signals were
    /// added.
    template <class Accepts>
    bool any_of(VertexId winner, const Accepts& accepts) {
        const auto earlier = [](const Won& a, const Won& b) { return a.first < b.first; };
        if (!sorted_) std::stable_sort(won_.begin(), won_.end(), earlier);
        sorted_ = true;
        const auto range = std::equal_range(won_.begin(), won_.end(), Won(winner, {}), earlier);
        return std::any_of(range.first, range.second, [&](const Won& won) { return accepts(won.second); });
    }

private:
    using Won = std::pair<VertexId, vcg::Point3f>;
    std::vector<Won> won_;
    bool sorted_ = true;
};

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
///   corners: there a notch is filled only if boundary vertices have \p won signals in it, and none is
///   joined.
///
/// O(n). \return the number of faces and notches changed
int mend_boundary_faces(LearningState& state, BoundarySignals& won, bool may_remove);

}  // namespace neuralmesh
