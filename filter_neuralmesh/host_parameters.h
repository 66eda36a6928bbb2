// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The table of settings as the host's dialog parameters, and back. Included by each adapter after the host's
// own headers: the class names are the same in all hosts, their layouts are not.
#pragma once

#include <QString>
#include <QStringList>

#include "actions.h"

namespace neuralmesh {

/// Adds the parameter \p info describes to \p list. \p extra: what the host's constructors take behind
/// the tooltip (from 2022.02 on: whether the parameter is an advanced one).
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
            // Hosts keep parameters as float, whatever their scalar is; from_host() takes that back.
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

/// The settings that \p list holds, unchecked.
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
