// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of settings as parameters of the host's dialog, and back. Each adapter includes this after the
// host's own headers, as host_layer.h.
#pragma once

#include <QString>
#include <QStringList>

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

/// Adds the parameter that \p info describes to \p list. \p extra: the arguments that the host's constructors
/// have after the tooltip (from 2022.02 on: whether the parameter is an advanced one). A length's default is
/// in percent of \p diagonal.
template <class... Extra>
void add_parameter(RichParameterList& list, const SettingInfo& info, double diagonal, Extra... extra) {
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
        case SettingInfo::Kind::length:
            list.addParam(RichLength(id, static_cast<Length>(value / 100 * diagonal), 0,
                                     static_cast<Length>(diagonal), label, help, extra...));
            break;
        case SettingInfo::Kind::choice: {
            QStringList names;
            for (const std::string& name : info.choices) names << QString::fromStdString(name);
            list.addParam(RichEnum(id, static_cast<int>(value), names, label, help, extra...));
            break;
        }
    }
}

/// The settings in \p list. Their ranges are not checked.
inline Settings settings_from(const RichParameterList& list) {
    Settings settings;
    for (const SettingInfo& info : setting_table()) {
        const QString id = QString::fromUtf8(info.id);
        switch (info.kind) {
            case SettingInfo::Kind::boolean: info.store(settings, list.getBool(id) ? 1 : 0); break;
            case SettingInfo::Kind::integer: info.store(settings, list.getInt(id)); break;
            case SettingInfo::Kind::choice: info.store(settings, list.getEnum(id)); break;
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
