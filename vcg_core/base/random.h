// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The random numbers of the core. There is no global generator. The same seed gives the same numbers on every
// platform; the distributions of <random> do not promise that.
#pragma once

#include <cstdint>

namespace neuralmesh {

/// The purposes for which a run draws random numbers.
enum class Stream {
    learning = 0,   ///< the signals
    rms_error = 1,  ///< the points at which the result is measured
    shell = 2,      ///< the points for the start mesh
    fit = 3,        ///< the points for the fit
    colors = 4,     ///< the points that give faces their colours
    topology = 5,   ///< the signals by which membranes are told
    held_out = 6,   ///< the points by which the mesh is judged
};

/// The seed of the generator for one purpose in a run with the given seed, at least 0. Runs whose seeds
/// differ by less than 7 share sequences, for different purposes.
constexpr std::uint64_t stream_seed(int seed, Stream purpose) {
    return static_cast<std::uint64_t>(seed) + static_cast<std::uint64_t>(purpose);
}

/// xoshiro128++ (Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2019), seeded by
/// splitmix64. It draws in 1.2 ns, std::mt19937 in 5.5 ns.
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
        const std::uint32_t result = rotate_left(state_[0] + state_[3], 7) + state_[0];
        const std::uint32_t t = state_[1] << 9;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= t;
        state_[3] = rotate_left(state_[3], 11);
        return result;
    }

    /// Uniform in [0, n), n > 0. The relative error of a probability is below n / 2^32.
    std::uint32_t below(std::uint32_t n) {
        const std::uint64_t product = std::uint64_t{bits()} * n;
        return static_cast<std::uint32_t>(product >> 32);
    }

    /// Uniform in [0, 1), a multiple of 2^-24, without rounding.
    float unit() { return static_cast<float>(bits() >> 8) * 0x1p-24F; }

private:
    static std::uint32_t rotate_left(std::uint32_t x, int k) { return (x << k) | (x >> (32 - k)); }

    std::uint32_t state_[4] = {};
};

}  // namespace neuralmesh
