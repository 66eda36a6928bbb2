// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Main program of a fuzz target without libFuzzer: replays the inputs in text files, so that the corpus is a
// test with any compiler. An input is a line in hexadecimal; '#' starts a comment.
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "bytes.h"

namespace {

bool read_hex(const std::string& line, std::vector<std::uint8_t>& input) {
    if (line.size() % 2 != 0 || line.find_first_not_of("0123456789abcdef") != std::string::npos) return false;
    for (std::size_t i = 0; i < line.size(); i += 2)
        input.push_back(static_cast<std::uint8_t>(std::stoi(line.substr(i, 2), nullptr, 16)));
    return true;
}

}  // namespace

int main(int count, char** files) {
    int inputs = 0;
    for (int i = 1; i < count; ++i) {
        std::ifstream file(files[i]);
        for (std::string line; std::getline(file, line);) {
            if (!line.empty() && line[0] == '#') continue;
            std::vector<std::uint8_t> input;
            if (!read_hex(line, input)) {
                std::cerr << files[i] << " has a line that is neither hexadecimal nor a comment: " << line
                          << '\n';
                return 2;
            }
            LLVMFuzzerTestOneInput(input.data(), input.size());
            ++inputs;
        }
    }
    std::cout << inputs << " inputs replayed\n";
    // An empty corpus tests nothing.
    return inputs > 0 ? 0 : 2;
}
