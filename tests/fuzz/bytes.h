// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Shared by the fuzz targets: numbers from the bytes of an input, and failed expectations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>

namespace neuralmesh::fuzz {

/// Reads an input from its start; returns 0 behind its end.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    std::size_t left() const { return size_ - next_; }
    int byte() { return next_ < size_ ? data_[next_++] : 0; }
    /// In [0, n); n from 1 to 256.
    int below(int n) { return byte() % n; }
    /// Arbitrary bits, including NaN, infinity and denormal numbers.
    template <class T>
    T raw() {
        std::uint8_t bits[sizeof(T)];
        for (std::uint8_t& b : bits) b = static_cast<std::uint8_t>(byte());
        T value;
        std::memcpy(&value, bits, sizeof value);
        return value;
    }

private:
    const std::uint8_t* data_;
    std::size_t size_;
    std::size_t next_ = 0;
};

/// Prints the sentence and aborts, so the fuzzer keeps the input.
[[noreturn]] inline void fail(const std::string& sentence) {
    std::fprintf(stderr, "%s\n", sentence.c_str());
    std::abort();
}

inline void expect(bool holds, const char* sentence) {
    if (!holds) fail(sentence);
}

/// Errors of the core must be sentences for the user.
inline void expect_sentence(const std::string& what) {
    expect(what.size() > 20 && (what.back() == '.' || what.back() == ')'), "an error is no sentence");
}

}  // namespace neuralmesh::fuzz

/// Called by libFuzzer, or by replay.cpp, with every input.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer names it
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
