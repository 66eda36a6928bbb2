// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// This host does not check the plugins it loads: one built for another release or scalar type would corrupt
// its memory. So the plugin checks its host before it runs.

// Before any header of Qt, which defines "signals" as a macro.
#include "actions.h"

#include "meshlab_2020.h"

#include <common/mlapplication.h>

#include <new>
#include <string>
#include <type_traits>

#include "host_layer.h"
#include "host_parameters.h"
#include "vcg_core/base/platform.h"

namespace {

using namespace neuralmesh;

const std::string kBuiltScalar = std::is_same<MESHLAB_SCALAR, float>::value ? "float" : "double";

/// The scalar type of the running MeshLab. Its library exports this function for that type only.
std::string scalar_of_host() {
    if (is_exported("_Z14Matrix44mToXMLRN3vcg8Matrix44IfEER12QDomDocument", kBuiltScalar == "float"))
        return "float";
    if (is_exported("_Z14Matrix44mToXMLRN3vcg8Matrix44IdEER12QDomDocument", kBuiltScalar == "double"))
        return "double";
    return "unknown";
}

/// Empty if this plugin fits the running MeshLab, else the sentence that says why it does not.
std::string misfit() {
    const std::string built_for = NEURALMESH_HOST_VERSION;
    const std::string running = MeshLabApplication::appVer().toStdString();
    const std::string running_scalar = scalar_of_host();
    if (built_for == running && kBuiltScalar == running_scalar) return {};
    return "This Neural Mesh plugin is built for MeshLab " + built_for + " (" + kBuiltScalar +
           "), but the running MeshLab is " + running + " (" + running_scalar +
           "). Replace the plugin by the one built for this MeshLab.";
}

}  // namespace

FilterNeuralMeshPlugin::FilterNeuralMeshPlugin() {
    for (const Action& action : all_actions()) {
        typeList << action.id;
        actionList << new QAction(QString::fromUtf8(action.name), this);
    }
}

QString FilterNeuralMeshPlugin::pluginName() const { return kPluginName; }

QString FilterNeuralMeshPlugin::filterName(FilterIDType id) const {
    return QString::fromUtf8(action_of(id).name);
}

QString FilterNeuralMeshPlugin::filterInfo(FilterIDType id) const {
    return QString::fromUtf8(action_of(id).info);
}

MeshFilterInterface::FilterClass FilterNeuralMeshPlugin::getClass(QAction* action) {
    return ID(action) == kCounters ? Quality : Remeshing;
}

MeshFilterInterface::FILTER_ARITY FilterNeuralMeshPlugin::filterArity(QAction* /*action*/) const {
    return SINGLE_MESH;
}

int FilterNeuralMeshPlugin::postCondition(QAction* action) const { return changes_of(ID(action)); }

void FilterNeuralMeshPlugin::initParameterSet(QAction* action, MeshDocument& document,
                                              RichParameterList& list) {
    for (const SettingInfo& info : action_of(ID(action)).settings) add_parameter(list, info, document);
}

bool FilterNeuralMeshPlugin::applyFilter(QAction* action, MeshDocument& document,
                                         const RichParameterList& list, vcg::CallBackPos* call_back) {
    try {
        const std::string refusal = misfit();
        if (!refusal.empty()) throw Error(refusal);
        const int id = ID(action);
        const Settings settings = settings_from(list, action_of(id).settings, document);
        const Report report = id == kCounters
                                  ? count_current_layer(document, settings, call_back, [](const Report&) {})
                                  : learn_current_layer(
                                        document, settings, call_back,
                                        [](MeshModel& added, const Report&) { added.UpdateBoxAndNormals(); },
                                        [&document](MeshModel& added) { document.delMesh(&added); });
        log_run(report, id, [this](auto level, const std::string& line) { Log(level, line); });
        return true;
    } catch (...) {
        const std::string sentence = sentence_of_current_exception();
        try {
            errorMessage = QString::fromStdString(sentence);
            // meshlabserver prints the log, not errorMessage.
            Log(GLLogStream::WARNING, sentence);
        } catch (const std::bad_alloc&) {
            // Without memory for the sentence, the host still reports that the filter has failed.
        }
        return false;
    }
}

MESHLAB_PLUGIN_NAME_EXPORTER(FilterNeuralMeshPlugin)

#include "moc_meshlab_2020.cpp"  // with this file, not by itself: it reads the same headers
