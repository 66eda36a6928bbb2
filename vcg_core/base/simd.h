// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Vectors of four and eight floats, and functions compiled for several instruction sets. With GCC and clang
// they are vector extensions, which compile for every processor; elsewhere those of lanes.h.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "vcg_core/base/platform.h"

#ifdef NEURALMESH_SSE2
#include <emmintrin.h>
#endif
#ifndef NEURALMESH_GNU
#include "vcg_core/base/lanes.h"
#endif

namespace neuralmesh {

#ifdef NEURALMESH_GNU
using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
using Eight = float __attribute__((vector_size(32), aligned(32)));
using EightInts = std::int32_t __attribute__((vector_size(32), aligned(32)));
using EightWords = std::uint32_t __attribute__((vector_size(32), aligned(32)));
#else
using Four = Lanes<float, 4>;
using FourInts = Lanes<std::int32_t, 4>;
using Eight = Lanes<float, 8>;
using EightInts = Lanes<std::int32_t, 8>;
using EightWords = Lanes<std::uint32_t, 8>;
#endif

// GCC has __builtin_shufflevector from 12 on.
#if defined(NEURALMESH_GNU) && (defined(__clang__) || __GNUC__ >= 12)
#define NEURALMESH_SHUFFLES
#endif

/// Loads 16 bytes, aligned to 16, unchanged.
inline Four load_raw(const void* from) {
    Four v;
    std::memcpy(&v, assume_aligned<16>(from), sizeof v);
    return v;
}

/// Loads x, y and z from 16 bytes, aligned to 16, whose last word is not a float; the fourth lane becomes 0.
inline Four load_xyz(const void* from) {
    return bit_cast<Four>(bit_cast<FourInts>(load_raw(from)) & FourInts{-1, -1, -1, 0});
}

/// Stores x, y and z to the first 12 of 16 bytes, aligned to 16; the last word keeps its value.
inline void store_xyz(void* to, Four v) {
    const FourInts bits = (bit_cast<FourInts>(v) & FourInts{-1, -1, -1, 0}) |
                          (bit_cast<FourInts>(load_raw(to)) & FourInts{0, 0, 0, -1});
    std::memcpy(assume_aligned<16>(to), &bits, sizeof bits);
}

/// A mask whose bit i is set if words[i] == v, i = 0..3.
inline unsigned equal_mask(const std::int32_t* words, std::int32_t v) {
#ifdef NEURALMESH_SSE2
    const __m128i four = _mm_loadu_si128(reinterpret_cast<const __m128i*>(words));
    return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(four, _mm_set1_epi32(v)))));
#else
    unsigned mask = 0;
    for (unsigned i = 0; i < 4; ++i) mask |= (words[i] == v ? 1u : 0u) << i;
    return mask;
#endif
}

/// Eight points or vectors, one per lane.
struct alignas(32) EightVectors {
    Eight x, y, z;
};

// Inlined into functions that are compiled for several instruction sets. Results are passed by reference: the
// registers for returning a vector of eight depend on the instruction set.

NEURALMESH_ALWAYS_INLINE void add(EightVectors& a, const EightVectors& b) {
    a.x += b.x;
    a.y += b.y;
    a.z += b.z;
}

NEURALMESH_ALWAYS_INLINE void subtract(EightVectors& a, const EightVectors& b) {
    a.x -= b.x;
    a.y -= b.y;
    a.z -= b.z;
}

/// sum += a x b.
NEURALMESH_ALWAYS_INLINE void add_cross(EightVectors& sum, const EightVectors& a, const EightVectors& b) {
    sum.x += a.y * b.z - a.z * b.y;
    sum.y += a.z * b.x - a.x * b.z;
    sum.z += a.x * b.y - a.y * b.x;
}

/// Whether any lane of a mask is set.
NEURALMESH_ALWAYS_INLINE bool any(const EightInts& mask) {
    std::uint64_t pairs[4];
    std::memcpy(pairs, &mask, sizeof pairs);
    return (pairs[0] | pairs[1] | pairs[2] | pairs[3]) != 0;
}

