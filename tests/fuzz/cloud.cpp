// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Arbitrary bytes as coordinates of a few points or triangles and as settings: the run throws an Error with a
// sentence, or returns a finite manifold of exactly target_vertices vertices.
#include <cmath>

#include "bytes.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/reconstruct.h"

namespace {

using namespace neuralmesh;
using fuzz::Bytes;
using fuzz::expect;
using fuzz::fail;

constexpr std::size_t kMostPoints = 400;

Settings settings_of(Bytes& bytes) {
    Settings settings;
    const int flags = bytes.byte();
    settings.start_mesh = (flags & 1) != 0 ? kTetrahedron : kShell;
    settings.fit_to_points = (flags & 2) != 0;
    settings.draw_from_faces = (flags & 4) != 0;
    settings.utility_counter = (flags & 8) != 0 ? kSignalCount : kNormalVariation;
    settings.feature_measure = (flags & 16) != 0 ? kCreaseMeasure : kFeatureCounter;
    // One input in eight has the costly combinations: settling takes at least 60,000 signals, and faces are
    // sampled 200,000 times for the shell and 50,000 times for the fit.
    const bool costly = (flags & 0xe0) == 0xe0;
    settings.settling_signals_per_vertex = costly ? 1 : 0;
    if (settings.draw_from_faces && !costly) {
        settings.start_mesh = kTetrahedron;
        settings.fit_to_points = false;
    }
    settings.min_wins_per_split = 5;
    settings.signals_per_split = 20;
    settings.threads = 1;
    settings.target_vertices = 4 + bytes.byte();
    // Of the three ways and of the bound on holes by turns; the other bytes stay what they were.
    settings.surface = settings.target_vertices % 3;
    settings.close_holes_up_to = settings.target_vertices % 5 * 10 - 1;
    settings.select_by = settings.target_vertices % 2;
    return settings;
}

/// A number from the whole range of double or float, or from a small grid, on which points coincide and
/// align.
double coordinate(Bytes& bytes, int format) {
    switch (format) {
        case 0: return bytes.raw<double>();
        case 1: return static_cast<double>(bytes.raw<float>());
        case 2: return bytes.raw<std::int16_t>() / 32768.0;
        default: return bytes.below(16) / 8.0 + 1000;
    }
}

std::vector<vcg::Point3d> points_of(Bytes& bytes) {
    const int format = bytes.below(4);
    std::vector<vcg::Point3d> points;
    while (bytes.left() > 0 && points.size() < kMostPoints) {
        const double x = coordinate(bytes, format);
        const double y = coordinate(bytes, format);
        points.emplace_back(x, y, coordinate(bytes, format));
    }
    return points;
}

TargetSpace target_of(const std::vector<vcg::Point3d>& points, bool faces) {
    if (!faces) return neuralmesh::target_of(points);
    return TargetSpace::triangles(
        points.size() / 3, [&](std::size_t i, int k) { return points[3 * i + static_cast<std::size_t>(k)]; });
}

void check(const NeuralMesh& mesh, const Settings& settings) {
    const Census found = census(mesh.faces);
    if (!found.breach.empty()) fail("the faces are no manifold: " + found.breach);
    expect(found.vertices == static_cast<int>(mesh.positions.size()), "a vertex without faces");
    expect(found.loops == mesh.report.boundary_loops, "the boundary is misreported");
    expect(found.loops == 0 || settings.surface != kClosedSurface, "not closed");
    expect(
        mesh.report.stop_reason != StopReason::target_reached || found.vertices == settings.target_vertices,
        "not target_vertices vertices");
    expect(mesh.report.components == found.components &&
               2 * (mesh.report.components - mesh.report.genus) - found.loops == found.euler(),
           "the topology is misreported");
    expect(mesh.counters.size() == mesh.positions.size() && mesh.features.size() == mesh.positions.size(),
           "not one counter and one mark for every vertex");
    for (const vcg::Point3d& p : mesh.positions)
        for (int k = 0; k < 3; ++k) expect(std::isfinite(p[k]), "a coordinate is not finite");
    for (const float counter : mesh.counters)
        expect(counter >= 0 && std::isfinite(counter), "a counter is below 0 or not finite");
    expect(mesh.report.rms_error >= 0 && std::isfinite(mesh.report.rms_error), "the error is not finite");
    for (const std::string& warning : mesh.report.warnings) fuzz::expect_sentence(warning);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    const Settings settings = settings_of(bytes);
    const std::vector<vcg::Point3d> points = points_of(bytes);
    NoProgress progress;
    try {
        check(reconstruct(target_of(points, settings.draw_from_faces), settings, progress), settings);
    } catch (const InputError& error) {
        fuzz::expect_sentence(error.what());
    } catch (const SettingError& error) {  // too few vertices for an open surface
        fuzz::expect_sentence(error.what());
    }
    return 0;
}
