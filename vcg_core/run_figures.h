// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The figures of a run by the names that hosts and other languages return them under.
#pragma once

#include <vector>

#include "vcg_core/result.h"

namespace neuralmesh {

/// One figure of a run.
struct Figure {
    const char* key;  ///< API: scripts read it
    double value;
    bool is_count;  ///< a whole number

    /// \pre is_count. Counts that exceed int, as signals may, become the largest int.
    int count() const;
};

/// Of the report of reconstruct(), in the order of the log.
std::vector<Figure> figures_of_reconstruction(const Report& report);

/// Those of them that the report of mesh_counters() has.
std::vector<Figure> figures_of_counters(const Report& report);

}  // namespace neuralmesh
