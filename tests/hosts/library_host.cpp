// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// MeshLab 2022.02 or 2025.07 without its window: the plugin manager of libmeshlab-common checks and loads the
// plugin, and the filter learns a layer, or the filter that the layer's file names. It is compiled once per
// release, with MeshLab's symbols left undefined until run_library_host.cpp loads it. Arguments:
//   LAYER OUT          learns the layer that inputs.py has written and writes the result to OUT
//   LAYER OUT cancel   repeats this; the host asks to stop at a later call of the progress each time
//   LAYER OUT memory   repeats this; a later allocation fails each time
//   LAYER OUT repeat   repeats this more than a hundred times and prints by how much the process has grown
//   LAYER OUT together compares two runs at the same time with each alone
// It prints one JSON object per run, or the host's refusal of the plugin.
#include <common/mlexception.h>
#include <common/plugins/interfaces/filter_plugin.h>
#include <common/plugins/plugin_manager.h>

#include <QApplication>
#include <iostream>
#include <thread>

#include "library_layer.h"
#include "tests/memory/allocations.h"

namespace {

namespace allocations = neuralmesh::allocations;
using allocations::Failure;

/// State of call_back(), which as a plain function can only use globals.
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

const char* truth(bool value) { return value ? "true" : "false"; }

class Host {
public:
    Host(const char* plugin_file, const char* layer_file)
        : plugin_(dynamic_cast<FilterPlugin*>(manager_.loadPlugin(plugin_file))),
          action_(plugin_->actions().front()),
          filter_(filter_in(layer_file)) {
        for (QAction* action : plugin_->actions())
            if (plugin_->pythonFilterName(plugin_->ID(action)).toStdString() == filter_) action_ = action;
    }

    /// Learns the layer once and prints the outcome. The filter's \p nth allocation fails, counted from 0;
    /// none if -1.
    void learn(const char* layer_file, const char* out, long long nth = -1, Failure failure = Failure::once) {
        MeshDocument document;
        document.addNewMesh("", "other", false);
        MeshModel& layer = *document.addNewMesh("", "layer", true);
        RichParameterList list = plugin_->initParameterList(action_, document);
        read_layer(layer_file, layer, list);
        plugin_->setLog(&document.Log);
        const std::string before = bytes_of(document, layer);
        const VertexValues values(layer.cm);

        Outcome outcome;
        unsigned int mask = 0;
        calls = 0;
        allocations::fail_at(nth, failure);
        try {
            outcome.results = plugin_->applyFilter(action_, list, document, mask, call_back);
        } catch (const std::exception& error) {
            allocations::fail_at(-1);
            outcome.sentence = error.what();
        }
        allocated = allocations::count();
        allocations::fail_at(-1);

        print(document, outcome);
        if (outcome.sentence.empty()) {
            std::ofstream file(out);
            if (document.mm() == &layer) {
                write_values(layer.cm, file);
                values.restore();
            } else {
                write_off(document.mm()->cm, file);
                for (unsigned added = 2; document.meshNumber() > 2; ++added) document.delMesh(added);
            }
        }
        std::cout << ", \"unchanged\": " << truth(bytes_of(document, layer) == before) << "}" << std::endl;
    }

    /// The result for the layer with \p seed. Call disable_log() before runs at the same time: they share it.
    std::string result_of(const char* layer_file, int seed) {
        MeshDocument document;
        MeshModel& layer = *document.addNewMesh("", "layer", true);
        RichParameterList list = plugin_->initParameterList(action_, document);
        read_layer(layer_file, layer, list);
        list.setValue("random_seed", IntValue(seed));
        unsigned int mask = 0;
        plugin_->applyFilter(action_, list, document, mask, nullptr);
        std::ostringstream text;
        if (document.mm() == &layer) {
            write_values(layer.cm, text);
        } else {
            write_off(document.mm()->cm, text);
        }
        return text.str();
    }

    void disable_log() { plugin_->setLog(nullptr); }

    long long allocated = 0;  ///< by the filter in the last run

private:
    /// What the filter returned, or the sentence of its exception.
    struct Outcome {
        std::map<std::string, QVariant> results;
        std::string sentence;
    };

    /// All but the end of the JSON object of a run.
    static void print(MeshDocument& document, const Outcome& outcome) {
        QStringList logged;
        document.Log.print(logged);
        std::cout << "{\"sentence\": " << quoted(outcome.sentence)
                  << ", \"logged\": " << quoted(logged.join(' ').toStdString())
                  << ", \"layers\": " << document.meshNumber()
                  << ", \"current\": " << quoted(document.mm()->label().toStdString());
        for (const auto& [key, value] : outcome.results)
            std::cout << ", \"" << key << "\": " << value.toDouble();
        std::cout << ", \"asked_to_stop\": " << truth(calls >= calls_until_stop);
        if (outcome.sentence.empty())
            std::cout << ", \"vn\": " << document.mm()->cm.vn
                      << ", \"matrix\": " << words_of(document.mm()->cm.Tr);
        for (const MeshModel& layer : document.meshIterator())
            if (layer.cm.en > 0)
                std::cout << ", \"creases\": {\"label\": " << quoted(layer.label().toStdString())
                          << ", \"vertices\": " << layer.cm.vn << ", \"edges\": " << layer.cm.en
                          << ", \"matrix\": " << words_of(layer.cm.Tr) << "}";
    }

    PluginManager manager_;
    FilterPlugin* plugin_;
    QAction* action_;
    std::string filter_;
};

void repeat(Host& host, const char* layer, const char* out) {
    for (int i = 0; i < 20; ++i) host.learn(layer, out);
    const long long before = allocations::resident_bytes(), living = allocations::living();
    for (int i = 0; i < 100; ++i) host.learn(layer, out);
    const long long blocks = allocations::living() - living;
    std::cout << "{\"blocks\": " << blocks << ", \"bytes\": " << allocations::resident_bytes() - before << "}"
              << std::endl;
}

void learn_together(Host& host, const char* layer) {
    host.disable_log();
    const std::string alone[] = {host.result_of(layer, 1), host.result_of(layer, 2)};
    bool alike = true;
    for (int round = 0; round < 3; ++round) {
        std::string together[2];
        std::thread other([&] { together[0] = host.result_of(layer, 1); });
        together[1] = host.result_of(layer, 2);
        other.join();
        alike = alike && together[0] == alone[0] && together[1] == alone[1];
    }
    std::cout << "{\"different\": " << truth(alone[0] != alone[1]) << ", \"alike\": " << truth(alike) << "}"
              << std::endl;
}

void run(Host& host, const char* layer, const char* out, const std::string& mode) {
    calls_until_stop = 1 << 30;
    host.learn(layer, out);
    const int all_calls = calls;
    if (mode == "cancel") {
        for (calls_until_stop = 1; calls_until_stop <= all_calls; calls_until_stop += 1 + all_calls / 10)
            host.learn(layer, out);
    } else if (mode == "memory") {
        // Every allocation near both ends, which are the adapter's, and a sample of those during learning.
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
        Host host(argv[3], argv[4]);
        run(host, argv[4], argv[5], argc > 6 ? argv[6] : "");
        return 0;
    } catch (const MLException& error) {
        std::cout << "refused: " << error.what() << std::endl;
        return 1;
    }
}
