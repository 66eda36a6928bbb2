// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// MeshLab 2020.09 without its window: the plugin learns a ball many times, and a later allocation fails each
// time. Qt's own allocations never fail, because they do not go through the replaced functions.
// run_library_host.cpp starts it; LAYER and OUT are ignored. It prints one JSON object per run.
#include <common/interfaces.h>

#include <QApplication>
#include <QPluginLoader>
#include <cmath>
#include <iostream>

#include "tests/memory/allocations.h"

namespace {

namespace allocations = neuralmesh::allocations;
using allocations::Failure;

void add_ball(CMeshO& mesh) {
    constexpr int kCount = 1000;
    for (int i = 0; i < kCount; ++i) {
        const double z = 1 - (2.0 * i + 1) / kCount, turn = 2.399963229728653 * i, rim = std::sqrt(1 - z * z);
        vcg::tri::Allocator<CMeshO>::AddVertex(
            mesh, Point3m(Scalarm(rim * std::cos(turn)), Scalarm(rim * std::sin(turn)), Scalarm(z)));
    }
}

class Host {
public:
    explicit Host(MeshFilterInterface& filter) : filter_(filter), action_(filter.actions().front()) {}

    /// Learns the ball once and prints the outcome. The filter's \p nth allocation fails, counted from 0;
    /// none if -1.
    void learn(long long nth, Failure failure) {
        MeshDocument document;
        add_ball(document.addNewMesh("", "layer", true)->cm);
        RichParameterList list;
        filter_.initParameterSet(action_, document, list);
        list.setValue("target_vertices", IntValue(100));
        list.setValue("settling_signals_per_vertex", IntValue(0));
        list.setValue("start_mesh", EnumValue(1));
        filter_.setLog(&document.Log);

        bool escaped = false;
        bool learned = false;
        allocations::fail_at(nth, failure);
        try {
            learned = filter_.applyFilter(action_, document, list, nullptr);
        } catch (...) {
            escaped = true;
        }
        allocated = allocations::count();
        allocations::fail_at(-1);

        QStringList logged;
        document.Log.print(logged);
        const auto truth = [](bool value) { return value ? "true" : "false"; };
        std::cout << "{\"learned\": " << truth(learned) << ", \"escaped\": " << truth(escaped)
                  << ", \"reported\": " << truth(logged.join(' ').contains("signals="))
                  << ", \"layers\": " << document.size() << ", \"current\": \""
                  << document.mm()->label().toStdString() << "\", \"vn\": " << document.mm()->cm.vn << "}"
                  << std::endl;
    }

    long long allocated = 0;  ///< by the filter in the last run

private:
    MeshFilterInterface& filter_;
    QAction* action_;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) int library_host(int argc, char** argv) {
    QApplication application(argc, argv);
    QPluginLoader loader(argv[3]);
    auto* filter = qobject_cast<MeshFilterInterface*>(loader.instance());
    if (filter == nullptr) {
        std::cerr << loader.errorString().toStdString() << std::endl;
        return 1;
    }
    Host host(*filter);
    host.learn(-1, Failure::once);
    // Every allocation near both ends, which are the adapter's, and a sample of those during learning.
    const long long all = host.allocated;
    for (long long nth = 0; nth < all; nth += nth < 60 || nth > all - 150 ? 1 : (all - 210) / 20 + 1) {
        host.learn(nth, Failure::once);
        host.learn(nth, Failure::from_then_on);
    }
    return 0;
}
