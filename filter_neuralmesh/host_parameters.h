// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of settings as parameters of the host's dialog, and back. Each adapter includes this after the
// host's own headers, as host_layer.h.
#pragma once

#include <QString>
#include <QStringList>

#include <type_traits>

#include "actions.h"

namespace neuralmesh {

#if __has_include(<common/parameters/rich_parameter/rich_percentage.h>)
using RichLength = RichPercentage;
using Length = MESHLAB_SCALAR;
#else
using RichLength = RichAbsPerc;  // its name until 2022.02
using Length = float;
#endif

/// The diagonal of the current layer, of which lengths are shown as percentages; 1 if it has
/// none.
inline double diagonal_of_current_layer(const MeshDocument& document) {
    const MeshModel* const layer = document.mm();
    if (layer == nullptr) return 1;
    Box3m box;  // in world coordinates
    box.Add(layer->cm.Tr, layer->cm.bbox);
    const auto diagonal = static_cast<double>(box.Diag());
    return diagonal > 0 ? diagonal : 1;
}

/// The hosts know layers by numbers from 2022.02 on, before by pointers.
template <class Layer>
constexpr bool kLayersAreNumbers = std::is_constructible_v<Layer, QString, unsigned, const MeshDocument*>;

/// A parameter for a layer, by default the current one. \p texts: as those of other parameters.
template <class Document, class Layer = RichMesh, class... Texts>
RichMesh layer_parameter(const QString& id, Document& document, Texts... texts) {
    auto* const current = document.mm();
    if constexpr (kLayersAreNumbers<Layer>) {
        return Layer(id, current == nullptr ? 0U : static_cast<unsigned>(current->id()), &document, texts...);
    } else {
        return Layer(id, current, current == nullptr ? nullptr : &document, texts...);
    }
}

/// The number of the layer that the parameter \p id names, -1 if it does not exist.
template <class Document, class List, class Layer = RichMesh>
int chosen_layer(const List& list, const QString& id, const Document& document) {
    if constexpr (kLayersAreNumbers<Layer>) {
        return static_cast<int>(list.getMeshId(id));
    } else {
        const auto* const chosen = list.getMesh(id);
        for (const auto* layer : document.meshList)
            if (layer == chosen) return static_cast<int>(layer->id());
        return -1;
    }
}

/// Adds the parameter that \p info describes to \p list. \p extra: the arguments that the host's constructors
/// have after the tooltip (from 2022.02 on: whether the parameter is an advanced one). A length's default is
/// in percent of the diagonal of the current layer of \p document.
template <class Document, class... Extra>
void add_parameter(RichParameterList& list, const SettingInfo& info, Document& document, Extra... extra) {
    const double value = info.value(Settings());
    const QString id = QString::fromUtf8(info.id);
    const QString label = QString::fromUtf8(info.label);
    const QString help = QString::fromUtf8(info.help);
    switch (info.kind) {
        case SettingInfo::Kind::boolean:
            list.addParam(RichBool(id, value != 0, label, help, extra...));
            break;
        case SettingInfo::Kind::integer:
            list.addParam(RichInt(id, static_cast<int>(value), label, help, extra...));
            break;
        case SettingInfo::Kind::real:
            // All hosts keep parameters as float; from_host() undoes the rounding.
            list.addParam(RichFloat(id, static_cast<float>(value), label, help, extra...));
            break;
        case SettingInfo::Kind::length: {
            const double diagonal = diagonal_of_current_layer(document);
            list.addParam(RichLength(id, static_cast<Length>(value / 100 * diagonal), 0,
                                     static_cast<Length>(diagonal), label, help, extra...));
            break;
        }
        case SettingInfo::Kind::layer:
            list.addParam(layer_parameter(id, document, label, help, extra...));
            break;
        case SettingInfo::Kind::choice: {
            QStringList names;
            for (const std::string& name : info.choices) names << QString::fromStdString(name);
            list.addParam(RichEnum(id, static_cast<int>(value), names, label, help, extra...));
            break;
        }
    }
}

/// The settings in \p list, those of \p table, whose layers are in \p document. Their ranges are not checked.
inline Settings settings_from(const RichParameterList& list, const std::vector<SettingInfo>& table,
                              const MeshDocument& document) {
    Settings settings;
    for (const SettingInfo& info : table) {
        const QString id = QString::fromUtf8(info.id);
        switch (info.kind) {
            case SettingInfo::Kind::boolean: info.store(settings, list.getBool(id) ? 1 : 0); break;
            case SettingInfo::Kind::integer: info.store(settings, list.getInt(id)); break;
            case SettingInfo::Kind::choice: info.store(settings, list.getEnum(id)); break;
            case SettingInfo::Kind::layer: info.store(settings, chosen_layer(list, id, document)); break;
            case SettingInfo::Kind::real:
                info.store(settings, from_host(static_cast<double>(list.getFloat(id))));
                break;
            case SettingInfo::Kind::length: {
                const auto length = static_cast<double>(list.getAbsPerc(id));
                info.store(settings, length < 0 ? info.low : length);
                break;
            }
        }
    }
    return settings;
}

}  // namespace neuralmesh
