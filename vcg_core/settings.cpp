// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "vcg_core/base/error.h"
#include "vcg_core/base/text.h"

namespace neuralmesh {

namespace {

using Kind = SettingInfo::Kind;

using Member = SettingInfo::Member;

SettingInfo row(Kind kind, const Member& member, const char* id, const char* label, double low, double high,
                const char* help, std::vector<std::string> choices = {}) {
    return {kind, id, label, help, Stage::mesh, false, low, high, std::move(choices), member};
}

SettingInfo row(bool Settings::*member, const char* id, const char* label, const char* help) {
    return row(Kind::boolean, member, id, label, 0, 1, help);
}

SettingInfo row(int Settings::*member, const char* id, const char* label, double low, double high,
                const char* help) {
    return row(Kind::integer, member, id, label, low, high, help);
}

SettingInfo row(double Settings::*member, const char* id, const char* label, double low, double high,
                const char* help) {
    return row(Kind::real, member, id, label, low, high, help);
}

SettingInfo row(int Settings::*member, const char* id, const char* label, std::vector<std::string> choices,
                const char* help) {
    const auto last = static_cast<double>(choices.size() - 1);
    return row(Kind::choice, member, id, label, 0, last, help, std::move(choices));
}

SettingInfo length_row(double Settings::*member, const char* id, const char* label, double low,
                       const char* help) {
    constexpr double kLongest = 1e30;  // the hosts keep lengths as float
    return row(Kind::length, member, id, label, low, kLongest, help);
}

/// A number of a layer; -1: none.
SettingInfo layer_row(int Settings::*member, const char* id, const char* label, const char* help) {
    return row(Kind::layer, member, id, label, -1, std::numeric_limits<int>::max(), help);
}

SettingInfo advanced(SettingInfo info) {
    info.advanced = true;
    return info;
}

std::vector<SettingInfo> all_advanced(std::vector<SettingInfo> rows) {
    for (SettingInfo& info : rows) info.advanced = true;
    return rows;
}

constexpr double kLargestInt = std::numeric_limits<int>::max();

/// A value outside the range of int becomes the lowest int, which no row allows.
int nearest_int(double value) {
    const double rounded = std::round(value);
    constexpr int kLowest = std::numeric_limits<int>::min();
    return rounded > kLowest && rounded <= kLargestInt ? static_cast<int>(rounded) : kLowest;
}

/// What the mesh is to be like.
std::vector<SettingInfo> mesh_rows() {
    using S = Settings;
    return {
        row(&S::target_vertices, "target_vertices", "Target vertices", 4, 20e6,
            "The mesh gets exactly this many vertices; with a target error it gets at most as many."),
        length_row(
            &S::target_error, "target_error", "Target error", 0,
            "The mesh gets as many vertices as are needed for the points to lie this far from it (root "
            "mean square, less their noise). 0: the number of vertices is given."),
        row(&S::surface, "surface", "Surface", {"Automatic", "Closed", "Open"},
            "Whether the mesh has boundaries. Closed: it has none; a single scan is closed around both of its "
            "sides. Open: it ends wherever the points end. Automatic: it is closed where the points enclose "
            "space and no opening is wider than 'Close holes up to', else open."),
        length_row(
            &S::close_holes_up_to, "close_holes_up_to", "Close holes up to", -1,
            "Holes of an open surface are closed up to this diameter; negative: chosen from the spacing of the "
            "points. With Surface set to Automatic, wider openings keep the whole surface open."),
        advanced(row(
            &S::utility_counter, "utility_counter", "Utility counter",
            {"Where the normal varies", "Where signals arrive"},
            "Which vertices are split. Where the normal varies: the mesh is dense where the surface bends "
            "and sparse where it is flat. Where signals arrive: the mesh is as dense as the cloud.")),
    };
}

std::vector<SettingInfo> cloud_rows() {
    using S = Settings;
    return {
        row(&S::remove_outliers, "remove_outliers", "Remove outliers",
            "Leave out points that lie apart from the surface; in doubt a point stays."),
        advanced(row(&S::draw_from_faces, "draw_from_faces", "Draw from faces",
                     "If the layer has faces, draw the points to learn from them, evenly over their area; if "
                     "off, the vertices of the layer are the points.")),
        advanced(row(&S::selected_only, "selected_only", "Selected only",
                     "Learn only the selected faces of the layer or, where its vertices are the points, only "
                     "the selected vertices.")),
        advanced(
            row(&S::even_sampling, "even_sampling", "Even sampling",
                "Where the density of the points varies, learn the surface evenly instead of the points; "
                "if off, the mesh is finer where the points are dense. Without effect on points drawn "
                "from faces, and if the utility counter is 'Where signals arrive'.")),
        advanced(row(&S::use_normals, "use_normals", "Use normals",
                     "The normals of the layer's vertices, if they fit the points, say which side of an open "
                     "surface faces out; closed parts always face out.")),
    };
}

std::vector<SettingInfo> start_rows() {
    using S = Settings;
    return {
        advanced(row(
            &S::start_mesh, "start_mesh", "Start mesh", {"Shell of the cloud", "Tetrahedron", "Layer"},
            "The mesh that learning starts from. Shell of the cloud: a coarse mesh around the points that "
            "already has their components and handles. Tetrahedron: the paper's. Layer: the mesh in "
            "'Start layer', such as an earlier result, whose components, handles and boundaries stay.")),
        advanced(layer_row(
            &S::start_layer, "start_layer", "Start layer",
            "The layer with the mesh to start from, if the start mesh is 'Layer'; it is not changed.")),
    };
}

/// Topology, the constants of the paper's eq 9 and C_delta of eq 3, and what ends growth.
std::vector<SettingInfo> learning_rows() {
    using S = Settings;
    return all_advanced({
        row(&S::learn_topology, "learn_topology", "Learn topology",
            "While it grows, a closed mesh gives up membranes: parts without points that bridge limbs, span "
            "gaps or plug holes. If off, or if the start mesh is a layer, handles and components are those of "
            "the start mesh."),
        row(&S::learning_rate, "learning_rate", "Learning rate", 0.001, 1,
            "α_w of the paper (eq 1): the fraction of the way to the signal that the winner moves."),
        row(&S::smoothing_rate, "smoothing_rate", "Smoothing rate", 0, 1,
            "α_L of the paper: the fraction of its tangential Laplacian that a vertex moves in a smoothing "
            "step."),
        row(&S::smoothing_steps, "smoothing_steps", "Smoothing steps", 0, 100,
            "C_L of the paper: smoothing steps over the winner's one-ring per signal."),
        row(&S::signals_per_split, "signals_per_split", "Signals per split", 1, 1e6,
            "C_vs of the paper: the number of signals from one vertex split to the next; fewer where the fit "
            "makes up for them."),
        row(&S::signals_per_collapse, "signals_per_collapse", "Signals per collapse", 1, 1e6,
            "C_ec of the paper: after this many signals per vertex, the vertices that won none of them are "
            "removed by half-edge collapses."),
        row(&S::counter_decay, "counter_decay", "Counter decay", 0.01, 1,
            "α_nc of the paper (after eq 4): the factor that all utility counters are multiplied by after "
            "each signal."),
        row(&S::feature_decay, "feature_decay", "Feature decay", 0, 0.9999,
            "α_fd of the paper (eq 6): the factor that the feature counter of the winner is multiplied by "
            "before the signal is added."),
        row(&S::normalization_window, "normalization_window", "Normalization window", 1, 1e6,
            "C_δ of the paper (eq 3): the variation of a normal is divided by the mean over this many "
            "signals."),
        row(&S::min_wins_per_split, "min_wins_per_split", "Minimum wins per split", 0, 1e6,
            "A vertex is split only after it has won this many signals since its last split or its creation; "
            "0: as in the paper, where growth can stall."),
        row(&S::settling_signals_per_vertex, "settling_signals_per_vertex", "Settling signals per vertex", 0,
            1e5,
            "Signals per vertex that are learned after the last split, so that positions and counters "
            "describe the final mesh; fewer where the fit makes up for them; 0: none."),
        row(&S::stop_below_mean_counter, "stop_below_mean_counter", "Stop below mean counter", 0, 1e6,
            "α_t of the paper (eq 8), as an angle in degrees: growth stops before the target is reached when "
            "signals turn the winners' normals by less than this (root mean square); 0: off."),
    });
}

std::vector<SettingInfo> fit_rows() {
    return {advanced(row(&Settings::fit_to_points, "fit_to_points", "Fit to points",
                         "After learning, fit the surface to the points by least squares; if off, the mesh "
                         "stays as the paper's learning leaves it."))};
}

SettingInfo select_features_row() {
    return row(&Settings::select_features, "select_features", "Select features",
               "Select the features: the vertices whose measure, chosen by 'Select by', is above the feature "
               "threshold.");
}

std::vector<SettingInfo> measure_rows() {
    using S = Settings;
    return {
        row(&S::feature_measure, "feature_measure", "Feature measure", {"Normal counter", "Crease measure"},
            "What the vertex quality holds. Normal counter: how much the normal of the vertex varied while "
            "it learned (eq 6 of the paper), about 1 on average. Crease measure: the angle between the two "
            "planes that meet near the vertex; above 1 on sharp edges, also under noise."),
        row(&S::select_by, "select_by", "Select by", {"Normal counter", "Crease measure"},
            "Which measure decides what is a feature, whatever the vertex quality holds. The crease measure "
            "finds creases with the same threshold on all models; the normal counter is the paper's."),
        row(&S::feature_threshold, "feature_threshold", "Feature threshold", 0, 1000,
            "A vertex is a feature if its crease measure is above this number or, selected by the normal "
            "counter, if its counter is above this number times the mean counter (C_nc of the paper, eq 7)."),
    };
}

std::vector<SettingInfo> output_rows() {
    using S = Settings;
    return {
        row(&S::crease_lines, "crease_lines", "Crease lines",
            "Add a second layer with the creases of the mesh as polylines, which meet at corners."),
        row(&S::vertex_color, "vertex_color", "Vertex colour", {"Counter", "Cloud", "None"},
            "What the vertex colours show. Counter: the feature measure, from light yellow where the surface "
            "is smooth to purple at features. Cloud: the colours of the layer's vertices; if it has none, "
            "those of Counter."),
    };
}

std::vector<SettingInfo> run_rows() {
    using S = Settings;
    return {
        advanced(row(&S::random_seed, "random_seed", "Random seed", 0, kLargestInt,
                     "The same seed gives the same result on any machine and with any number of threads.")),
        advanced(row(&S::threads, "threads", "Threads", 0, 1024, "The number of threads; 0: one per core.")),
    };
}

SettingInfo signal_layer_row() {
    return layer_row(
        &Settings::signal_layer, "signal_layer", "Signal layer",
        "The layer that the signals are drawn from, such as the cloud that the mesh was made of: its faces if "
        "it has any, else its points. By default the mesh itself.");
}

SettingInfo signals_per_vertex_row() {
    return row(&Settings::signals_per_vertex, "signals_per_vertex", "Signals per vertex", 1, 1e5,
               "Signals per vertex of the mesh; more make the values less random and take longer.");
}

std::vector<SettingInfo> of_stage(Stage stage, std::vector<SettingInfo> rows) {
    for (SettingInfo& info : rows) info.stage = stage;
    return rows;
}

/// The rows of all \p groups, in order.
std::vector<SettingInfo> joined(const std::vector<std::vector<SettingInfo>>& groups) {
    std::vector<SettingInfo> rows;
    for (const auto& group : groups) rows.insert(rows.end(), group.begin(), group.end());
    return rows;
}

}  // namespace

double SettingInfo::value(const Settings& settings) const {
    return std::visit([&](auto held) { return static_cast<double>(settings.*held); }, member);
}

void SettingInfo::store(Settings& settings, double value) const {
    if (const auto* const boolean = std::get_if<bool Settings::*>(&member)) settings.** boolean = value != 0;
    if (const auto* const integer = std::get_if<int Settings::*>(&member))
        settings.** integer = nearest_int(value);
    if (const auto* const real = std::get_if<double Settings::*>(&member)) settings.** real = value;
}

const std::vector<SettingInfo>& setting_table() {
    static const std::vector<SettingInfo> table = [] {
        std::vector<SettingInfo> rows =
            joined({of_stage(Stage::mesh, mesh_rows()), of_stage(Stage::cloud, cloud_rows()),
                    of_stage(Stage::start, start_rows()), of_stage(Stage::learning, learning_rows()),
                    of_stage(Stage::fit, fit_rows()), of_stage(Stage::features, {select_features_row()}),
                    of_stage(Stage::features, all_advanced(measure_rows())),
                    of_stage(Stage::output, output_rows()), of_stage(Stage::run, run_rows())});
        std::stable_partition(rows.begin(), rows.end(),
                              [](const SettingInfo& info) { return !info.advanced; });
        return rows;
    }();
    return table;
}

const std::vector<SettingInfo>& counter_table() {
    static const std::vector<SettingInfo> table = joined(
        {of_stage(Stage::cloud, {signal_layer_row()}), of_stage(Stage::features, {select_features_row()}),
         of_stage(Stage::features, measure_rows()),
         of_stage(Stage::learning, {advanced(signals_per_vertex_row())}), of_stage(Stage::run, run_rows())});
    return table;
}

void Settings::check() const { check(setting_table()); }

void Settings::check(const std::vector<SettingInfo>& table) const {
    for (const SettingInfo& info : table) {
        const double value = info.value(*this);
        if (value >= info.low && value <= info.high) continue;
        std::ostringstream text = stream_with(10);
        text << "The parameter " << info.id << " (" << info.label << ") is " << value
             << ": choose a value from " << info.low << " to " << info.high << '.';
        throw SettingError(text.str());
    }
}

}  // namespace neuralmesh
