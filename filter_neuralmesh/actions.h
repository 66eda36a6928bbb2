// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The filters without MeshLab: names, help, figures, sentences and what they run. The two adapters, one per
// plugin interface, only translate this into the host's classes.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/mesh_counters.h"
#include "vcg_core/mesh_io.h"
#include "vcg_core/reconstruct.h"
#include "vcg_core/result.h"
#include "vcg_core/run_figures.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// One entry of the Filters menu. Names are API: scripts key on them.
struct Action {
    int id;
    const char* name;                          ///< menu and .mlx
    const char* python_name;                   ///< pymeshlab
    const char* info;                          ///< HTML, with the reference as MeshLab formats it
    const std::vector<SettingInfo>& settings;  ///< its parameters
};

constexpr int kReconstruct = 0;
constexpr int kCounters = 1;
constexpr const char* kPluginName = "FilterNeuralMesh";
constexpr const char* kVendor = "The Neural Mesh authors";
constexpr const char* kLayerLabel = "Neural Mesh";
constexpr const char* kCreaseLabel = "Neural Mesh creases";
constexpr const char* kNoLayer =
    "There is no current layer to learn: open or create a point cloud or a mesh first.";
constexpr const char* kNoStartLayer =
    "The layer to start from does not exist: choose one as 'Start layer', or another 'Start mesh'.";
constexpr const char* kNoSignalLayer =
    "The layer to draw signals from does not exist: choose one as 'Signal layer', for example the current "
    "one.";
constexpr const char* kLayerGone =
    "The layer was closed or changed while its counters were learned: nothing was written.";

/// All actions, in order of their ids, which count from 0.
const std::vector<Action>& all_actions();

/// \pre id is one of all_actions()
const Action& action_of(int id);

/// The figures of \p report, of a run of \p action, in the order of the log.
std::vector<Figure> figures(const Report& report, int action = kReconstruct);

/// Lines for the log after a run, besides the warnings: a sentence, all figures as key=value, and, if
/// learning started from a shell, the topology found and its confidence.
std::vector<std::string> log_lines(const Report& report, int action = kReconstruct);

/// What the log says of a run in words, a line each: "warning" or "note", a tab, and the sentence.
std::string messages_of(const Report& report, int action = kReconstruct);

/// The line of messages_of() of the run that ended with the error \p sentence.
std::string message_of_error(const std::string& sentence);

/// The warning that the new layer stores its coordinates relative to \p origin.
std::string sentence_on_origin(const Coordinates& origin);

/// Undoes the rounding by hosts that keep parameters as float: the shortest decimal number that rounds to the
/// float \p value. So .06 is the same double in every host.
double from_host(double value);

/// The sentence that explains the exception being handled to the user; call it inside a catch block. Throws
/// nothing: if there is no memory for the sentence, it returns a shorter one.
std::string sentence_of_current_exception();

/// The host's progress callback as the core's progress. Some hosts redraw their window in each call, so it
/// calls them at most ten times a second and when a new stage begins.
class HostProgress : public Progress {
public:
    /// The same type as vcg::CallBackPos; may be null.
    using CallBack = bool(const int, const char*);

    explicit HostProgress(CallBack* call_back) : call_back_(call_back) {}
    bool operator()(double fraction, const char* text) override;

private:
    CallBack* call_back_;
    std::string stage_;
    std::chrono::steady_clock::time_point last_call_{};
};

/// Learns \p layer, the host's mesh, in the world coordinates that the layer's matrix \p transform gives. \p
/// colored: its vertices have colours that the settings ask for. \p start: the mesh to start from, if the
/// settings ask for one. \throws what target_space_of() and reconstruct() throw
template <class MeshType, class Matrix>
NeuralMesh run(const MeshType& layer, const Matrix& transform, const Settings& settings, bool colored,
               const IndexedMesh<double>& start, HostProgress::CallBack* call_back) {
    settings.check();
    HostProgress progress(call_back);
    return reconstruct(target_space_of(layer, transform, settings, colored), settings, progress, start);
}

/// The counters of \p layer, the host's mesh with the matrix \p transform, by signals from \p signal_layer, a
/// mesh with a matrix of its own. \throws what target_space_of(), indexed_mesh_of() and mesh_counters() throw
template <class MeshType, class Matrix>
MeshCounters run_counters(const MeshType& layer, const Matrix& transform, const MeshType& signal_layer,
                          const Matrix& signal_transform, const Settings& settings,
                          HostProgress::CallBack* call_back) {
    settings.check(counter_table());
    HostProgress progress(call_back);
    Settings of_signals = settings;
    of_signals.use_normals = false;
    const TargetSpace target = target_space_of(signal_layer, signal_transform, of_signals);
    return mesh_counters(indexed_mesh_of(layer, transform), target, settings, progress);
}

}  // namespace neuralmesh
