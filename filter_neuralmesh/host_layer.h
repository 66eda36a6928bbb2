// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The result as a layer of the host's, and in its log. Included by each adapter after the host's own headers,
// as host_parameters.h is.
#pragma once

#include <new>
#include <string>

#include "actions.h"

namespace neuralmesh {

/// The attributes that a result written with \p settings has beyond coordinates and faces.
inline int result_mask(const Settings& settings) {
    int mask = MeshModel::MM_VERTQUALITY;
    if (settings.color_by_counter) mask |= MeshModel::MM_VERTCOLOR;
    if (settings.select_features) mask |= MeshModel::MM_VERTFLAGSELECT;
    return mask;
}

/// Fills the new layer \p added, all but box and normals. \p transform: the matrix of the layer that was
/// learned. Adds a warning to \p result if its coordinates cannot be those of the world.
template <class Matrix>
void fill_layer(NeuralMesh& result, const Settings& settings, const Matrix& transform, MeshModel& added) {
    added.updateDataMask(result_mask(settings));
    const Coordinates origin = origin_of<CMeshO>(result, transform);
    write_mesh(result, settings, added.cm, origin);
    added.cm.svn = settings.select_features ? result.report.feature_vertices : 0;
    if (origin == Coordinates{}) return;
    for (int k = 0; k < 3; ++k)
        added.cm.Tr.ElementAt(k, 3) = static_cast<MESHLAB_SCALAR>(origin[static_cast<std::size_t>(k)]);
    result.report.warnings.push_back(sentence_on_origin(origin));
}

/// Tells of a run that is done, by \p log(level, line). No memory for that is no failure: the mesh is there
/// all the same.
template <class Log>
void log_run(const Report& report, const Log& log) {
    try {
        for (const std::string& line : log_lines(report)) log(GLLogStream::FILTER, line);
        for (const std::string& warning : report.warnings) log(GLLogStream::WARNING, warning);
    } catch (const std::bad_alloc&) {
        // The log has no memory for it.
    }
}

}  // namespace neuralmesh
