// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Every constant of a run: default, range, meaning and, where it is the paper's, its symbol and equation.
// This table is the single source for the filter's dialog, the scripts, the documentation and the tests.
//
// "The paper" here and everywhere in the core: W.-K. Jeong, I. P. Ivrissimtzis, H.-P. Seidel,
// "Neural Meshes: Statistical Learning based on Normals", Pacific Graphics 2003.
#pragma once

#include <string>
#include <vector>

namespace neuralmesh {

/// What makes a vertex worth splitting (the paper's utility counter, sections 2 and 3).
enum UtilityCounter : int {
    kNormalCounter = 0,  ///< variation of the normal: denser where the surface bends
    kSignalCounter = 1,  ///< number of wins: density of the mesh follows density of the cloud
};

/// What the quality of the result holds, and what selects features.
enum FeatureMeasure : int {
    kFeatureCounter = 0,  ///< the paper's normal counter of eq 6
    kCreaseMeasure =
        1,  ///< features.h: angle of the planes around a vertex, over many moments of the learning
};

/// What the learning starts from.
enum StartShape : int {
    kShell = 0,        ///< the shell of the cloud: its components and handles are there from the start
    kTetrahedron = 1,  ///< the paper's: one piece without handles
};

/// All parameters of a run. Plain data; check() says whether it makes sense.
struct Settings {
    int target_vertices = 10000;
    int utility_counter = kNormalCounter;
    int start_mesh = kShell;
    bool fit_to_points = true;
    bool draw_from_faces = true;
    bool selected_only = false;
    bool color_by_counter = true;
    bool select_features = false;
    int feature_measure = kFeatureCounter;
    double feature_threshold = 1.0;  ///< C_nc, eq 7
    int random_seed = 1;
    int threads = 0;  ///< 0: as many as the machine has

    double learning_rate = 0.06;           ///< alpha_w, eq 1
    double smoothing_rate = 0.05;          ///< alpha_L
    int smoothing_steps = 5;               ///< C_L
    int signals_per_split = 100;           ///< C_vs
    int signals_per_collapse = 10;         ///< C_ec
    double counter_decay = 0.95;           ///< alpha_nc, after eq 4
    double feature_decay = 0.95;           ///< alpha_fd, eq 6
    int normalization_window = 1000;       ///< C_delta, eq 3
    int min_wins_per_split = 30;           ///< maturity; 0: the paper to the letter
    int settling_signals_per_vertex = 60;  ///< learning after the last split
    double stop_below_mean_counter = 0.0;  ///< alpha_t, eq 8; 0: off

    /// Throws SettingError naming the parameter, its value, its range and the remedy. O(1).
    void check() const;
};

/// One row of the table: how a parameter is named, explained, bounded, and where it is stored.
struct SettingInfo {
    enum class Kind { boolean, integer, real, choice };

    Kind kind;
    const char* id;                    ///< snake_case; API: scripts key on it
    const char* label;                 ///< for a dialog
    const char* help;                  ///< for a tooltip and the reference
    bool advanced;                     ///< shown on request only
    double low, high;                  ///< closed range; booleans: 0 and 1
    std::vector<std::string> choices;  ///< names of a choice's values, in order from 0

    bool Settings::*boolean_member = nullptr;
    int Settings::*integer_member = nullptr;  ///< integers and choices
    double Settings::*real_member = nullptr;

    /// The parameter's value in \p settings, as a number.
    double value(const Settings& settings) const;
    /// Stores \p value (rounded where the parameter is an integer) without checking it. An integer out of
    /// int's range, or NaN, is stored as one that Settings::check() refuses, whatever the parameter.
    void store(Settings& settings, double value) const;
};

/// All parameters in the order of the dialog. The defaults are those of a default-constructed Settings.
const std::vector<SettingInfo>& setting_table();

}  // namespace neuralmesh
