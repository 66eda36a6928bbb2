// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Forwards the calls of MeshLab 2022.02 to 2025.07 and of pymeshlab to actions.h. These hosts compare the
// plugin's release and scalar type with their own before they use it.

// Before any of Qt's headers, which make a keyword of "signals".
#include "actions.h"

#include "meshlab_2022.h"

#include <common/mlexception.h>

#include <new>

#include "host_layer.h"
#include "host_parameters.h"

using namespace neuralmesh;

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

FilterPlugin::FilterClass FilterNeuralMeshPlugin::getClass(const QAction* /*action*/) const {
    return Remeshing;
}

FilterPlugin::FilterArity FilterNeuralMeshPlugin::filterArity(const QAction* /*action*/) const {
    return SINGLE_MESH;
}

int FilterNeuralMeshPlugin::postCondition(const QAction* /*action*/) const {
    return MeshModel::MM_VERTNUMBER | MeshModel::MM_FACENUMBER;
}

RichParameterList FilterNeuralMeshPlugin::initParameterList(const QAction* /*action*/,
                                                            const MeshDocument& /*document*/) {
    RichParameterList list;
    for (const SettingInfo& info : setting_table()) add_parameter(list, info, info.advanced);
    return list;
}

std::map<std::string, QVariant> FilterNeuralMeshPlugin::applyFilter(const QAction* /*action*/,
                                                                    const RichParameterList& list,
                                                                    MeshDocument& document,
                                                                    unsigned int& /*post_condition_mask*/,
                                                                    vcg::CallBackPos* call_back) {
    std::string sentence;
    try {
        return learn_current_layer(document, list, call_back);
    } catch (...) {
        sentence = sentence_of_current_exception();
    }
    try {
        log(GLLogStream::WARNING, sentence);
    } catch (const std::bad_alloc&) {
        // The log has no memory for it; the exception tells the same.
    }
    throw MLException(QString::fromStdString(sentence));
}

std::map<std::string, QVariant> FilterNeuralMeshPlugin::learn_current_layer(
    MeshDocument& document, const RichParameterList& list, vcg::CallBackPos* call_back) const {
    MeshModel* const layer = document.mm();
    if (layer == nullptr) throw InputError(kNoLayer);
    const Settings settings = settings_from(list);
    // The window handles events during a run, so the layer need not be there after it.
    const auto current = layer->id();
    const Matrix44m transform = layer->cm.Tr;
    NeuralMesh result = run(layer->cm, transform, settings, call_back);

    std::map<std::string, QVariant> results;
    MeshModel* const added = document.addNewMesh("", kLayerLabel, true);
    try {
        fill_layer(result, settings, transform, *added);
        added->updateBoxAndNormals();
        for (const Figure& figure : figures(result.report))
            results[figure.key] = figure.is_count ? QVariant(figure.count()) : QVariant(figure.value);
    } catch (...) {
        document.delMesh(added->id());
        document.setCurrentMesh(static_cast<int>(current));
        throw;
    }
    log_run(result.report, [this](auto level, const std::string& line) { log(level, line); });
    return results;
}

MESHLAB_PLUGIN_NAME_EXPORTER(FilterNeuralMeshPlugin)