/// Sets the lanes of v to 0 where mask is 0 and keeps them where it is -1.
NEURALMESH_ALWAYS_INLINE void keep_where(const EightInts& mask, Eight& v) {
    EightInts bits;
    std::memcpy(&bits, &v, sizeof bits);
    bits &= mask;
    std::memcpy(&v, &bits, sizeof v);
}

NEURALMESH_ALWAYS_INLINE void keep_where(const EightInts& mask, EightVectors& v) {
    keep_where(mask, v.x);
    keep_where(mask, v.y);
    keep_where(mask, v.z);
}

/// Lane by lane, v = a where mask is -1, v = b where it is 0.
template <class Lanes>
NEURALMESH_ALWAYS_INLINE void choose(const EightInts& mask, const Lanes& a, const Lanes& b, Lanes& v) {
#ifdef NEURALMESH_GNU
    v = mask ? a : b;
#else
    for (int i = 0; i < 8; ++i) v[i] = mask[i] != 0 ? a[i] : b[i];
#endif
}

NEURALMESH_ALWAYS_INLINE void choose(const EightInts& mask, const EightVectors& a, const EightVectors& b,
                                     EightVectors& v) {
    choose(mask, a.x, b.x, v.x);
    choose(mask, a.y, b.y, v.y);
    choose(mask, a.z, b.z, v.z);
}

/// Replaces every lane by its square root; the loop compiles to one instruction.
NEURALMESH_ALWAYS_INLINE void square_root(Eight& v) {
    float lanes[8];
    std::memcpy(lanes, &v, sizeof lanes);
    for (float& lane : lanes) lane = std::sqrt(lane);
    std::memcpy(&v, lanes, sizeof v);
}

/// The lanes of \p ints as floats.
NEURALMESH_ALWAYS_INLINE void convert(const EightInts& ints, Eight& floats) {
#ifdef NEURALMESH_GNU
    floats = __builtin_convertvector(ints, Eight);
#else
    for (int i = 0; i < 8; ++i) floats[i] = static_cast<float>(ints[i]);
#endif
}

/// The lanes of \p v rounded towards 0.
inline FourInts to_ints(Four v) {
#ifdef NEURALMESH_GNU
    return __builtin_convertvector(v, FourInts);
#else
    return {static_cast<std::int32_t>(v[0]), static_cast<std::int32_t>(v[1]), static_cast<std::int32_t>(v[2]),
            static_cast<std::int32_t>(v[3])};
#endif
}

#ifdef NEURALMESH_SHUFFLES
/// Transposes eight points (x, y, z, w) into their x, their y and their z; drops w.
NEURALMESH_ALWAYS_INLINE void transpose(const Four* p, EightVectors& v) {
    const auto pair = [](const Four& low, const Four& high, Eight& both) {
        both = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    };
    Eight a, b, c, d;
    pair(p[0], p[4], a);
    pair(p[1], p[5], b);
    pair(p[2], p[6], c);
    pair(p[3], p[7], d);
    const Eight xy01 = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    const Eight xy23 = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
    const Eight z01 = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    const Eight z23 = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
    v.x = __builtin_shufflevector(xy01, xy23, 0, 1, 8, 9, 4, 5, 12, 13);
    v.y = __builtin_shufflevector(xy01, xy23, 2, 3, 10, 11, 6, 7, 14, 15);
    v.z = __builtin_shufflevector(z01, z23, 0, 1, 8, 9, 4, 5, 12, 13);
}

