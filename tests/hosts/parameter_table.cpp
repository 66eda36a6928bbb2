// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// parameter_table [NAME]: prints the name of a filter in MeshLab, then its parameters, one per line,
// separated by tabs: stage, advanced, id, type, default, low, high, choices joined by |, label, help. NAME is
// its Python name; default: the reconstruction.
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>

#include "filter_neuralmesh/actions.h"

namespace {

using namespace neuralmesh;
using Kind = SettingInfo::Kind;

const char* type_of(const SettingInfo& info) {
    switch (info.kind) {
        case Kind::boolean: return "RichBool";
        case Kind::integer: return "RichInt";
        case Kind::real: return "RichFloat";
        case Kind::length: return "RichAbsPerc";
        case Kind::choice: return "RichEnum";
        case Kind::layer: return "RichMesh";
    }
    return "";
}

/// The default as MeshLab writes it into a script.
std::string default_of(const SettingInfo& info) {
    const double value = info.value(Settings());
    if (info.kind == Kind::boolean) return value != 0 ? "true" : "false";
    std::ostringstream text;
    text << value;
    return text.str();
}

const char* name_of(Stage stage) {
    switch (stage) {
        case Stage::mesh: return "mesh";
        case Stage::cloud: return "cloud";
        case Stage::start: return "start";
        case Stage::learning: return "learning";
        case Stage::fit: return "fit";
        case Stage::features: return "features";
        case Stage::output: return "output";
        case Stage::run: return "run";
    }
    return "";
}

void write_table(const Action& action) {
    std::cout.precision(17);
    for (const SettingInfo& info : action.settings) {
        std::cout << name_of(info.stage) << '\t' << info.advanced << '\t' << info.id << '\t' << type_of(info)
                  << '\t' << default_of(info) << '\t' << info.low << '\t' << info.high << '\t';
        for (std::size_t i = 0; i < info.choices.size(); ++i)
            std::cout << (i == 0 ? "" : "|") << info.choices[i];
        std::cout << '\t' << info.label << '\t' << info.help << '\n';
    }
}

/// The action called \p python_name; else the reconstruction.
const Action& action_called(const std::string& python_name) {
    for (const Action& action : all_actions())
        if (python_name == action.python_name) return action;
    return action_of(kReconstruct);
}

}  // namespace

int main(int argc, char** argv) {
    const Action& action = action_called(argc > 1 ? argv[1] : "");
    std::cout << action.name << '\n';
    write_table(action);
    return EXIT_SUCCESS;
}
