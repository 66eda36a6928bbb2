// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Takes out folds of a surface that was seen from one place, before it is fitted.
#pragma once

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// Where faces of \p network are turned away from its viewer, who cannot have seen them, smooths the surface
/// in the image of the viewer: vertices move at right angles to their lines of sight, towards the middle of
/// their neighbours. Points at several heights along a line of sight, as those of crowns above the ground,
/// make learning fold the surface. Boundary vertices stay. A surface that overhangs by some edges loses
/// little of that: inside of it vertices are in the middle of their neighbours already. Without a viewer
/// nothing moves. O(vertices).
void unfold(Network& network);

}  // namespace neuralmesh
