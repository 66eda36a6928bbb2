// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/run_figures.h"

#include <limits>

namespace neuralmesh {

namespace {

Figure count_of(const char* key, long long n) { return {key, static_cast<double>(n), true}; }

Figure warning_count(const Report& report) {
    return count_of("warnings", static_cast<long long>(report.warnings.size()));
}

Figure reason_to_stop(const Report& report) {
    return count_of("stop_reason", static_cast<int>(report.stop_reason));
}

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
            warning_count(report),
            {"rms_error", report.rms_error, false},
            {"held_out_error", report.held_out_error, false},
            {"mean_counter", report.mean_counter, false},
            {"topology_confidence", report.topology_confidence, false},
            {"seconds", report.seconds, false},
            reason_to_stop(report)};
}

std::vector<Figure> figures_of_counters(const Report& report) {
    return {count_of("vertices", report.vertices),
            count_of("signals", report.signals),
            count_of("outliers", report.outliers),
            count_of("feature_vertices", report.feature_vertices),
            warning_count(report),
            {"mean_counter", report.mean_counter, false},
            {"seconds", report.seconds, false},
            reason_to_stop(report)};
}

}  // namespace neuralmesh
