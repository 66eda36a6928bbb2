// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The adapter for MeshLab 2020.09, whose filters are MeshFilterInterfaces.
#pragma once

#include <common/interfaces.h>

class FilterNeuralMeshPlugin : public QObject, public MeshFilterInterface {
    Q_OBJECT
    MESHLAB_PLUGIN_IID_EXPORTER(MESH_FILTER_INTERFACE_IID)
    Q_INTERFACES(MeshFilterInterface)

public:
    FilterNeuralMeshPlugin();

    QString pluginName() const override;
    QString filterName(FilterIDType id) const override;
    QString filterInfo(FilterIDType id) const override;
    using MeshFilterInterface::filterInfo;
    using MeshFilterInterface::filterName;

    FilterClass getClass(QAction* action) override;
    FILTER_ARITY filterArity(QAction* action) const override;
    int postCondition(QAction* action) const override;

    using MeshFilterInterface::initParameterSet;
    void initParameterSet(QAction* action, MeshDocument& document, RichParameterList& list) override;
    bool applyFilter(QAction* action, MeshDocument& document, const RichParameterList& list,
                     vcg::CallBackPos* call_back) override;
};
