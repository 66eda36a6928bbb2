// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The one source of random numbers. Owned by whoever draws, never global; the same seed gives
// the same numbers on every platform, because the mapping to ranges is written here, too.
#pragma once

#include <cstdint>

namespace neuralmesh {

/// xoshiro128++ (Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2019),
/// seeded through splitmix64.
class Random {
public:
    explicit Random(std::uint64_t seed) {
        for (std::uint32_t& word : state_) {
            seed += 0x9e3779b97f4a7c15u;
            std::uint64_t z = seed;
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
            z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
            word = static_cast<std::uint32_t>((z ^ (z >> 31)) >> 32);
        }
    }

    /// 32 uniform bits.
    std::uint32_t bits() {
        const std::uint32_t result = rotated(state_[0] + state_[3], 7) + state_[0];
        const std::uint32_t t = state_[1] << 9;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= t;
        state_[3] = rotated(state_[3], 11);
        return result;
    }

    /// Uniform in [0, n), n > 0. The bias is below n / 2^32: invisible for any cloud that fits a machine.
    std::uint32_t below(std::uint32_t n) {
        const std::uint64_t product = std::uint64_t{bits()} * n;
        return static_cast<std::uint32_t>(product >> 32);
    }

    /// Uniform in [0, 1), a multiple of 2^-24: exact in float.
    float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24F; }

private:
    static std::uint32_t rotated(std::uint32_t x, int k) { return (x << k) | (x >> (32 - k)); }

    std::uint32_t state_[4] = {};
};

}  // namespace neuralmesh
