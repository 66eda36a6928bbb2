// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Forwards MeshLab 2020.09's calls to actions.h. This host checks nothing when it loads a plugin, and would
// run one built for another release or another scalar into its memory; so the plugin checks its host itself.

// Before any of Qt's headers, which make a keyword of "signals".
#include "actions.h"

#include "meshlab_2020.h"

#include <common/mlapplication.h>
#include <dlfcn.h>

#include <new>
#include <string>
#include <type_traits>

#include "host_layer.h"
#include "host_parameters.h"

namespace {

using namespace neuralmesh;

/// The running MeshLab's scalar type, told from a function that its library exports for that type alone.
std::string scalar_of_host() {
    if (dlsym(RTLD_DEFAULT, "_Z14Matrix44mToXMLRN3vcg8Matrix44IfEER12QDomDocument") != nullptr)
        return "float";
    if (dlsym(RTLD_DEFAULT, "_Z14Matrix44mToXMLRN3vcg8Matrix44IdEER12QDomDocument") != nullptr)
        return "double";
    return "unknown";
}

/// Empty if this plugin fits the running MeshLab, else the sentence that says why it does not.
std::string misfit() {
    const std::string built_for = NEURALMESH_HOST_VERSION;
    const std::string built_scalar = std::is_same<MESHLAB_SCALAR, float>::value ? "float" : "double";
    const std::string running = MeshLabApplication::appVer().toStdString();
    const std::string running_scalar = scalar_of_host();
    if (built_for == running && built_scalar == running_scalar) return {};
    return "This Neural Mesh plugin is built for MeshLab " + built_for + " (" + built_scalar +
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

MeshFilterInterface::FilterClass FilterNeuralMeshPlugin::getClass(QAction* /*action*/) { return Remeshing; }

MeshFilterInterface::FILTER_ARITY FilterNeuralMeshPlugin::filterArity(QAction* /*action*/) const {
    return SINGLE_MESH;
}

int FilterNeuralMeshPlugin::postCondition(QAction* /*action*/) const {
    return MeshModel::MM_VERTNUMBER | MeshModel::MM_FACENUMBER;
}

void FilterNeuralMeshPlugin::initParameterSet(QAction* /*action*/, MeshDocument& /*document*/,
                                              RichParameterList& list) {
    for (const SettingInfo& info : setting_table()) add_parameter(list, info);
}

bool FilterNeuralMeshPlugin::applyFilter(QAction* /*action*/, MeshDocument& document,
                                         const RichParameterList& list, vcg::CallBackPos* call_back) {
    try {
        const std::string refusal = misfit();
        if (!refusal.empty()) throw Error(refusal);
        learn_current_layer(document, list, call_back);
        return true;
    } catch (...) {
        const std::string sentence = sentence_of_current_exception();
        try {
            errorMessage = QString::fromStdString(sentence);
            // meshlabserver prints the log only.
            Log(GLLogStream::WARNING, sentence);
        } catch (const std::bad_alloc&) {
            // There is no memory for it; the host says at least that the filter has failed.
        }
        return false;
    }
}

void FilterNeuralMeshPlugin::learn_current_layer(MeshDocument& document, const RichParameterList& list,
                                                 vcg::CallBackPos* call_back) {
    MeshModel* const layer = document.mm();
    if (layer == nullptr) throw InputError(kNoLayer);
    const Settings settings = settings_from(list);
    // The window handles events during a run, so the layer need not be there after it.
    const auto current = layer->id();
    const Matrix44m transform = layer->cm.Tr;
    NeuralMesh result = run(layer->cm, transform, settings, call_back);

    MeshModel* const added = document.addNewMesh("", kLayerLabel, true);
    try {
        fill_layer(result, settings, transform, *added);
        added->UpdateBoxAndNormals();
    } catch (...) {
        document.delMesh(added);
        document.setCurrentMesh(current);
        throw;
    }
    log_run(result.report, [this](auto level, const std::string& line) { Log(level, line); });
}

MESHLAB_PLUGIN_NAME_EXPORTER(FilterNeuralMeshPlugin)
