// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The filter run by MeshLab 2022.02 or 2025.07 without its window: the plugin manager of libmeshlab-common
// checks and loads the plugin, and the filter learns a layer. Compiled per release, its symbols left to load
// time; run_library_host.cpp starts it with
//   LAYER OUT          the layer that inputs.py has written, the result to OUT
//   LAYER OUT cancel   the same again and again, the host asking to stop at ever later calls
//   LAYER OUT memory   the same again and again, out of memory at ever later allocations
//   LAYER OUT repeat   the same more than a hundred times, and at last how much the process has grown
//   LAYER OUT together two runs at once, and whether each gives what it gives alone
// and prints one JSON object for each run, or the host's refusal of the plugin.
#include <common/mlexception.h>
#include <common/plugins/interfaces/filter_plugin.h>
#include <common/plugins/plugin_manager.h>

#include <unistd.h>

#include <QApplication>
#include <iostream>
#include <thread>

#include "library_layer.h"
#include "tests/memory/allocations.h"

namespace {

namespace allocations = neuralmesh::allocations;
using allocations::Failure;

/// What the host answers to the filter's progress; a plain function has no other memory.
int calls_until_stop = 0;
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

class Host {
public:
    explicit Host(const char* plugin_file)
        : plugin_(dynamic_cast<FilterPlugin*>(manager_.loadPlugin(plugin_file))),
          action_(plugin_->actions().front()) {}

    /// Learns the layer once and tells what came of it. \p nth, \p failure: which allocation of the filter
    /// fails.
    void learn(const char* layer_file, const char* out, long long nth = -1, Failure failure = Failure::once) {
        MeshDocument document;
        document.addNewMesh("", "other", false);
        MeshModel& layer = *document.addNewMesh("", "layer", true);
        RichParameterList list = plugin_->initParameterList(action_, document);
        read_layer(layer_file, layer, list);
        plugin_->setLog(&document.Log);
        const std::string before = bytes_of(document, layer);

        std::map<std::string, QVariant> told;
        std::string sentence;
        unsigned int mask = 0;
        calls = 0;
        allocations::fail_at(nth, failure);
        try {
            told = plugin_->applyFilter(action_, list, document, mask, call_back);
        } catch (const std::exception& error) {
            allocations::fail_at(-1);
            sentence = error.what();
        }
        allocated = allocations::count();
        allocations::fail_at(-1);

        QStringList logged;
        document.Log.print(logged);
        const bool learned = sentence.empty();
        std::cout << "{\"sentence\": " << quoted(sentence)
                  << ", \"logged\": " << quoted(logged.join(' ').toStdString())
                  << ", \"layers\": " << document.meshNumber()
                  << ", \"current\": " << quoted(document.mm()->label().toStdString());
        for (const auto& [key, value] : told) std::cout << ", \"" << key << "\": " << value.toDouble();
        std::cout << ", \"asked_to_stop\": " << (calls >= calls_until_stop ? "true" : "false");
        if (learned) {
            std::cout << ", \"vn\": " << document.mm()->cm.vn
                      << ", \"matrix\": " << words_of(document.mm()->cm.Tr);
            std::ofstream file(out);
            write_off(document.mm()->cm, file);
            document.delMesh(document.mm()->id());
        }
        std::cout << ", \"unchanged\": " << (bytes_of(document, layer) == before ? "true" : "false") << "}"
                  << std::endl;
    }

    /// The result for the layer with \p seed, told nobody: all runs of a plugin share one log.
    std::string result_of(const char* layer_file, int seed) {
        MeshDocument document;
        MeshModel& layer = *document.addNewMesh("", "layer", true);
        RichParameterList list = plugin_->initParameterList(action_, document);
        read_layer(layer_file, layer, list);
        list.setValue("random_seed", IntValue(seed));
        unsigned int mask = 0;
        plugin_->applyFilter(action_, list, document, mask, nullptr);
        std::ostringstream text;
        write_off(document.mm()->cm, text);
        return text.str();
    }

    void keep_quiet() { plugin_->setLog(nullptr); }

    long long allocated = 0;  ///< by the filter in the last run

private:
    PluginManager manager_;
    FilterPlugin* plugin_;
    QAction* action_;
};

/// Pages of this process that lie in memory now, in bytes.
long long resident_bytes() {
    long long size = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> size >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

void repeat(Host& host, const char* layer, const char* out) {
    for (int i = 0; i < 20; ++i) host.learn(layer, out);
    const long long before = resident_bytes(), living = allocations::living();
    for (int i = 0; i < 100; ++i) host.learn(layer, out);
    const long long blocks = allocations::living() - living;
    std::cout << "{\"blocks\": " << blocks << ", \"bytes\": " << resident_bytes() - before << "}"
              << std::endl;
}

void learn_together(Host& host, const char* layer) {
    host.keep_quiet();
    const std::string alone[] = {host.result_of(layer, 1), host.result_of(layer, 2)};
    bool alike = true;
    for (int round = 0; round < 3; ++round) {
        std::string together[2];
        std::thread other([&] { together[0] = host.result_of(layer, 1); });
        together[1] = host.result_of(layer, 2);
        other.join();
        alike = alike && together[0] == alone[0] && together[1] == alone[1];
    }
    std::cout << "{\"different\": " << (alone[0] != alone[1] ? "true" : "false")
              << ", \"alike\": " << (alike ? "true" : "false") << "}" << std::endl;
}

void run(Host& host, const char* layer, const char* out, const std::string& mode) {
    calls_until_stop = 1 << 30;
    host.learn(layer, out);
    const int all_calls = calls;
    if (mode == "cancel") {
        for (calls_until_stop = 1; calls_until_stop <= all_calls; calls_until_stop += 1 + all_calls / 10)
            host.learn(layer, out);
    } else if (mode == "memory") {
        // Every allocation of the first and the last ones, where the adapter works, and some of the learning.
        const long long all = host.allocated;
        for (long long nth = 0; nth < all; nth += nth < 60 || nth > all - 150 ? 1 : (all - 210) / 20 + 1) {
            host.learn(layer, out, nth, Failure::once);
            host.learn(layer, out, nth, Failure::from_then_on);
        }
    } else if (mode == "repeat") {
        repeat(host, layer, out);
    } else if (mode == "together") {
        learn_together(host, layer);
    }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int library_host(int argc, char** argv) {
    QApplication application(argc, argv);
    try {
        Host host(argv[3]);
        run(host, argv[4], argv[5], argc > 6 ? argv[6] : "");
        return 0;
    } catch (const MLException& error) {
        std::cout << "refused: " << error.what() << std::endl;
        return 1;
    }
}
