// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// From the host's current layer to the layer that holds the result, and the log. Each adapter includes this
// after the host's own headers: the class names are the same in all hosts, their layouts are not.
#pragma once

#include <new>
#include <string>
#include <utility>

#include "actions.h"

namespace neuralmesh {

/// What a run of \p action changes, as bits of MeshModel.
inline int changes_of(int action) {
    return action == kCounters ? MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTFLAGSELECT
                               : MeshModel::MM_VERTNUMBER | MeshModel::MM_FACENUMBER;
}

/// The attributes of the result besides coordinates and faces, as bits of MeshModel.
inline int result_mask(const Settings& settings) {
    int mask = MeshModel::MM_VERTQUALITY;
    if (settings.vertex_color != kNoColors) mask |= MeshModel::MM_VERTCOLOR;
    if (settings.select_features) mask |= MeshModel::MM_VERTFLAGSELECT;
    return mask;
}

/// Moves the layer \p added to \p origin, which its coordinates are relative to.
inline void set_origin(MeshModel& added, const Coordinates& origin) {
    for (int k = 0; k < 3; ++k)
        added.cm.Tr.ElementAt(k, 3) = static_cast<MESHLAB_SCALAR>(origin[static_cast<std::size_t>(k)]);
}

/// Fills the new layer \p added except for box and normals. \p transform is the matrix of the layer that was
/// learned. Adds a warning to \p result if the layer cannot store world coordinates. \return the point that
/// coordinates are relative to
template <class Matrix>
Coordinates fill_layer(NeuralMesh& result, const Settings& settings, const Matrix& transform,
                       MeshModel& added) {
    added.updateDataMask(result_mask(settings));
    const Coordinates origin = origin_of<CMeshO>(result, transform);
    write_mesh(result, settings, added.cm, origin);
    added.cm.svn = settings.select_features ? result.report.feature_vertices : 0;
    set_origin(added, origin);
    if (origin != Coordinates{}) result.report.warnings.push_back(sentence_on_origin(origin));
    return origin;
}

/// Fills the new layer \p added with \p lines, in the frame of the mesh that they belong to.
inline void fill_crease_layer(const CreaseLines& lines, const Coordinates& origin, MeshModel& added) {
    added.updateDataMask(MeshModel::MM_VERTQUALITY);
    write_creases(lines, added.cm, origin);
    set_origin(added, origin);
    vcg::tri::UpdateBounding<CMeshO>::Box(added.cm);
}

/// The mesh that the settings want learning to start from, in world coordinates; empty if that is none.
/// \throws InputError if its layer does not exist, and what indexed_mesh_of() throws
inline IndexedMesh<double> start_in(MeshDocument& document, const Settings& settings) {
    if (settings.start_mesh != kGivenMesh) return {};
    const MeshModel* const layer = document.getMesh(settings.start_layer);
    if (layer == nullptr) throw InputError(kNoStartLayer);
    return indexed_mesh_of(layer->cm, layer->cm.Tr);
}

/// Learns the current layer of \p document and adds the result as a new layer, which becomes the current one,
/// and its crease lines, if there are any, as another.
/// The hosts differ in two steps: \p complete(added, report) updates box and normals of the new layer and
/// makes what the host returns, \p remove(added) deletes a layer if a later step throws.
/// \throws InputError if there is no layer, and what run() throws; the document is then as before
template <class Complete, class Remove>
Report learn_current_layer(MeshDocument& document, const Settings& settings, vcg::CallBackPos* call_back,
                           const Complete& complete, const Remove& remove) {
    MeshModel* const layer = document.mm();
    if (layer == nullptr) throw InputError(kNoLayer);
    // The window handles events during a run, so the layer may be gone after it.
    const auto current = static_cast<int>(layer->id());
    const Matrix44m transform = layer->cm.Tr;
    const bool colored = settings.vertex_color == kCloudColors && layer->hasDataMask(MeshModel::MM_VERTCOLOR);
    NeuralMesh result = run(layer->cm, transform, settings, colored, start_in(document, settings), call_back);

    MeshModel* const added = document.addNewMesh("", kLayerLabel, true);
    MeshModel* lines = nullptr;
    try {
        const Coordinates origin = fill_layer(result, settings, transform, *added);
        if (!result.creases.edges.empty()) {
            lines = document.addNewMesh("", kCreaseLabel, false);
            fill_crease_layer(result.creases, origin, *lines);
        }
        complete(*added, result.report);
    } catch (...) {
        if (lines != nullptr) remove(*lines);
        remove(*added);
        document.setCurrentMesh(current);
        throw;
    }
    return std::move(result.report);
}

/// Computes the counters of the current layer of \p document and writes them to its vertices. \p
/// complete(report) makes what the host returns, before anything is written. \throws InputError if there is
/// no layer, or if it is gone after the run, and what run_counters() throws; the document is then as before
template <class Complete>
Report count_current_layer(MeshDocument& document, const Settings& settings, vcg::CallBackPos* call_back,
                           const Complete& complete) {
    const MeshModel* const layer = document.mm();
    if (layer == nullptr) throw InputError(kNoLayer);
    const MeshModel* const drawn = document.getMesh(settings.signal_layer);
    if (drawn == nullptr) throw InputError(kNoSignalLayer);
    // The window handles events during a run.
    const auto current = static_cast<int>(layer->id());
    MeshCounters result = run_counters(layer->cm, layer->cm.Tr, drawn->cm, drawn->cm.Tr, settings, call_back);
    MeshModel* const counted = document.getMesh(current);
    if (counted == nullptr || counted->cm.vert.size() != result.counters.size()) throw InputError(kLayerGone);

    complete(result.report);
    counted->updateDataMask(MeshModel::MM_VERTQUALITY);
    write_counters(result, settings, counted->cm);
    if (settings.select_features) counted->cm.svn = result.report.feature_vertices;
    return std::move(result.report);
}

/// Writes \p report, of a run of \p action, to the log by \p log(level, line). Lack of memory
/// for that is no failure: the result exists.
template <class Log>
void log_run(const Report& report, int action, const Log& log) {
    try {
        for (const std::string& line : log_lines(report, action)) log(GLLogStream::FILTER, line);
        for (const std::string& note : report.notes) log(GLLogStream::FILTER, note);
        for (const std::string& warning : report.warnings) log(GLLogStream::WARNING, warning);
    } catch (const std::bad_alloc&) {
        // The rest of the log is lost.
    }
}

}  // namespace neuralmesh
