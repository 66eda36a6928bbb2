// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Shared by the experiments' programs: reading PLY files with vcglib, and parameters from the command line.
#pragma once

#include <vcg/complex/complex.h>
#include <wrap/io_trimesh/import_ply.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/mesh_io.h"
#include "vcg_core/settings.h"

namespace neuralmesh {

class PlyVertex;
class PlyFace;
class PlyEdge;
struct PlyTypes : vcg::UsedTypes<vcg::Use<PlyVertex>::AsVertexType, vcg::Use<PlyEdge>::AsEdgeType,
                                 vcg::Use<PlyFace>::AsFaceType> {};
/// The quality is double because vcglib's exporter declares it to be of the coordinates' type.
class PlyVertex : public vcg::Vertex<PlyTypes, vcg::vertex::Coord3d, vcg::vertex::Normal3d,
                                     vcg::vertex::Color4b, vcg::vertex::Qualityd, vcg::vertex::BitFlags> {};
class PlyFace : public vcg::Face<PlyTypes, vcg::face::VertexRef, vcg::face::Normal3d, vcg::face::BitFlags> {};
class PlyEdge : public vcg::Edge<PlyTypes, vcg::edge::VertexRef, vcg::edge::BitFlags> {};
class PlyMesh : public vcg::tri::TriMesh<std::vector<PlyVertex>, std::vector<PlyEdge>, std::vector<PlyFace>> {
};

/// Reads the PLY file \p path into the empty \p mesh. \return the attributes in it, as bits of
/// vcg::tri::io::Mask. \throws InputError if that fails
inline int read_ply(const std::string& path, PlyMesh& mesh) {
    int attributes = 0;
    if (vcg::tri::io::ImporterPLY<PlyMesh>::Open(mesh, path.c_str(), attributes) != 0)
        throw InputError("Cannot read " + path + " as PLY.");
    return attributes;
}

/// The target space of the PLY file \p path. \throws InputError as read_ply and target_space_of do
inline TargetSpace target_of_ply(const std::string& path, const Settings& settings) {
    PlyMesh mesh;
    const int attributes = read_ply(path, mesh);
    vcg::Matrix44d identity;
    identity.SetIdentity();
    return target_space_of(mesh, identity, settings, (attributes & vcg::tri::io::Mask::IOM_VERTCOLOR) != 0);
}

/// The mesh in the PLY file \p path. \throws InputError as read_ply and indexed_mesh_of do
inline IndexedMesh<double> mesh_of_ply(const std::string& path) {
    PlyMesh mesh;
    read_ply(path, mesh);
    vcg::Matrix44d identity;
    identity.SetIdentity();
    return indexed_mesh_of(mesh, identity);
}

/// Sets \p value to the number in \p text. For a boolean parameter, \p text may also be "true" or "false".
/// \return false if \p text is neither
inline bool read_value(const std::string& text, SettingInfo::Kind kind, double& value) {
    if (kind == SettingInfo::Kind::boolean && (text == "true" || text == "false")) {
        value = text == "true" ? 1 : 0;
        return true;
    }
    char* end = nullptr;
    value = std::strtod(text.c_str(), &end);
    return !text.empty() && *end == '\0';
}

/// Sets a parameter from \p word, which is "parameter=value" with an id of the settings table.
/// \throws SettingError if it is not
inline void set_parameter(Settings& settings, const std::string& word) {
    const auto equals = word.find('=');
    for (const SettingInfo& info : setting_table()) {
        if (equals == std::string::npos || word.substr(0, equals) != info.id) continue;
        double value = 0;
        if (!read_value(word.substr(equals + 1), info.kind, value))
            throw SettingError("'" + word + "' does not give " + info.id + " a number" +
                               (info.kind == SettingInfo::Kind::boolean ? ", true or false." : "."));
        info.store(settings, value);
        return;
    }
    throw SettingError("'" + word + "' is not parameter=value with a known parameter.");
}

}  // namespace neuralmesh
