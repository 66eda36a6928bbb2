// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The steps of the fit and what they share: points, noise, weight, crossings.
#pragma once

#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/fit/redistribute.h"
#include "vcg_core/mesh/self_crossings.h"

namespace neuralmesh {

/// A network on its way to the points. fit_to_points() takes the steps in their order.
class Fitter {
public:
    /// References to \p network and \p team are kept; there are fitted and held-back points.
    Fitter(Network& network, Split points, ThreadTeam& team);

    /// Smooths out where the surface cuts itself, and from then on guards what is left of that. False if \p
    /// progress asks to stop; then the network is as it was.
    bool untangle_surface(Progress& progress);
    /// Takes out the vertices whose removal costs least, some at a time, with moves in between, with a part
    /// of the points. False if \p progress asks to stop or no more can go.
    bool reduce_to(int vertices, Progress& progress);

    /// Ties every fitted point to its nearest face, by a tree (\p exact) or from where it was last.
    PointsByFace tie(const Surface& surface, bool exact);
    /// Finds the points held back, exactly.
    void find_held(const Surface& surface);
    /// Measures from now on along the smoothed normals of \p surface.
    void aim(const Surface& surface);
    /// Root mean square distance of the points held back, along their directions. The nearest distance would
    /// not do: under noise a crumpled surface is nearer to every point than the true one.
    double held_error(const Surface& surface) const;

    /// Solves for several bending weights, takes what brings the points held back closest: moves the vertices
    /// of the network there, and \p surface, which is its surface, with them. \return the error of the points
    /// held back
    double move(const PointsByFace& ties, Surface& surface);
    /// Moves vertices to where the error is. \return how many
    int shift_vertices(const Surface& surface, const PointsByFace& ties);
    /// Flips edges where that brings the points closer; new feet for \p ties first. \return how many
    int flip(const Surface& surface, PointsByFace& ties);

    /// The points held back with their directions: to judge two meshes by the same ones.
    const TrackedPoints& held() const { return points_.held; }
    /// Takes \p held for them and finds where they are on \p surface; their directions stay.
    void find_again(TrackedPoints held, const Surface& surface);
    /// For every slot the vertex beside which it was put in, or itself.
    const std::vector<VertexId>& origin() const { return origin_; }
    float variance() const { return noise_; }  ///< of the noise

private:
    void wait_for_reduction();
    template <class Change>
    auto guarded(const Surface& surface, const Change& change);
    float least_gain(const Surface& surface) const;
    void move_on(const std::vector<VertexMoves::DoneCollapse>& merges);
    void follow(const Surface& surface, PointsByFace& ties) const;

    Network& network_;
    Split points_;
    std::vector<Vector3> waiting_;  ///< points for after the reduction
    ThreadTeam& team_;
    float outlier_ = 0;  ///< for the judgement: fixed from the start
    float noise_ = 0;    ///< variance
    float weight_ = 0;
    int moves_ = 0;
    std::vector<VertexId> origin_;
    CrossingGuard guard_;  ///< of the current state
};

/// The origins where nothing has been put in: every vertex itself, -1 for free slots.
std::vector<VertexId> own_places(const Network& network);

}  // namespace neuralmesh
