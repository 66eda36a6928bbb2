// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The core as a command, for experiments: learn IN.ply OUT.ply [parameter=value ...]
// Reads and writes PLY through vcglib, takes every parameter of the settings table by its id, and prints
// the report as one line of JSON.
#include <vcg/complex/complex.h>
#include <wrap/io_trimesh/export_ply.h>
#include <wrap/io_trimesh/import_ply.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "vcg_core/mesh_io.h"
#include "vcg_core/reconstruct.h"

namespace {

class PlyVertex;
class PlyFace;
struct PlyTypes : vcg::UsedTypes<vcg::Use<PlyVertex>::AsVertexType, vcg::Use<PlyFace>::AsFaceType> {};
class PlyVertex : public vcg::Vertex<PlyTypes, vcg::vertex::Coord3f, vcg::vertex::Normal3f,
                                     vcg::vertex::Color4b, vcg::vertex::Qualityf, vcg::vertex::BitFlags> {};
class PlyFace : public vcg::Face<PlyTypes, vcg::face::VertexRef, vcg::face::Normal3f, vcg::face::BitFlags> {};
class PlyMesh : public vcg::tri::TriMesh<std::vector<PlyVertex>, std::vector<PlyFace>> {};

void set(neuralmesh::Settings& settings, const std::string& argument) {
    const auto equals = argument.find('=');
    for (const neuralmesh::SettingInfo& info : neuralmesh::setting_table()) {
        if (equals == std::string::npos || argument.substr(0, equals) != info.id) continue;
        info.store(settings, std::atof(argument.c_str() + equals + 1));
        return;
    }
    throw neuralmesh::SettingError("'" + argument + "' is not parameter=value with a known parameter.");
}

int learn(int argc, char** argv) {
    neuralmesh::Settings settings;
    for (int i = 3; i < argc; ++i) set(settings, argv[i]);
    PlyMesh in;
    if (vcg::tri::io::ImporterPLY<PlyMesh>::Open(in, argv[1]) != 0)
        throw neuralmesh::InputError(std::string("Cannot read ") + argv[1] + " as PLY.");
    vcg::Matrix44d identity;
    identity.SetIdentity();
    const auto target = neuralmesh::target_space_of(in, identity, settings);
    neuralmesh::NoProgress progress;
    const neuralmesh::NeuralMesh result = neuralmesh::reconstruct(target, settings, progress);
    PlyMesh out;
    neuralmesh::write_mesh(result, settings, out);
    using Mask = vcg::tri::io::Mask;
    vcg::tri::io::ExporterPLY<PlyMesh>::Save(out, argv[2], Mask::IOM_VERTQUALITY | Mask::IOM_VERTCOLOR, true);
    const neuralmesh::Report& r = result.report;
    for (const std::string& warning : r.warnings) std::fprintf(stderr, "%s\n", warning.c_str());
    std::printf(
        "{\"vertices\":%d,\"faces\":%d,\"signals\":%lld,\"splits\":%lld,\"collapses\":%lld,\"genus\":%d,"
        "\"boundary_loops\":%d,\"components\":%d,\"feature_vertices\":%d,\"rms_error\":%.6g,"
        "\"mean_counter\":%.6g,\"seconds\":%.4g,\"stop_reason\":%d}\n",
        r.vertices, r.faces, r.signals, r.splits, r.collapses, r.genus, r.boundary_loops, r.components,
        r.feature_vertices, r.rms_error, r.mean_counter, r.seconds, static_cast<int>(r.stop_reason));
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 3) {
        std::fprintf(stderr, "usage: %s IN.ply OUT.ply [parameter=value ...]\n", argv[0]);
        return 2;
    }
    return learn(argc, argv);
} catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
