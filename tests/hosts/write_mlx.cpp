// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// write_mlx [--filter=NAME] [ID=VALUE ...]: prints a script for meshlabserver with all parameters of a
// filter, at their defaults or the values given. (meshlabserver aborts on scripts that omit one.) NAME is a
// Python name; default: the reconstruction. write_mlx [--filter=NAME] --table: prints the parameters, one per
// line, separated by tabs: stage, advanced, id, type, default, low, high, choices joined by |, label, help.
#include <cstdlib>
#include <iostream>
#include <map>
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

void write_parameter(const SettingInfo& info, const std::string& value) {
    std::cout << "  <Param type=\"" << type_of(info) << "\" name=\"" << info.id << "\" value=\"" << value
              << '"';
    if (info.kind == Kind::choice) {
        std::cout << " enum_cardinality=\"" << info.choices.size() << '"';
        for (std::size_t i = 0; i < info.choices.size(); ++i)
            std::cout << " enum_val" << i << "=\"" << info.choices[i] << '"';
    }
    if (info.kind == Kind::length) std::cout << " min=\"0\" max=\"1\"";
    std::cout << "/>\n";
}

void write_script(const Action& action, std::map<std::string, std::string> values) {
    std::cout << "<!DOCTYPE FilterScript>\n<FilterScript>\n <filter name=\"" << action.name << "\">\n";
    for (const SettingInfo& info : action.settings) {
        const auto given = values.find(info.id);
        write_parameter(info, given == values.end() ? default_of(info) : given->second);
    }
    std::cout << " </filter>\n</FilterScript>\n";
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

bool is_id(const Action& action, const std::string& word) {
    for (const SettingInfo& info : action.settings)
        if (word == info.id) return true;
    return false;
}

/// The action that the first argument names, if it does; else the reconstruction.
const Action& chosen_action(int argc, char** argv, int& next) {
    next = 1;
    for (const Action& action : all_actions()) {
        if (argc < 2 || argv[1] != std::string("--filter=") + action.python_name) continue;
        next = 2;
        return action;
    }
    return action_of(kReconstruct);
}

}  // namespace

int main(int argc, char** argv) {
    std::map<std::string, std::string> values;
    int first = 1;
    const Action& action = chosen_action(argc, argv, first);
    for (int i = first; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--table") {
            write_table(action);
            return EXIT_SUCCESS;
        }
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos || !is_id(action, word.substr(0, equals))) {
            std::cerr << word
                      << " is not ID=VALUE with the id of a parameter; write_mlx --table lists them.\n";
            return EXIT_FAILURE;
        }
        values[word.substr(0, equals)] = word.substr(equals + 1);
    }
    write_script(action, values);
    return EXIT_SUCCESS;
}
