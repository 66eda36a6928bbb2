// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/settings.h"

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

#include "vcg_core/base/error.h"

namespace neuralmesh {

namespace {

using Kind = SettingInfo::Kind;

SettingInfo row(bool Settings::*member, const char* id, const char* label, const char* help) {
    SettingInfo info{Kind::boolean, id, label, help, false, 0, 1, {}};
    info.boolean_member = member;
    return info;
}

SettingInfo row(int Settings::*member, const char* id, const char* label, double low, double high,
                const char* help) {
    SettingInfo info{Kind::integer, id, label, help, false, low, high, {}};
    info.integer_member = member;
    return info;
}

SettingInfo row(int Settings::*member, const char* id, const char* label, std::vector<std::string> choices,
                const char* help) {
    const auto last = static_cast<double>(choices.size() - 1);
    SettingInfo info{Kind::choice, id, label, help, false, 0, last, std::move(choices)};
    info.integer_member = member;
    return info;
}

SettingInfo row(double Settings::*member, const char* id, const char* label, double low, double high,
                const char* help) {
    SettingInfo info{Kind::real, id, label, help, false, low, high, {}};
    info.real_member = member;
    return info;
}

/// A length that is negative by default: chosen by the filter.
SettingInfo length_row(double Settings::*member, const char* id, const char* label, const char* help) {
    constexpr double kLongest = 1e30;  // the hosts keep lengths as float
    SettingInfo info = row(member, id, label, -1, kLongest, help);
    info.kind = Kind::length;
    return info;
}

/// A number of a layer; -1: none.
SettingInfo layer_row(int Settings::*member, const char* id, const char* label, const char* help) {
    SettingInfo info = row(member, id, label, -1, std::numeric_limits<int>::max(), help);
    info.kind = Kind::layer;
    return info;
}

SettingInfo advanced(SettingInfo info) {
    info.advanced = true;
    return info;
}

constexpr double kLargestInt = std::numeric_limits<int>::max();

/// A value outside the range of int becomes the lowest int, which no row allows.
int nearest_int(double value) {
    const double rounded = std::round(value);
    constexpr int kLowest = std::numeric_limits<int>::min();
    return rounded > kLowest && rounded <= kLargestInt ? static_cast<int>(rounded) : kLowest;
}

std::vector<SettingInfo> mesh_rows() {
    using S = Settings;
    return {
        row(&S::target_vertices, "target_vertices", "Target vertices", 4, 20e6,
            "The mesh gets exactly this many vertices. The run time is proportional to this number from "
            "5,000 on. Below, the network grows to more vertices, and the fit removes those that contribute "
            "least."),
        row(&S::surface, "surface", "Surface", {"Automatic", "Closed", "Open"},
            "Whether the mesh has boundaries. Closed: it has none; a single scan is closed around both of its "
            "sides. Open: it ends wherever the points end. Automatic: it is closed where the points enclose "
            "space and no opening is wider than 'Close holes up to', else open."),
        length_row(
            &S::close_holes_up_to, "close_holes_up_to", "Close holes up to",
            "Holes of an open surface are closed up to this diameter of the smallest sphere around them. "
            "Negative: chosen from the spacing of the points. 0: none but gaps of about two point spacings. With Surface set to Automatic, wider openings keep the whole surface "
            "open (negative: from 6.6 % of the diagonal on)."),
        row(&S::utility_counter, "utility_counter", "Utility counter",
            {"Where the normal varies", "Where signals arrive"},
            "Which vertices are split. Where the normal varies: the mesh is dense where the surface bends "
            "and sparse where it is flat. Where signals arrive: the mesh is as dense as the cloud."),
        row(&S::start_mesh, "start_mesh", "Start mesh", {"Shell of the cloud", "Tetrahedron", "Layer"},
            "The mesh that learning starts from. Shell of the cloud: a coarse mesh around the points that "
            "already has their components and handles. Tetrahedron: the paper's, for one component without "
            "handles unless the topology is learned. Layer: the mesh in 'Start layer', for example an earlier "
            "result to refine, or one whose webs were cut and gaps bridged by hand; the result has its "
            "components, handles and boundaries."),
        layer_row(&S::start_layer, "start_layer", "Start layer",
                  "The layer with the mesh that learning starts from if the start mesh is 'Layer'; else "
                  "without effect. It is not changed."),
        row(&S::learn_topology, "learn_topology", "Learn topology",
            "While it grows, a closed mesh gives up membranes: parts without points that bridge limbs, span gaps or "
            "plug holes. Their rims are closed or joined, whichever the points support, so the number of "
            "handles and components may change. If off, or if the start mesh is a layer, they are "
            "those of the start mesh. From a tetrahedron, "
            "wide membranes that are left become holes, unless the surface is closed."),
        row(&S::fit_to_points, "fit_to_points", "Fit to points",
            "After learning, fit the surface to the points by least squares. If off, the mesh stays as the "
            "paper's learning leaves it."),
        row(&S::draw_from_faces, "draw_from_faces", "Draw from faces",
            "If the layer has faces, draw the points to learn from them, uniformly over their area. If off, "
            "the vertices of the layer are the points."),
        row(&S::selected_only, "selected_only", "Selected only",
            "Learn only the selected part of the layer: its selected faces where points are drawn from "
            "faces, else its selected vertices."),
        row(&S::remove_outliers, "remove_outliers", "Remove outliers",
            "Leave out points that lie apart from the surface: single points, clumps and scattered noise. In "
            "doubt a point stays. Points drawn from faces are never left out. If off, every point is "
            "learned."),
        row(&S::even_sampling, "even_sampling", "Even sampling",
            "If the density of the points varies, draw signals evenly over the surface instead of over the "
            "points, and let the fit weigh points by the area that each stands for. Without effect on even "
            "clouds, on points drawn from faces, and if the utility counter is 'Where signals arrive'. If "
            "off, the mesh is finer and more accurate where the points are dense."),
        row(&S::use_normals, "use_normals", "Use normals",
            "If the vertices of the layer have normals that fit the points, an open surface faces the side to "
            "which most of them point; closed parts always face out. Normals that do not fit are not used, "
            "and the log says why. If off, an open surface faces the origin, if all of it is seen from there, "
            "else up, if all of it is seen from above, else it faces out where it is convex. Without effect on "
            "points drawn from faces."),
    };
}

std::vector<SettingInfo> color_rows() {
    using S = Settings;
    return {
        row(&S::vertex_color, "vertex_color", "Vertex colour", {"Counter", "Cloud", "None"},
            "What the vertex colours show. Counter: the feature measure, from light yellow where the surface "
            "is smooth over red to purple at features. Cloud: the colours of the layer's vertices, each "
            "computed from all points near the vertex; if the layer has none, the colours of Counter. The "
            "vertex quality holds the feature measure in any case."),
    };
}

std::vector<SettingInfo> feature_rows() {
    using S = Settings;
    return {
        row(&S::select_features, "select_features", "Select features",
            "Select the features: the vertices whose measure, chosen by 'Select by', is above the feature "
            "threshold."),
        row(&S::feature_measure, "feature_measure", "Feature measure", {"Normal counter", "Crease measure"},
            "What the vertex quality holds. Normal counter: how much the normal of the vertex varied while "
            "it learned (eq 6 of the paper), about 1 on average, larger where the surface bends. Crease "
            "measure: the angle between the two planes that meet near the vertex, averaged over many moments "
            "of the learning; above 1 on sharp edges, about 2 on right angles. It is robust against noise "
            "and comparable between models."),
        row(&S::select_by, "select_by", "Select by", {"Normal counter", "Crease measure"},
            "Which measure decides what is a feature, whatever the vertex quality holds. The crease measure "
            "finds creases with the same threshold on all models, also under noise; the normal counter is "
            "the paper's."),
        row(&S::feature_threshold, "feature_threshold", "Feature threshold", 0, 1000,
            "A vertex is a feature if its crease measure is above this number or, selected by the normal "
            "counter, if its counter is above this number times the mean counter (C_nc of the paper, eq 7)."),
    };
}

SettingInfo crease_lines_row() {
    return row(
        &Settings::crease_lines, "crease_lines", "Crease lines",
        "Add a second layer with the creases of the mesh as polylines, which meet at corners. The vertex "
        "quality of that layer is the crease measure. The layer with the mesh stays the current one.");
}

std::vector<SettingInfo> run_rows() {
    using S = Settings;
    return {
        row(&S::random_seed, "random_seed", "Random seed", 0, kLargestInt,
            "The same seed gives the same result, bit for bit, on any machine and with any number of threads."),
        row(&S::threads, "threads", "Threads", 0, 1024,
            "The number of threads; 0: one per core. The result does not depend on it."),
    };
}

/// The constants of the paper's eq 9, and C_delta of eq 3.
std::vector<SettingInfo> paper_rows() {
    using S = Settings;
    return {
        row(&S::learning_rate, "learning_rate", "Learning rate", 0.001, 1,
            "α_w of the paper (eq 1): the fraction of the way to the signal that the winner moves."),
        row(&S::smoothing_rate, "smoothing_rate", "Smoothing rate", 0, 1,
            "α_L of the paper: the fraction of its tangential Laplacian that a vertex moves in a smoothing "
            "step."),
        row(&S::smoothing_steps, "smoothing_steps", "Smoothing steps", 0, 100,
            "C_L of the paper: smoothing steps over the winner's one-ring per signal."),
        row(&S::signals_per_split, "signals_per_split", "Signals per split", 1, 1e6,
            "C_vs of the paper: the number of signals from one vertex split to the next. Half as many do if the fit follows: below 2,000 vertices where it removes most of the learned vertices, and on closed surfaces where the noise exceeds 14 % of the edges."),
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
    };
}

std::vector<SettingInfo> growth_rows() {
    using S = Settings;
    return {
        row(&S::min_wins_per_split, "min_wins_per_split", "Minimum wins per split", 0, 1e6,
            "A vertex is split only after it has won this many signals since its last split or its creation. "
            "0: as in the paper, where growth can stall."),
        row(&S::settling_signals_per_vertex, "settling_signals_per_vertex", "Settling signals per vertex", 0,
            1e5,
            "Signals per vertex that are learned after the last split (at least 60,000 in all), so that "
            "positions and counters describe the final mesh. Half as many or fewer where the noise is small "
            "beside the edges, because the fit then removes vertices and places the others. 0: none."),
        row(&S::stop_below_mean_counter, "stop_below_mean_counter", "Stop below mean counter", 0, 1e6,
            "α_t of the paper (eq 8), as an angle in degrees: growth stops before the target is reached when "
            "a signal turns the winner's normal by less than this (root mean square over the last ten "
            "signals per vertex). 0: off."),
    };
}

SettingInfo signal_layer_row() {
    return layer_row(
        &Settings::signal_layer, "signal_layer", "Signal layer",
        "The layer that the signals are drawn from, such as the cloud that the mesh was made of: "
        "its faces if it has any, else its points. By default the mesh itself. It is not "
        "changed unless it is the current layer.");
}

SettingInfo signals_per_vertex_row() {
    return row(&Settings::signals_per_vertex, "signals_per_vertex", "Signals per vertex", 1, 1e5,
               "Signals per vertex of the mesh (at least 60,000 in all). More make the values less random; "
               "the run time is proportional to this number.");
}

/// The rows of all \p groups, in order.
std::vector<SettingInfo> joined(const std::vector<std::vector<SettingInfo>>& groups) {
    std::vector<SettingInfo> rows;
    for (const auto& group : groups) rows.insert(rows.end(), group.begin(), group.end());
    return rows;
}

}  // namespace

double SettingInfo::value(const Settings& settings) const {
    if (boolean_member != nullptr) return settings.*boolean_member ? 1 : 0;
    if (integer_member != nullptr) return settings.*integer_member;
    return settings.*real_member;
}

void SettingInfo::store(Settings& settings, double value) const {
    if (boolean_member != nullptr) {
        settings.*boolean_member = value != 0;
    } else if (integer_member != nullptr) {
        settings.*integer_member = nearest_int(value);
    } else {
        settings.*real_member = value;
    }
}

const std::vector<SettingInfo>& setting_table() {
    static const std::vector<SettingInfo> table = [] {
        std::vector<SettingInfo> rows =
            joined({mesh_rows(), color_rows(), feature_rows(), {crease_lines_row()}, run_rows()});
        for (const SettingInfo& info : joined({paper_rows(), growth_rows()})) rows.push_back(advanced(info));
        return rows;
    }();
    return table;
}

const std::vector<SettingInfo>& counter_table() {
    static const std::vector<SettingInfo> table =
        joined({{signal_layer_row()}, feature_rows(), {signals_per_vertex_row()}, run_rows()});
    return table;
}

void Settings::check() const { check(setting_table()); }

void Settings::check(const std::vector<SettingInfo>& table) const {
    for (const SettingInfo& info : table) {
        const double value = info.value(*this);
        if (value >= info.low && value <= info.high) continue;
        std::ostringstream text;
        text.imbue(std::locale::classic());
        text.precision(10);
        text << "The parameter " << info.id << " (" << info.label << ") is " << value
             << ": choose a value from " << info.low << " to " << info.high << '.';
        throw SettingError(text.str());
    }
}

}  // namespace neuralmesh
