// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Every parameter of a run: default, range, meaning and, if it is the paper's, its symbol and equation. The
// dialog, the scripts, the documentation and the tests all take them from this table.
//
// "The paper" here and everywhere in the core: W.-K. Jeong, I. P. Ivrissimtzis, H.-P. Seidel,
// "Neural Meshes: Statistical Learning based on Normals", Pacific Graphics 2003.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "vcg_core/paper/constants.h"

namespace neuralmesh {

/// How much of a feature a vertex is: what the vertex quality of the result holds, and what selects.
enum FeatureMeasure : int {
    kFeatureCounter = 0,  ///< eq 6; "normal counter" in the dialog
    kCreaseMeasure = 1,   ///< angle between the planes at a vertex, see learning/crease_measure.h
};

/// What the vertex colours of the result show.
enum VertexColor : int {
    kCounterColors = 0,  ///< the feature measure, see vertex_colors.h
    kCloudColors = 1,    ///< the colours of the cloud, see vertex_colors.h; without any: the feature measure
    kNoColors = 2,
};

/// The mesh that learning starts from.
enum StartShape : int {
    kShell = 0,        ///< a coarse mesh around the cloud that already has its components and handles
    kTetrahedron = 1,  ///< the paper's: one component without handles, unless learn_topology is on
    kGivenMesh = 2,    ///< a mesh of the caller's, see start/given_start.h
};

/// Whether the mesh has boundaries.
enum SurfaceKind : int {
    kAutomatic = 0,      ///< closed if the cloud encloses space, but for openings that are too wide to close
    kClosedSurface = 1,  ///< no boundary
    kOpenSurface = 2,    ///< boundaries where the points end
};

struct SettingInfo;

/// All parameters of both filters. setting_table() and counter_table() have their ranges and meanings.
struct Settings : LearningConstants {
    int target_vertices = 10000;
    double target_error = 0;  ///< in the units of the input, see learn_to_error.h; 0: off
    int surface = kAutomatic;
    double close_holes_up_to = -1;  ///< a diameter in the units of the input; negative: chosen by the filter
    int start_mesh = kShell;
    /// For kGivenMesh: the host's number of the layer, which only the host reads; -1: none.
    int start_layer = 0;
    /// Growth gives up membranes, see topology/learned_topology.h; not of a given mesh.
    bool learn_topology = true;
    bool fit_to_points = true;
    bool draw_from_faces = true;
    bool selected_only = false;
    bool remove_outliers = true;  ///< only of points; see cloud/outlier_removal.h
    bool even_sampling = true;    ///< only of points; see CloudSurvey
    bool use_normals = true;      ///< only of points; see layer_normals.h
    int vertex_color = kCloudColors;
    bool select_features = false;
    int feature_measure = kFeatureCounter;
    int select_by = kCreaseMeasure;
    bool crease_lines = false;
    double feature_threshold = 1.0;        ///< of select_by; of the counter C_nc, eq 7
    double stop_below_mean_counter = 0.0;  ///< alpha_t, eq 8; 0: off

    // Of the counters of a given mesh, see mesh_counters.h.
    int signal_layer = 0;         ///< as start_layer
    int signals_per_vertex = 60;  ///< signals per vertex of the mesh

    /// Whether the quality, the selection or the crease lines need \p measure.
    bool uses(FeatureMeasure measure) const {
        return feature_measure == measure || select_by == measure ||
               (crease_lines && measure == kCreaseMeasure);
    }
    /// Whether the fit may take vertices away from one place and put them in another: only the number of
    /// vertices ends growth, and where they are follows the surface.
    bool redistributes_vertices() const {
        return fit_to_points && utility_counter == kNormalVariation && start_mesh != kTetrahedron &&
               stop_below_mean_counter <= 0;
    }
    /// \throws SettingError for a value of \p table out of its range, naming parameter, value and range
    void check(const std::vector<SettingInfo>& table) const;
    void check() const;  ///< of setting_table()
};

/// What a parameter is about, in the order of a run; the mesh that is asked for comes first.
enum class Stage { mesh, cloud, start, learning, fit, features, output, run };

/// One parameter: its name, explanation, range, and the member of Settings that holds it.
struct SettingInfo {
    /// A length is a real number in the units of the input. Dialogs show it as a share of the diagonal, too.
    /// A layer is known by a number of the host's.
    enum class Kind { boolean, integer, real, length, choice, layer };

    Kind kind;
    const char* id;                    ///< snake_case; API: scripts key on it
    const char* label;                 ///< in the dialog
    const char* help;                  ///< tooltip and reference
    Stage stage;
    bool advanced;                     ///< hidden until the user asks for advanced parameters
    double low, high;                  ///< closed range; booleans: 0 and 1
    std::vector<std::string> choices;  ///< names of a choice's values, in order from 0

    /// Where Settings holds it. Choices and layers are integers, lengths are real numbers.
    using Member = std::variant<bool Settings::*, int Settings::*, double Settings::*>;
    Member member;

    /// The parameter's value in \p settings, as a number.
    double value(const Settings& settings) const;
    /// Stores \p value, rounded if the parameter is an integer, without checking its range. If it does not
    /// fit into int or is NaN, it is stored as a number that Settings::check() refuses.
    void store(Settings& settings, double value) const;
};

/// The parameters of the reconstruction in the order of its dialog: first those for a newcomer, then the
/// advanced ones, both in the order of their stages. Their defaults are those of Settings().
const std::vector<SettingInfo>& setting_table();

/// The same of the counters of a given mesh.
const std::vector<SettingInfo>& counter_table();

}  // namespace neuralmesh
