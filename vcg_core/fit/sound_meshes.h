// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Meshes that do not cut themselves: the one that the fit begins with, and long moves of its vertices.
#pragma once

#include <optional>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/self_intersections.h"

namespace neuralmesh {

/// Removes the self-intersections of \p network. On a closed surface by smoothing alone, see untangle(). If
/// there is a boundary and some remain, also by removing faces that cut others, see remove_cut_faces(); as
/// many vertices as go with them are inserted on the longest edges. The result does not depend on the number
/// of threads.
///
/// \param progress asked before every round of the first smoothing; if it asks to stop, the network stays
/// unchanged
/// \return the remaining self-intersections, sorted; nothing if stopped
std::optional<std::vector<SelfIntersection>> make_sound(Network& network, ThreadTeam& team,
                                                        Progress& progress);

/// Where faces of \p network are turned away from its viewer, who cannot have seen them, smooths the surface
/// in the image of the viewer: vertices move at right angles to their lines of sight, towards the middle of
/// their neighbours. Points at several heights along a line of sight, as those of crowns above the ground,
/// make learning fold the surface. Boundary vertices stay. A surface that overhangs by some edges loses
/// little of that: inside of it vertices are in the middle of their neighbours already. Without a viewer
/// nothing moves. O(vertices).
void unfold(Network& network);

/// Laplacian smoothing of \p network around its self-intersections, over neighbourhoods that widen from round
/// to round; boundary vertices move along the boundary only. Where self-intersections remain, the surface
/// around them gets its old positions back. No other vertex moves. Gives up, leaving the network unchanged,
/// if more than 100 pairs of face boxes per face overlap. The result does not depend on the number of
/// threads.
///
/// \param progress asked before every round; if it asks to stop, the network stays unchanged
/// \return the remaining self-intersections, sorted; nothing if stopped
///
/// Cost: that of self_intersections() once and of update_self_intersections() per round.
std::optional<std::vector<SelfIntersection>> untangle(Network& network, ThreadTeam& team, Progress& progress);

/// Where the boundary of one sheet meets the inside of another, as a chair meets the floor, signals of the
/// other sheet draw the boundary through it. Removes faces that cut others until none do, or none can be
/// removed. Of two that cut each other the one goes that has more corners on the boundary, or else the longer
/// edges. Faces that would be left in a lesser fan at a vertex go with it. In a fold the shortest edge is
/// collapsed. Faces whose removal keeps the topology go first, then folds, then others. At most a tenth
/// of the faces go: a surface that needs more is tangled beyond repair. Vertices without faces go, too.
///
/// \param[in,out] intersections the self-intersections of the network, sorted
/// \return the number of faces removed. The result does not depend on the number of threads.
/// Cost: that of update_self_intersections() per pass; every pass but the last of each kind removes faces.
int remove_cut_faces(Network& network, std::vector<SelfIntersection>& intersections, ThreadTeam& team);

/// Moves the vertices of \p network by \p moves, in at most twelve steps, of which none exceeds MoveLimits or
/// adds a self-intersection. Self-intersections at the start are smoothed out first where untangle() can. A
/// vertex that is held up in one step goes on in the next; in the end some may be short of their places. The
/// result does not depend on the number of threads. Cost: that of untangle(), and per step of MoveLimits and
/// some searches for intersections.
void move_soundly(Network& network, PerVertex<Vector3> moves, ThreadTeam& team);

}  // namespace neuralmesh
