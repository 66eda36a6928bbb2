// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Membranes: regions of a mesh that no points support. They span gaps, plug handles and bridge parts.
#pragma once

#include <cstddef>
#include <vector>

#include "vcg_core/topology/face_signals.h"
#include "vcg_core/topology/patches.h"

namespace neuralmesh {

/// Faces without support, and the rims of the hole that they would leave.
struct Membrane {
    std::vector<int> faces;  ///< rising
    std::vector<Rim> rims;   ///< each vertex is on one rim at most
    float missing = 0;       ///< signals: expected less won
    Vector3 area;            ///< sum of the area vectors
    /// Whether the membrane is one without doubt; else it takes two that face each other.
    bool certain = false;
};

/// The face beyond an edge of \p face, the one from corner \p edge to the next; -1 on a boundary. O(valence)
int face_beyond(const Surface& surface, int face, std::size_t edge);

/// How much a membrane has to lack to be certain, ln(faces) + 7: it may lie anywhere on the surface.
double least_lack(const Surface& surface);

/// The membranes of a closed surface: faces that lack support and share edges. A membrane is certain if it
/// lacks least_lack(). Those that lack a quarter of that are found. Faces that would hang on it by a
/// corner only, or as an island inside, are part of it, so that the surface stays a manifold without it;
/// membranes that become too large by that are left out. O(faces log faces)
std::vector<Membrane> find_membranes(const Surface& surface, const FaceSignals& signals);

/// Membranes are near each other if their rims are no further apart than this many mean edges.
constexpr float kReach = 4;
/// Whether the rims of \p a and \p b are within kReach times \p edge. O(product of the lengths of the rims)
bool near_each_other(const Surface& surface, const Membrane& a, const Membrane& b, float edge);
/// Whether they also face away from each other, as the plugs at both ends of a hole do. Cost as above
bool face_each_other(const Surface& surface, const Membrane& a, const Membrane& b, float edge);

/// Completes \p membrane.faces as find_membranes() does, and finds the rims. \return false if that does not
/// end.
bool complete(const Surface& surface, const FaceSignals& signals, Membrane& membrane);

/// Groups of three and more certain membranes, by their indices, each near to another of its group. If a
/// group has more than \p most_rims rims, only those of its membranes that lack the most signals. The
/// membranes of a group come in this order. \p edge: mean length. O(product of the lengths of all rims)
std::vector<std::vector<int>> membrane_groups(const Surface& surface, const std::vector<Membrane>& membranes,
                                              float edge, std::size_t most_rims);

/// Leaves faces out of membranes until no two of them share a vertex: at a vertex that two share, all faces
/// but those of the first. \return false if that leaves a membrane without faces
bool take_apart(const Surface& surface, const FaceSignals& signals, std::vector<Membrane>& membranes);

}  // namespace neuralmesh
