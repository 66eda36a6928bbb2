// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What the fuzz targets share: numbers out of an input's bytes, and the end of the process with a sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>

namespace neuralmesh::fuzz {

/// Reads an input from its start; 0 once it is used up.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

    std::size_t left() const { return size_ - next_; }
    int byte() { return next_ < size_ ? data_[next_++] : 0; }
    /// In [0, n); n from 1 to 256.
    int below(int n) { return byte() % n; }
    bool flag() { return (byte() & 1) != 0; }
    /// Any bit pattern: NaN, infinite, denormal, too.
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

/// A promise does not hold: says which and aborts, so that the fuzzer keeps the input.
[[noreturn]] inline void fail(const std::string& sentence) {
    std::fprintf(stderr, "%s\n", sentence.c_str());
    std::abort();
}

inline void expect(bool holds, const char* sentence) {
    if (!holds) fail(sentence);
}

/// What an error of the core says must be fit for a user's eyes.
inline void expect_sentence(const std::string& what) {
    expect(what.size() > 20 && (what.back() == '.' || what.back() == ')'), "an error is no sentence");
}

}  // namespace neuralmesh::fuzz

/// What libFuzzer, or replay.cpp in its place, calls with every input.
// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer names it
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
