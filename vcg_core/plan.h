// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What a run does, as far as it depends on the noise, the number of points and the number of vertices: one
// plain struct, computed by one function, without thresholds at which the result jumps.
#pragma once

#include <cstddef>

namespace neuralmesh {

/// What the plan is computed from.
struct Circumstances {
    int vertices = 0;        ///< that are asked for
    int start_vertices = 0;  ///< of the start mesh
    std::size_t points = 0;
    bool exact = false;  ///< the points are drawn from faces or by a function: there are as many as one likes
    double noise = 0;    ///< deviation of the points in mean edges of the mesh asked for
    double outliers = 0;                ///< share of the points that were left out
    std::size_t carried_by_points = 0;  ///< vertices that the points can place, by spacing and noise
    bool closed = false;                ///< the start mesh has no boundary
    bool encloses_space = true;         ///< else it is a sheet that is closed around both sides
    bool redistributes = true;          ///< as Settings::redistributes_vertices()
};

struct Plan {
    bool fills_up = false;  ///< the fit inserts the vertices that the points do not carry
    int carried = 0;        ///< vertices that learning and fit place by the points
    int grow_to = 0;        ///< vertices to learn, at least; the fit removes those beyond \p carried
    /// Shares of Settings::signals_per_split and settling_signals_per_vertex: the fit places the vertices
    /// that stay, so the more are removed, the fewer signals do. And a network that learns for long follows
    /// the noise.
    double growth_share = 1, settling_share = 1;
    /// Whether the fit reduces by the shape of the mesh (collapse_by_volume()) instead of by distances to the
    /// points, which noise blurs less.
    bool by_volume = false;
};

/// Vertices beyond \p vertices of which the fit takes away those that matter least, whatever the noise.
int usual_surplus(int vertices);

/// All of it is continuous and monotone in the noise and the number of points, but by_volume, which changes
/// where both choices give the same error, and fills_up. Chosen by
/// tests/experiments/accuracy/accuracy_table.py and open_table.py.
Plan plan_for(const Circumstances& given);

}  // namespace neuralmesh
