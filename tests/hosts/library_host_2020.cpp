// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// MeshLab 2020.09 without its window: the plugin learns a ball many times, and a later allocation fails each
// time. Qt's own allocations never fail, because they do not go through the replaced functions.
// run_library_host.cpp starts it; OUT is ignored. It prints one JSON object per run.
#include <common/interfaces.h>

#include <QApplication>
#include <QPluginLoader>
#include <iostream>

#include "ball_runs.h"

namespace {

namespace allocations = neuralmesh::allocations;
using ball_runs::Failure;
using ball_runs::truth;

class Host {
public:
    explicit Host(MeshFilterInterface& filter) : filter_(filter), action_(filter.actions().front()) {}

    /// Learns the ball once and prints the outcome. The filter's \p nth allocation fails, counted from 0;
    /// none if -1.
    void learn(long long nth, Failure failure) {
        MeshDocument document;
        ball_runs::add_ball(document.addNewMesh("", "layer", true)->cm);
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
    ball_runs::starve(host.allocated, [&](long long nth, Failure failure) { host.learn(nth, failure); });
    return 0;
}
