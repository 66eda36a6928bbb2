// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of parameters, and the check against it.
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

SettingInfo advanced(SettingInfo info) {
    info.advanced = true;
    return info;
}

constexpr double kLargestInt = std::numeric_limits<int>::max();

/// What no int can hold becomes the lowest one, which no row allows.
int nearest_int(double value) {
    const double rounded = std::round(value);
    constexpr int kLowest = std::numeric_limits<int>::min();
    return rounded > kLowest && rounded <= kLargestInt ? static_cast<int>(rounded) : kLowest;
}

std::vector<SettingInfo> common_rows() {
    using S = Settings;
    return {
        row(&S::target_vertices, "target_vertices", "Target vertices", 4, 20e6,
            "The mesh gets exactly this many vertices. From 5,000 on the time needed grows in proportion; "
            "for fewer "
            "ones more are learned, and the fit takes some out."),
        row(&S::utility_counter, "utility_counter", "Utility counter", {"Normal counter", "Signal counter"},
            "What makes a vertex worth splitting. Normal counter: how much the surface bends there, so the "
            "mesh "
            "is dense at curved places and sparse at flat ones. Signal counter: how often the vertex wins, "
            "so "
            "the mesh follows the density of the cloud."),
        row(&S::start_mesh, "start_mesh", "Start mesh", {"Shell of the cloud", "Tetrahedron"},
            "What the learning starts from. Shell of the cloud: a coarse mesh around the points that already "
            "has "
            "their components and handles. Tetrahedron: the paper's, for one piece without handles."),
        row(&S::fit_to_points, "fit_to_points", "Fit to points",
            "After learning, move the vertices by least squares to where the surface is closest to the "
            "points. "
            "Switched off: the mesh as the paper's learning leaves it."),
        row(&S::draw_from_faces, "draw_from_faces", "Draw from faces",
            "A layer that has faces is sampled uniformly over its area. Switched off, or if the layer has no "
            "faces, its vertices are the cloud."),
        row(&S::selected_only, "selected_only", "Selected only",
            "Learn the selected part of the layer alone: its selected faces if it is drawn from faces, else "
            "its "
            "selected vertices."),
        row(&S::color_by_counter, "color_by_counter", "Colour by counter",
            "Colour the vertices of the result by what the feature measure says of them: dark violet where "
            "the surface is smooth, over green to yellow at features. The number itself is the vertex "
            "quality "
            "in any case."),
        row(&S::select_features, "select_features", "Select features",
            "Select the vertices of the result of which the feature measure says more than the feature "
            "threshold."),
        row(&S::feature_measure, "feature_measure", "Feature measure", {"Normal counter", "Crease measure"},
            "What the vertex quality holds. Normal counter: the paper's (eq 6), the variation of the "
            "vertex's normal during learning, about 1 on average; high where the surface bends. Crease "
            "measure: the angle between the two planes around the vertex, over many moments of the "
            "learning, fading with its distance from where they meet; above 1 on sharp edges (about 2 at "
            "a right angle), robust against noise, comparable between models."),
        row(&S::feature_threshold, "feature_threshold", "Feature threshold", 0, 1000,
            "C_nc of the paper (eq 7): a vertex is a feature if its normal counter is above this many times "
            "the mean "
            "counter. For the crease measure the threshold counts as it is."),
        row(&S::random_seed, "random_seed", "Random seed", 0, kLargestInt,
            "The same seed gives the same mesh to the last bit, on any machine and with any number of "
            "threads."),
        row(&S::threads, "threads", "Threads", 0, 1024,
            "How many threads may work. 0: as many as the machine has. The result is the same for any "
            "number."),
    };
}

std::vector<SettingInfo> advanced_rows() {
    using S = Settings;
    return {
        row(&S::learning_rate, "learning_rate", "Learning rate", 0.001, 1,
            "α_w of the paper (eq 1): the part of the way to the signal that the winner moves."),
        row(&S::smoothing_rate, "smoothing_rate", "Smoothing rate", 0, 1,
            "α_L of the paper: the part of the tangential Laplacian that the winner's neighbours move."),
        row(&S::smoothing_steps, "smoothing_steps", "Smoothing steps", 0, 100,
            "C_L of the paper: sweeps over the winner's neighbours per signal."),
        row(&S::signals_per_split, "signals_per_split", "Signals per split", 1, 1e6,
            "C_vs of the paper: signals between two vertex splits."),
        row(&S::signals_per_collapse, "signals_per_collapse", "Signals per collapse", 1, 1e6,
            "C_ec of the paper: after this many signals per vertex, those that never won are removed by "
            "half-edge collapses."),
        row(&S::counter_decay, "counter_decay", "Counter decay", 0.01, 1,
            "α_nc of the paper (after eq 4): what is left of all utility counters after each signal."),
        row(&S::feature_decay, "feature_decay", "Feature decay", 0, 0.9999,
            "α_fd of the paper (eq 6): what is left of a winner's feature counter when it wins again."),
        row(&S::normalization_window, "normalization_window", "Normalization window", 1, 1e6,
            "C_δ of the paper (eq 3): the number of latest signals whose mean normal variation is the unit."),
        row(&S::min_wins_per_split, "min_wins_per_split", "Minimum wins per split", 0, 1e6,
            "A vertex must have won this many signals since its last split, or its birth, before it is split "
            "again. 0: the paper to the letter, where growth can stall."),
        row(&S::settling_signals_per_vertex, "settling_signals_per_vertex", "Settling signals per vertex", 0,
            1e5,
            "Learning goes on for this many signals per vertex after the last split, and at least 60,000 in "
            "all, so "
            "that positions and counters speak of the final mesh. 0: it does not."),
        row(&S::stop_below_mean_counter, "stop_below_mean_counter", "Stop below mean counter", 0, 1e6,
            "α_t of the paper (eq 8), as an angle in degrees: growth ends before the target when a signal "
            "turns the winner's normal by less than this, root mean square over the last ten signals per "
            "vertex. 0: off."),
    };
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
        std::vector<SettingInfo> rows = common_rows();
        for (const SettingInfo& info : advanced_rows()) rows.push_back(advanced(info));
        return rows;
    }();
    return table;
}

void Settings::check() const {
    for (const SettingInfo& info : setting_table()) {
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
