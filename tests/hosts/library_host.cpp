// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// MeshLab 2022.02 or 2025.07 without its window: the plugin manager of libmeshlab-common checks and loads the
// plugin, and the filter learns a ball. It is compiled once per release, with MeshLab's symbols left
// undefined until run_library_host.cpp loads it. Arguments:
//   PLUGIN OUT          learns it and writes the result to OUT
//   PLUGIN OUT cancel   repeats this; the host asks to stop at a later call of the progress each time
//   PLUGIN OUT memory   repeats this; a later allocation fails each time
// It prints one JSON object per run, or the host's refusal of the plugin.
#include <common/ml_document/mesh_document.h>
#include <common/mlexception.h>
#include <common/parameters/rich_parameter_list.h>
#include <common/plugins/interfaces/filter_plugin.h>
#include <common/plugins/plugin_manager.h>

#include <QApplication>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

#include "tests/memory/allocations.h"

namespace {

namespace allocations = neuralmesh::allocations;
using allocations::Failure;

/// A thousand points distributed evenly over a sphere.
void add_ball(CMeshO& mesh) {
    using Scalar = CMeshO::ScalarType;
    constexpr int kCount = 1000;
    for (int i = 0; i < kCount; ++i) {
        const double z = 1 - (2.0 * i + 1) / kCount, turn = 2.399963229728653 * i, rim = std::sqrt(1 - z * z);
        vcg::tri::Allocator<CMeshO>::AddVertex(
            mesh, {Scalar(rim * std::cos(turn)), Scalar(rim * std::sin(turn)), Scalar(z)});
    }
}

const char* truth(bool value) { return value ? "true" : "false"; }

/// State of call_back(), which as a plain function can only use globals.
int calls_until_stop = 1 << 30;
int calls = 0;
bool call_back(const int, const char*) { return ++calls < calls_until_stop; }

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result + '"';
}

/// The state of a layer: memory of all vertices, matrix, box, name, and number of layers.
std::string bytes_of(const MeshDocument& document, MeshModel& layer) {
    CMeshO& mesh = layer.cm;
    const auto raw = [](const void* data, std::size_t size) {
        return std::string(static_cast<const char*>(data), size);
    };
    std::ostringstream bytes;
    bytes << raw(&mesh.vert[0], mesh.vert.size() * sizeof(mesh.vert[0])) << raw(&mesh.Tr, sizeof mesh.Tr)
          << raw(&mesh.bbox, sizeof mesh.bbox) << mesh.vn << ' ' << mesh.fn << layer.label().toStdString()
          << layer.id() << layer.isVisible() << layer.dataMask() << " of " << document.meshNumber();
    return bytes.str();
}

void write_off(const CMeshO& mesh, std::ostream& out) {
    out.precision(17);
    out << "OFF\n" << mesh.vn << ' ' << mesh.fn << " 0\n";
    for (const auto& v : mesh.vert) out << v.cP()[0] << ' ' << v.cP()[1] << ' ' << v.cP()[2] << '\n';
    for (const auto& f : mesh.face) {
        out << 3;
        for (int k = 0; k < 3; ++k) out << ' ' << vcg::tri::Index(mesh, f.cV(k));
        out << '\n';
    }
}

class Host {
public:
    Host(const char* plugin_file, const char* out, bool quick)
        : plugin_(dynamic_cast<FilterPlugin*>(manager_.loadPlugin(plugin_file))), out_(out), quick_(quick) {
        for (QAction* action : plugin_->actions())
            if (plugin_->pythonFilterName(plugin_->ID(action)) ==
                "generate_surface_reconstruction_neural_mesh")
                action_ = action;
    }

    /// Learns the ball once and prints the outcome. The filter's \p nth allocation fails, counted from 0;
    /// none if -1.
    void learn(long long nth = -1, Failure failure = Failure::once) {
        MeshDocument document;
        MeshModel& layer = *document.addNewMesh("", "layer", true);
        add_ball(layer.cm);
        layer.updateBoxAndNormals();
        RichParameterList list = plugin_->initParameterList(action_, document);
        list.setValue("target_vertices", IntValue(100));
        list.setValue("settling_signals_per_vertex", IntValue(quick_ ? 0 : 10));
        if (quick_) {
            list.setValue("start_mesh", IntValue(1));
            list.setValue("fit_to_points", BoolValue(false));
            list.setValue("select_features", BoolValue(true));
        }
        plugin_->setLog(&document.Log);
        const std::string before = bytes_of(document, layer);

        std::map<std::string, QVariant> results;
        std::string sentence;
        unsigned int mask = 0;
        calls = 0;
        allocations::fail_at(nth, failure);
        try {
            results = plugin_->applyFilter(action_, list, document, mask, call_back);
        } catch (const std::exception& error) {
            allocations::fail_at(-1);
            sentence = error.what();
        }
        allocated = allocations::count();
        allocations::fail_at(-1);
        print(document, results, sentence);
        if (sentence.empty()) {
            std::ofstream file(out_);
            write_off(document.mm()->cm, file);
            document.delMesh(2);
        }
        std::cout << ", \"unchanged\": " << truth(bytes_of(document, layer) == before) << "}" << std::endl;
    }

    long long allocated = 0;  ///< by the filter in the last run

private:
    /// All but the end of the JSON object of a run.
    static void print(MeshDocument& document, const std::map<std::string, QVariant>& results,
                      const std::string& sentence) {
        QStringList logged;
        document.Log.print(logged);
        std::cout << "{\"sentence\": " << quoted(sentence)
                  << ", \"logged\": " << quoted(logged.join(' ').toStdString())
                  << ", \"layers\": " << document.meshNumber()
                  << ", \"current\": " << quoted(document.mm()->label().toStdString())
                  << ", \"vn\": " << document.mm()->cm.vn;
        for (const auto& [key, value] : results) std::cout << ", \"" << key << "\": " << value.toDouble();
        std::cout << ", \"asked_to_stop\": " << truth(calls >= calls_until_stop);
    }

    PluginManager manager_;
    FilterPlugin* plugin_;
    QAction* action_ = nullptr;
    const char* out_;
    bool quick_;
};

/// For every allocation near both ends of a run, which are the adapter's, and for a sample of those during
/// learning.
void starve(Host& host) {
    const long long all = host.allocated;
    for (long long nth = 0; nth < all; nth += nth < 60 || nth > all - 150 ? 1 : (all - 210) / 20 + 1) {
        host.learn(nth, Failure::once);
        host.learn(nth, Failure::from_then_on);
    }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int library_host(int argc, char** argv) {
    QApplication application(argc, argv);
    const std::string mode = argc > 5 ? argv[5] : "";
    try {
        Host host(argv[3], argv[4], mode == "memory");
        host.learn();
        if (mode == "memory") starve(host);
        const int all_calls = calls;
        if (mode == "cancel")
            for (calls_until_stop = 1; calls_until_stop <= all_calls; calls_until_stop += 1 + all_calls / 10)
                host.learn();
        return 0;
    } catch (const MLException& error) {
        std::cout << "refused: " << error.what() << std::endl;
        return 1;
    }
}
