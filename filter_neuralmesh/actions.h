// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What MeshLab sees of the filter, without MeshLab: names, help, parameters, figures and run(). The two
// adapters, one per plugin interface, translate this into the host's classes and decide nothing.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "vcg_core/base/progress.h"
#include "vcg_core/mesh_io.h"
#include "vcg_core/neural_mesh.h"
#include "vcg_core/reconstruct.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

/// One entry of the Filters menu. Names are API: scripts key on them.
struct Action {
    int id;
    const char* name;         ///< menu and .mlx
    const char* python_name;  ///< pymeshlab
    const char* info;         ///< HTML, with the reference as MeshLab formats it
};

constexpr int kReconstruct = 0;
constexpr const char* kPluginName = "FilterNeuralMesh";
constexpr const char* kVendor = "The Neural Mesh authors";
constexpr const char* kLayerLabel = "Neural Mesh";
constexpr const char* kNoLayer =
    "There is no current layer to learn: open or create a point cloud or a mesh first.";

/// All actions, in order of their ids, which count from 0.
const std::vector<Action>& all_actions();

/// \pre id is one of all_actions()
const Action& action_of(int id);

/// One figure of a run under the key it has in the filter's results.
struct Figure {
    const char* key;
    double value;
    bool is_count;  ///< an int for Python, else a double

    /// A count as an int; what is beyond int, as signals may be, becomes the largest one.
    int count() const;
};

/// The figures of \p report in the order they are told.
std::vector<Figure> figures(const Report& report);

/// What the log is told after a run beside the warnings: a sentence, all figures as key=value, and how sure
/// the topology is.
std::vector<std::string> log_lines(const Report& report);

/// The warning that the coordinates of the new layer are counted from \p origin.
std::string sentence_on_origin(const Coordinates& origin);

/// The number a user meant who gave \p value to a host that keeps parameters as float: the shortest decimal
/// that rounds to it. So .06 is the same number in every host, be its parameters float or double.
double from_host(double value);

/// What an exception means to the user. Call it inside a catch block, for the exception being handled. Throws
/// nothing: where not even the sentence finds memory, it is a shorter one.
std::string sentence_of_current_exception();

/// The host's progress callback as the core's progress. At most ten calls a second beside those at a change
/// of stage, as some hosts redraw their window in each.
class HostProgress : public Progress {
public:
    /// vcg::CallBackPos, spelled out; null: nobody listens.
    using CallBack = bool(const int, const char*);

    explicit HostProgress(CallBack* call_back) : call_back_(call_back) {}
    bool operator()(double fraction, const char* text) override;

private:
    CallBack* call_back_;
    std::string stage_;
    std::chrono::steady_clock::time_point last_call_{};
};

/// Learns \p layer, given as the host's mesh and its matrix, and changes neither.
/// \throws what target_space_of() and reconstruct() throw
template <class MeshType, class Matrix>
NeuralMesh run(const MeshType& layer, const Matrix& transform, const Settings& settings,
               HostProgress::CallBack* call_back) {
    settings.check();
    HostProgress progress(call_back);
    return reconstruct(target_space_of(layer, transform, settings), settings, progress);
}

}  // namespace neuralmesh
