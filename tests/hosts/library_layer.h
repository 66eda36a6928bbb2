// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Layers for library_host.cpp: reads the text that inputs.py writes, serialises a layer to compare it before
// and after a run, and writes the OFF file that check_mesh reads.
#pragma once

#include <common/ml_document/mesh_document.h>
#include <common/parameters/rich_parameter_list.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

/// A number as Python prints it, including inf and nan.
inline double number(std::istream& words) {
    std::string word;
    words >> word;
    return std::strtod(word.c_str(), nullptr);
}

inline void read_vertex(std::istream& words, CMeshO& mesh) {
    const double x = number(words), y = number(words), z = number(words);
    auto& v = *vcg::tri::Allocator<CMeshO>::AddVertices(mesh, 1);
    v.P() = Point3m(Scalarm(x), Scalarm(y), Scalarm(z));
    v.Q() = Scalarm(number(words));
    for (int k = 0; k < 4; ++k) v.C()[k] = static_cast<unsigned char>(number(words));
    if (number(words) != 0) {
        v.SetS();
        ++mesh.svn;
    }
    if (number(words) != 0) vcg::tri::Allocator<CMeshO>::DeleteVertex(mesh, v);
}

inline void read_face(std::istream& words, CMeshO& mesh) {
    std::size_t corners[3];
    for (std::size_t& corner : corners) corner = static_cast<std::size_t>(number(words));
    auto& f = *vcg::tri::Allocator<CMeshO>::AddFace(mesh, corners[0], corners[1], corners[2]);
    if (number(words) != 0) {
        f.SetS();
        ++mesh.sfn;
    }
    const int inner = static_cast<int>(number(words));
    for (int k = 0; k < 3; ++k)
        if ((inner & (1 << k)) != 0) f.SetF(k);
}

/// Adds texture coordinates and a user-defined attribute.
inline void read_textured(MeshModel& layer) {
    CMeshO& mesh = layer.cm;
    layer.updateDataMask(MeshModel::MM_WEDGTEXCOORD | MeshModel::MM_FACECOLOR);
    mesh.textures.push_back("none.png");
    auto heat = vcg::tri::Allocator<CMeshO>::AddPerVertexAttribute<Scalarm>(mesh, "heat");
    for (auto& v : mesh.vert) heat[v] = v.Q() / 2;
    for (auto& f : mesh.face)
        for (int k = 0; k < 3; ++k) f.WT(k).P() = Point2m(Scalarm(k == 1), Scalarm(k == 2));
}

/// The Python name of the filter that a layer file names; empty if it names none.
inline std::string filter_in(const char* file) {
    std::ifstream words(file);
    std::string word, name;
    while (words >> word)
        if (word == "filter") words >> name;
    return name;
}

/// Fills \p layer, and sets the parameters in \p list that the file names.
inline void read_layer(const char* file, MeshModel& layer, RichParameterList& list) {
    layer.updateDataMask(MeshModel::MM_VERTQUALITY | MeshModel::MM_VERTCOLOR | MeshModel::MM_POLYGONAL);
    std::ifstream words(file);
    std::string word;
    while (words >> word) {
        if (word == "vertex") {
            read_vertex(words, layer.cm);
        } else if (word == "face") {
            read_face(words, layer.cm);
        } else if (word == "textured") {
            read_textured(layer);
        } else if (word == "matrix") {
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column)
                    layer.cm.Tr.ElementAt(row, column) = Scalarm(number(words));
        } else if (word == "filter") {
            words >> word;
        } else if (word == "set") {
            words >> word;
            const int value = static_cast<int>(number(words));
            const QString id = QString::fromStdString(word);
            if (list.getParameterByName(id).value().isBool()) {
                list.setValue(id, BoolValue(value != 0));
            } else {
                list.setValue(id, IntValue(value));
            }
        }
    }
    layer.updateBoxAndNormals();
}

template <class Elements>
std::string raw_bytes(const Elements& elements) {
    return elements.empty() ? std::string()
                            : std::string(reinterpret_cast<const char*>(&elements[0]),
                                          elements.size() * sizeof(elements[0]));
}

/// The state of a layer: memory of all elements with flags, deleted ones too; attributes, matrix, box, name,
/// and number of layers in the document.
inline std::string bytes_of(const MeshDocument& document, MeshModel& layer) {
    CMeshO& mesh = layer.cm;
    std::ostringstream bytes;
    bytes << raw_bytes(mesh.vert) << raw_bytes(mesh.face) << mesh.vn << ' ' << mesh.fn << ' ' << mesh.svn
          << ' ' << mesh.sfn;
    bytes << std::string(reinterpret_cast<const char*>(&mesh.Tr), sizeof mesh.Tr)
          << std::string(reinterpret_cast<const char*>(&mesh.bbox), sizeof mesh.bbox);
    if (vcg::tri::HasPerVertexAttribute(mesh, "heat")) {
        auto heat = vcg::tri::Allocator<CMeshO>::FindPerVertexAttribute<Scalarm>(mesh, "heat");
        for (auto& v : mesh.vert) bytes << heat[v] << ' ';
        for (auto& f : mesh.face)
            for (int k = 0; k < 3; ++k) bytes << f.WT(k).P()[0] << f.WT(k).P()[1];
    }
    for (const std::string& texture : mesh.textures) bytes << texture;
    bytes << layer.label().toStdString() << layer.id() << layer.isVisible() << layer.dataMask()
          << mesh.vert_attr.size();
    bytes << " of " << document.meshNumber();
    return bytes.str();
}

/// Quality and selection of the vertices, which the counters change.
class VertexValues {
public:
    explicit VertexValues(CMeshO& mesh) : mesh_(mesh), selected_(mesh.svn) {
        for (const auto& v : mesh.vert) values_.emplace_back(v.cQ(), v.IsS());
    }
    void restore() const {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            mesh_.vert[i].Q() = values_[i].first;
            if (values_[i].second) {
                mesh_.vert[i].SetS();
            } else {
                mesh_.vert[i].ClearS();
            }
        }
        mesh_.svn = selected_;
    }

private:
    CMeshO& mesh_;
    int selected_;
    std::vector<std::pair<Scalarm, bool>> values_;
};

/// A line with quality and selection for every vertex that is not deleted.
inline void write_values(const CMeshO& mesh, std::ostream& out) {
    out.precision(9);
    for (const auto& v : mesh.vert)
        if (!v.IsD()) out << v.cQ() << ' ' << v.IsS() << '\n';
}

/// A JSON array, row by row.
inline std::string words_of(const Matrix44m& matrix) {
    std::ostringstream words;
    words.precision(17);
    for (int i = 0; i < 16; ++i) words << (i == 0 ? "[" : ", ") << matrix.ElementAt(i / 4, i % 4);
    return words.str() + "]";
}

inline void write_off(const CMeshO& mesh, std::ostream& out) {
    out.precision(17);
    out << "COFF\n" << mesh.vn << ' ' << mesh.fn << " 0\n";
    for (const auto& v : mesh.vert)
        out << v.cP()[0] << ' ' << v.cP()[1] << ' ' << v.cP()[2] << ' ' << int{v.cC()[0]} << ' '
            << int{v.cC()[1]} << ' ' << int{v.cC()[2]} << " 255\n";
    for (const auto& f : mesh.face) {
        out << 3;
        for (int k = 0; k < 3; ++k) out << ' ' << vcg::tri::Index(mesh, f.cV(k));
        out << '\n';
    }
}
