// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Other surfaces in place of membranes: their rims closed, or joined with each other, whichever the points
// support.
#pragma once

#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/topology/membranes.h"

namespace neuralmesh {

/// An exchange of faces.
struct Reconnection {
    std::vector<int> membranes;   ///< indices of the membranes that go
    std::vector<Triangle> gone;   ///< their faces
    std::vector<Triangle> added;  ///< the faces in their place
    float gain = 0;               ///< signals that are explained better, see surroundings.h
};

/// The best reconnection of every certain membrane, and of every pair of membranes that face each other,
/// which joins them. Where joining gains too little they may be the sides of a web, and are closed as one
/// with the faces between them. Only those that gain enough (see reconnection.cpp), the largest gain first.
/// Membranes may be widened by one or two rings: the surface dents around a hole that it plugs. A joint makes
/// a handle, or one component of two; closed rims of a tube take a handle away; a membrane with one rim is
/// closed by a smaller surface. Joints make handles only if \p handles. If \p in_groups, three
/// and more membranes may be joined, too, see membranes.h: the openings of one hollow, where every
/// joint of two leaves a tube that spans the others. Each of them alone leaves \p network a manifold. A
/// membrane that many others face is left alone, as it is among points that fill space. The search ends when
/// it has cost its budget, which is in proportion to the faces, those first that lack the most signals; or
/// when \p progress asks to stop. The result does not depend on the number of threads. O(faces log faces +
/// signals)
std::vector<Reconnection> find_reconnections(const Network& network, const Surface& surface,
                                             const FaceSignals& support,
                                             const std::vector<Membrane>& membranes, bool handles,
                                             bool in_groups, ThreadTeam& team, Progress& progress);

}  // namespace neuralmesh
