// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// These hosts compare the plugin's release and scalar type with their own before they use it, so the adapter
// need not.

// Before any header of Qt, which defines "signals" as a macro.
#include "actions.h"

#include "meshlab_2022.h"

#include <common/mlexception.h>

#include <new>

#include "host_layer.h"
#include "host_parameters.h"

using namespace neuralmesh;

namespace {

/// See neural_mesh_messages().
thread_local std::string messages;

/// Lack of memory for \p make() is no failure: the result, or the exception, exists.
template <class Make>
void keep_messages(const Make& make) {
    try {
        messages = make();
    } catch (const std::bad_alloc&) {
        messages.clear();
    }
}

}  // namespace

/// What the last run in this thread told: the lines of messages_of(), or one of message_of_error(). For the
/// Python package, because pymeshlab prints the log, or loses it. Valid until the next run in this thread.
extern "C" Q_DECL_EXPORT const char* neural_mesh_messages() { return messages.c_str(); }

FilterNeuralMeshPlugin::FilterNeuralMeshPlugin() {
    for (const Action& action : all_actions()) {
        typeList.push_back(action.id);
        actionList.push_back(new QAction(QString::fromUtf8(action.name), this));
    }
}

QString FilterNeuralMeshPlugin::pluginName() const { return kPluginName; }

QString FilterNeuralMeshPlugin::vendor() const { return kVendor; }

QString FilterNeuralMeshPlugin::filterName(ActionIDType id) const {
    return QString::fromUtf8(action_of(id).name);
}

QString FilterNeuralMeshPlugin::pythonFilterName(ActionIDType id) const {
    return QString::fromUtf8(action_of(id).python_name);
}

QString FilterNeuralMeshPlugin::filterInfo(ActionIDType id) const {
    return QString::fromUtf8(action_of(id).info);
}

FilterPlugin::FilterClass FilterNeuralMeshPlugin::getClass(const QAction* action) const {
    return ID(action) == kCounters ? Quality : Remeshing;
}

FilterPlugin::FilterArity FilterNeuralMeshPlugin::filterArity(const QAction* /*action*/) const {
    return SINGLE_MESH;
}

int FilterNeuralMeshPlugin::postCondition(const QAction* action) const { return changes_of(ID(action)); }

RichParameterList FilterNeuralMeshPlugin::initParameterList(const QAction* action,
                                                            const MeshDocument& document) {
    RichParameterList list;
    for (const SettingInfo& info : action_of(ID(action)).settings)
        add_parameter(list, info, document, info.advanced);
    return list;
}

std::map<std::string, QVariant> FilterNeuralMeshPlugin::applyFilter(const QAction* action,
                                                                    const RichParameterList& list,
                                                                    MeshDocument& document,
                                                                    unsigned int& /*post_condition_mask*/,
                                                                    vcg::CallBackPos* call_back) {
    std::string sentence;
    messages.clear();
    try {
        const int id = ID(action);
        const Settings settings = settings_from(list, action_of(id).settings, document);
        std::map<std::string, QVariant> results;
        const auto report_to_host = [&results, id](const Report& report) {
            for (const Figure& figure : figures(report, id))
                results[figure.key] = figure.is_count ? QVariant(figure.count()) : QVariant(figure.value);
        };
        const auto complete = [&report_to_host](MeshModel& added, const Report& report) {
            added.updateBoxAndNormals();
            report_to_host(report);
        };
        const auto remove = [&document](MeshModel& added) { document.delMesh(added.id()); };
        const Report report = id == kCounters
                                  ? count_current_layer(document, settings, call_back, report_to_host)
                                  : learn_current_layer(document, settings, call_back, complete, remove);
        log_run(report, id, [this](auto level, const std::string& line) { log(level, line); });
        keep_messages([&report, id] { return messages_of(report, id); });
        return results;
    } catch (...) {
        sentence = sentence_of_current_exception();
    }
    try {
        log(GLLogStream::WARNING, sentence);
    } catch (const std::bad_alloc&) {
        // The exception holds the same sentence.
    }
    keep_messages([&sentence] { return message_of_error(sentence); });
    throw MLException(QString::fromStdString(sentence));
}

MESHLAB_PLUGIN_NAME_EXPORTER(FilterNeuralMeshPlugin)

#include "moc_meshlab_2022.cpp"  // with this file, not by itself: it reads the same headers
