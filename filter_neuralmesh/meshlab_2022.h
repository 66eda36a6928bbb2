// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The adapter for MeshLab 2022.02 to 2025.07 and pymeshlab, whose filters are FilterPlugins.
#pragma once

#include <common/plugins/interfaces/filter_plugin.h>

class FilterNeuralMeshPlugin : public QObject, public FilterPlugin {
    Q_OBJECT
    MESHLAB_PLUGIN_IID_EXPORTER(FILTER_PLUGIN_IID)
    Q_INTERFACES(FilterPlugin)

public:
    FilterNeuralMeshPlugin();

    QString pluginName() const override;
    QString vendor() const override;
    QString filterName(ActionIDType id) const override;
    QString pythonFilterName(ActionIDType id) const override;
    QString filterInfo(ActionIDType id) const override;
    using FilterPlugin::filterInfo;
    using FilterPlugin::filterName;
    using FilterPlugin::pythonFilterName;

    FilterClass getClass(const QAction* action) const override;
    FilterArity filterArity(const QAction* action) const override;
    int postCondition(const QAction* action) const override;

    using FilterPlugin::initParameterList;
    RichParameterList initParameterList(const QAction* action, const MeshDocument& document) override;
    std::map<std::string, QVariant> applyFilter(const QAction* action, const RichParameterList& list,
                                                MeshDocument& document, unsigned int& post_condition_mask,
                                                vcg::CallBackPos* call_back) override;
};
