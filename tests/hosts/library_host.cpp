// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The filter run by MeshLab 2022.02 or 2025.07 without its window: the plugin manager of libmeshlab-common
// checks and loads the plugin, and the filter learns a sphere. Compiled per release, its symbols left to load
// time; run_library_host.cpp starts it. Prints one JSON object, or the host's sentence.
#include <common/mlexception.h>
#include <common/plugins/interfaces/filter_plugin.h>
#include <common/plugins/plugin_manager.h>
#include <vcg/complex/algorithms/clean.h>

#include <QApplication>
#include <cmath>
#include <iostream>

namespace {

/// Points spread evenly over a sphere of radius 2 around (10, 0, 0).
void add_sphere(CMeshO& mesh, int count) {
    auto v = vcg::tri::Allocator<CMeshO>::AddVertices(mesh, static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i, ++v) {
        const double z = 1 - (2 * i + 1.0) / count;
        const double r = std::sqrt(1 - z * z);
        const double turn = 2.399963229728653 * i;
        v->P() =
            Point3m(Scalarm(10 + 2 * r * std::cos(turn)), Scalarm(2 * r * std::sin(turn)), Scalarm(2 * z));
    }
}

void run(const char* plugin_file) {
    PluginManager manager;
    auto* plugin = dynamic_cast<FilterPlugin*>(manager.loadPlugin(plugin_file));
    QAction* action = plugin->actions().front();
    MeshDocument document;
    MeshModel* cloud = document.addNewMesh("", "cloud", true);
    add_sphere(cloud->cm, 5000);
    RichParameterList list = plugin->initParameterList(action, document);
    list.setValue("target_vertices", IntValue(500));
    unsigned int mask = 0;
    const auto results = plugin->applyFilter(action, list, document, mask, nullptr);

    MeshModel& learned = *document.mm();
    std::cout << "{\"label\": \"" << learned.label().toStdString()
              << "\", \"layers\": " << document.meshNumber() << ", \"cloud_points\": " << cloud->cm.vn
              << ", \"vn\": " << learned.cm.vn << ", \"watertight\": "
              << (vcg::tri::Clean<CMeshO>::IsWaterTight(learned.cm) ? "true" : "false");
    for (const auto& [key, value] : results) std::cout << ", \"" << key << "\": " << value.toDouble();
    std::cout << "}" << std::endl;

    list.setValue("target_vertices", IntValue(2));
    try {
        plugin->applyFilter(action, list, document, mask, nullptr);
    } catch (const MLException& error) {
        std::cout << error.what() << std::endl;
    }
    std::cout << document.meshNumber() << std::endl;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int library_host(int argc, char** argv) {
    QApplication application(argc, argv);
    try {
        run(argv[argc - 1]);
        return 0;
    } catch (const MLException& error) {
        std::cout << "refused: " << error.what() << std::endl;
        return 1;
    }
}