/// The same; \p last_words receives the bits of w.
NEURALMESH_ALWAYS_INLINE void transpose(const Four* p, EightVectors& v, EightInts& last_words) {
    transpose(p, v);
    const auto last_of_pair = [](const Four& low, const Four& high, Eight& both) {
        both = __builtin_shufflevector(low, high, 2, 3, 2, 3, 6, 7, 6, 7);
    };
    Eight a, b, c, d;
    last_of_pair(p[0], p[4], a);
    last_of_pair(p[1], p[5], b);
    last_of_pair(p[2], p[6], c);
    last_of_pair(p[3], p[7], d);
    const Eight w01 = __builtin_shufflevector(a, b, 1, 9, 1, 9, 5, 13, 5, 13);
    const Eight w23 = __builtin_shufflevector(c, d, 1, 9, 1, 9, 5, 13, 5, 13);
    const Eight w = __builtin_shufflevector(w01, w23, 0, 1, 8, 9, 4, 5, 12, 13);
    std::memcpy(&last_words, &w, sizeof last_words);
}

/// The inverse transposition: to[i] = (x, y, z, 0) of lane i.
NEURALMESH_ALWAYS_INLINE void transpose(const EightVectors& v, Four* to) {
    const Eight zero = {0, 0, 0, 0, 0, 0, 0, 0};
    const Eight xy_low = __builtin_shufflevector(v.x, v.y, 0, 8, 1, 9, 4, 12, 5, 13);
    const Eight xy_high = __builtin_shufflevector(v.x, v.y, 2, 10, 3, 11, 6, 14, 7, 15);
    const Eight z_low = __builtin_shufflevector(v.z, zero, 0, 8, 1, 9, 4, 12, 5, 13);
    const Eight z_high = __builtin_shufflevector(v.z, zero, 2, 10, 3, 11, 6, 14, 7, 15);
    to[0] = __builtin_shufflevector(xy_low, z_low, 0, 1, 8, 9);
    to[1] = __builtin_shufflevector(xy_low, z_low, 2, 3, 10, 11);
    to[2] = __builtin_shufflevector(xy_high, z_high, 0, 1, 8, 9);
    to[3] = __builtin_shufflevector(xy_high, z_high, 2, 3, 10, 11);
    to[4] = __builtin_shufflevector(xy_low, z_low, 4, 5, 12, 13);
    to[5] = __builtin_shufflevector(xy_low, z_low, 6, 7, 14, 15);
    to[6] = __builtin_shufflevector(xy_high, z_high, 4, 5, 12, 13);
    to[7] = __builtin_shufflevector(xy_high, z_high, 6, 7, 14, 15);
}
#else
NEURALMESH_ALWAYS_INLINE void transpose(const Four* p, EightVectors& v) {
    for (int i = 0; i < 8; ++i) {
        v.x[i] = p[i][0];
        v.y[i] = p[i][1];
        v.z[i] = p[i][2];
    }
}

NEURALMESH_ALWAYS_INLINE void transpose(const Four* p, EightVectors& v, EightInts& last_words) {
    transpose(p, v);
    for (int i = 0; i < 8; ++i) last_words[i] = bit_cast<FourInts>(p[i])[3];
}

NEURALMESH_ALWAYS_INLINE void transpose(const EightVectors& v, Four* to) {
    for (int i = 0; i < 8; ++i) to[i] = Four{v.x[i], v.y[i], v.z[i], 0};
}
#endif

}  // namespace neuralmesh

// NEURALMESH_MULTIVERSIONED compiles a function for AVX2 and for the baseline; the dynamic linker chooses.
// Both versions give the same bits, as fused multiply-add is off (-ffp-contract=off). Programs built with
// sanitizers crash in the resolver, which runs before the sanitizer is initialised, so they get the baseline
// only. NEURALMESH_ONE_INSTRUCTION_SET also chooses the baseline, to count instructions on any machine.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define NEURALMESH_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define NEURALMESH_SANITIZED
#endif
#endif

#if defined(NEURALMESH_GNU) && defined(__x86_64__) && defined(__linux__) && \
    !defined(NEURALMESH_ONE_INSTRUCTION_SET) && !defined(NEURALMESH_SANITIZED)
#define NEURALMESH_MULTIVERSIONED __attribute__((target_clones("avx2", "default")))
#else
#define NEURALMESH_MULTIVERSIONED
#endif
