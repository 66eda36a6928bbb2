// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/run_figures.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string>

namespace neuralmesh {

namespace {

Figure count_of(const char* key, long long n) { return {key, static_cast<double>(n), true}; }

}  // namespace

int Figure::count() const {
    const int largest = std::numeric_limits<int>::max();
    return value < largest ? static_cast<int>(value) : largest;
}

std::vector<Figure> figures_of_reconstruction(const Report& report) {
    return {count_of("vertices", report.vertices),
            count_of("faces", report.faces),
            count_of("signals", report.signals),
            count_of("splits", report.splits),
            count_of("collapses", report.collapses),
            count_of("genus", report.genus),
            count_of("boundary_loops", report.boundary_loops),
            count_of("components", report.components),
            count_of("outliers", report.outliers),
            count_of("feature_vertices", report.feature_vertices),
            count_of("crease_lines", report.crease_lines),
            count_of("warnings", static_cast<long long>(report.warnings.size())),
            {"rms_error", report.rms_error, false},
            {"held_out_error", report.held_out_error, false},
            {"mean_counter", report.mean_counter, false},
            {"topology_confidence", report.topology_confidence, false},
            {"seconds", report.seconds, false},
            count_of("stop_reason", static_cast<int>(report.stop_reason))};
}

std::vector<Figure> figures_of_counters(const Report& report) {
    const std::set<std::string> kept{"vertices", "signals",      "outliers", "feature_vertices",
                                     "warnings", "mean_counter", "seconds",  "stop_reason"};
    std::vector<Figure> figures = figures_of_reconstruction(report);
    figures.erase(std::remove_if(figures.begin(), figures.end(),
                                 [&](const Figure& figure) { return kept.count(figure.key) == 0; }),
                  figures.end());
    return figures;
}

}  // namespace neuralmesh
