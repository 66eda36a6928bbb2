// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of settings as parameters of the host's dialog, and back. Each adapter includes this after the
// host's own headers, as host_layer.h.
#pragma once

#include <QString>
#include <QStringList>

#include "actions.h"

namespace neuralmesh {

/// Adds the parameter that \p info describes to \p list. \p extra: the arguments that the host's constructors
/// have after the tooltip (from 2022.02 on: whether the parameter is an advanced one).
template <class... Extra>
void add_parameter(RichParameterList& list, const SettingInfo& info, Extra... extra) {
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
        }
    }
    return settings;
}

}  // namespace neuralmesh
