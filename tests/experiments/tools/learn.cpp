// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The core as a command, for experiments: learn IN.ply OUT.ply [START.ply] [parameter=value ...]
// Reads and writes PLY through vcglib, takes every parameter of the settings table by its id, and prints
// the report as one line of JSON. START.ply is the mesh for start_mesh 2. With crease_lines=1 the lines are
// in OUT.ply.creases.ply.
#include <wrap/io_trimesh/export_ply.h>

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "tests/experiments/tools/ply_mesh.h"
#include "vcg_core/reconstruct.h"

namespace {

void save(const neuralmesh::PlyMesh& mesh, const std::string& path, int mask) {
    using Exporter = vcg::tri::io::ExporterPLY<neuralmesh::PlyMesh>;
    const int failed = Exporter::Save(mesh, path.c_str(), mask, true);
    if (failed != 0)
        throw std::runtime_error("Cannot write " + path + ": " + Exporter::ErrorMsg(failed) + ".");
}

void save_lines(const neuralmesh::CreaseLines& lines, const std::string& path) {
    neuralmesh::PlyMesh out;
    neuralmesh::write_creases(lines, out);
    save(out, path, vcg::tri::io::Mask::IOM_VERTQUALITY | vcg::tri::io::Mask::IOM_EDGEINDEX);
}

int learn(int argc, char** argv) {
    neuralmesh::Settings settings;
    const bool has_start = argc > 3 && std::string(argv[3]).find('=') == std::string::npos;
    for (int i = has_start ? 4 : 3; i < argc; ++i) neuralmesh::set_parameter(settings, argv[i]);
    const auto start = has_start ? neuralmesh::mesh_of_ply(argv[3]) : neuralmesh::IndexedMesh<double>();
    const auto target = neuralmesh::target_of_ply(argv[1], settings);
    neuralmesh::NoProgress progress;
    const neuralmesh::NeuralMesh result = neuralmesh::reconstruct(target, settings, progress, start);
    neuralmesh::PlyMesh out;
    neuralmesh::write_mesh(result, settings, out);
    using Mask = vcg::tri::io::Mask;
    save(out, argv[2], Mask::IOM_VERTQUALITY | Mask::IOM_VERTCOLOR);
    if (settings.crease_lines) save_lines(result.creases, std::string(argv[2]) + ".creases.ply");
    const neuralmesh::Report& r = result.report;
    for (const std::string& note : r.notes) std::fprintf(stderr, "Note: %s\n", note.c_str());
    for (const std::string& warning : r.warnings) std::fprintf(stderr, "%s\n", warning.c_str());
    std::printf(
        "{\"vertices\":%d,\"faces\":%d,\"signals\":%lld,\"splits\":%lld,\"collapses\":%lld,\"genus\":%d,"
        "\"boundary_loops\":%d,\"components\":%d,\"feature_vertices\":%d,\"crease_lines\":%d,\"rms_error\":%.6g,"
        "\"mean_counter\":%.6g,\"topology_confidence\":%.3g,\"seconds\":%.4g,\"stop_reason\":%d}\n",
        r.vertices, r.faces, r.signals, r.splits, r.collapses, r.genus, r.boundary_loops, r.components,
        r.feature_vertices, r.crease_lines, r.rms_error, r.mean_counter, r.topology_confidence, r.seconds,
        static_cast<int>(r.stop_reason));
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 3) {
        std::fprintf(stderr, "usage: %s IN.ply OUT.ply [START.ply] [parameter=value ...]\n", argv[0]);
        return 2;
    }
    return learn(argc, argv);
} catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
