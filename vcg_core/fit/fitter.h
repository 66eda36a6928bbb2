// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The steps of the fit, on one network and its points.
#pragma once

#include <algorithm>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/base/thread_team.h"
#include "vcg_core/fit/fit.h"
#include "vcg_core/fit/least_squares.h"
#include "vcg_core/fit/move_limits.h"
#include "vcg_core/fit/point_errors.h"
#include "vcg_core/fit/points_by_face.h"
#include "vcg_core/fit/redistribute.h"

namespace neuralmesh {

/// A network and its state during the fit. fit_to_points() has the order of the steps.
class Fitter {
public:
    /// Keeps references to \p network and \p team. \pre neither part of \p points is empty
    Fitter(Network& network, PointChoice points, const FitOptions& options, ThreadTeam& team);

    /// Removes self-intersections, see make_sound(), and from then on lets no step add any. \return false if
    /// \p progress asks to stop; then the network is unchanged.
    bool untangle_surface(Progress& progress);
    /// Removes the vertices whose removal costs least. The costs are measured at part of the points, in
    /// rounds that each end with a least-squares solution; with FitOptions::by_volume they are those of
    /// collapse_by_volume(), after a few such solutions. \return false if \p progress asks to stop or no more
    /// vertices can go \pre the network has more than \p vertices vertices
    bool reduce_to(int vertices, Progress& progress);

    /// Assigns the fitted points to their nearest faces and finds the held-out points, all by exact search.
    PointsByFace locate_points(const Surface& surface);
    /// The same. The next solutions are stiff, to take out what learning followed of the noise.
    PointsByFace begin_rounds(const Surface& surface);
    /// Assigns the fitted points to their nearest faces by walks from the last ones.
    PointsByFace assign_faces(const Surface& surface);
    /// Makes \p surface that of the network, of which edges or faces have changed, and assigns the points to
    /// it.
    PointsByFace assign_changed(Surface& surface);
    /// From now on measures the error along the smoothed normals of \p surface.
    void set_directions(const Surface& surface) { held_out_.set_directions(network_, surface, team_); }
    /// Root mean square error at \p held_out, along its own directions.
    double error_at(const HeldOut& held_out, const Surface& surface) const {
        return held_out.rms_error(surface, outlier_distance_, team_);
    }

    /// Whether there are many points for each vertex of \p surface, and their noise is small beside its
    /// edges.
    bool has_precise_points(const Surface& surface) const;
    /// Solves the least squares for several bending weights and moves the vertices to the solution with the
    /// least error at the held-out points. Moves \p surface, that of the network, with them. \return the
    /// error
    /// \param hold see PointToPlaneSystem
    double solve(const PointsByFace& points, Surface& surface, float hold = PointToPlaneSystem::kSliding);
    /// Collapses vertices that matter little and inserts as many where the error is large. \p surface, that
    /// of the network, and \p points follow.
    void redistribute_vertices(Surface& surface, PointsByFace& points);
    /// Computes the feet of \p points again, then flips edges where that brings the points closer.
    void flip_edges(const Surface& surface, PointsByFace& points);
    /// Moves the vertices beside creases onto them, so that flip_edges() gives the creases edges. Moves \p
    /// surface, that of the network, with them. \pre \p points were assigned to \p surface before it moved
    /// last
    void move_to_creases(Surface& surface, const PointsByFace& points);
    /// assign_faces(), and if \p surface, that of the network, has a boundary, fills its notches that hold
    /// points and opens the faces there that hold none. \return the points on the surface after that
    PointsByFace mended(Surface& surface);

    const HeldOut& held_out() const { return held_out_; }
    float noise_variance() const { return noise_variance_; }

private:
    PointsByFace assign(const Surface& surface, const std::vector<Hit>& hits);
    void weaken_outliers(const Surface& surface, PointsByFace& points) const;
    void silence_strays(const Surface& surface, PointsByFace& points);
    void measure_noise(const Surface& surface, const PointsByFace& points);
    VertexNoise noise_around(const Surface& surface, const PointsByFace& points) const;
    std::vector<float> choose_weights(const Surface& surface, const PointsByFace& points);
    /// The standard deviation of the noise in mean edge lengths of \p surface.
    float noise_in_edges(const Surface& surface) const;
    /// Carries out \p change(barred) on the network, whose surface is \p surface. If the guard objects to the
    /// result, restores the network and tries again with the vertices of the new self-intersections barred;
    /// if all tries fail, with all barred. \return the result of the last call
    template <class Change>
    auto guarded(const Surface& surface, const Change& change);
    /// As guarded(), for a change that returns what it has collapsed: the points follow. \return whether
    /// there were any collapses
    template <class Change>
    bool guarded_collapses(const Surface& surface, const Change& change) {
        const std::vector<DoneCollapse> done = guarded(surface, change);
        redirect_to_survivors(done);
        return !done.empty();
    }
    void redirect_to_survivors(const std::vector<DoneCollapse>& collapses);
    void set_points_aside();
    bool wants_reduction(int vertices, int at_start, Progress& progress) const;
    /// \param error that of the last solution
    bool reduce_by_volume(int vertices, Surface& surface, PointsByFace points, Progress& progress);
    bool reduce_by_costs(int vertices, Surface& surface, Progress& progress);
    bool remove_vertices(const Surface& surface, const PointsByFace& points, int max_count, bool dense);

    Network& network_;
    const FitOptions options_;
    ThreadTeam& team_;
    TrackedPoints fitted_;
    TrackedPoints set_aside_;  ///< fitted points that the reduction does not use
    HeldOut held_out_;
    float outlier_distance_ = 0;  ///< from the first assignment; fixed, so that errors stay comparable
    float noise_variance_ = 0;    ///< from the last assignment
    PerVertex<float> variances_;  ///< of the noise around each vertex, from the last assignment
    PerVertex<float> rounding_variances_;  ///< the part that the points of one step share
    float stiffness_ = 1;                  ///< times the least weight under noise
    float least_weight_;        ///< of bending; falls, as in the first rounds points may be with wrong faces
    float bending_weight_ = 0;  ///< the last choice; 0: none yet
    IntersectionGuard guard_;   ///< has accepted the present surface
};

template <class Change>
auto Fitter::guarded(const Surface& surface, const Change& change) {
    // Collapses that take the place of barred ones may cut, too: with 3 attempts the reduction ended early on
    // a cup whose walls are an edge thick.
    constexpr int kTries = 12;
    const Network before = network_;
    PerVertex<char> barred(network_.slot_count(), 0);
    for (int tries = 0;; ++tries) {
        if (tries == kTries) std::fill(barred.begin(), barred.end(), 1);
        auto done = change(barred);
        const std::vector<VertexId> objections = guard_.objections(
            update_self_intersections(Surface(network_), surface, guard_.accepted(), team_));
        if (objections.empty() || tries == kTries) return done;
        for (VertexId v : objections)
            if (v < barred.size()) barred[v] = 1;
        network_ = before;
    }
}

}  // namespace neuralmesh
