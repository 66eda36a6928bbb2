// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Four floats at once, and functions compiled for more than one instruction set. GCC's and clang's vector
// extensions, so that the code says what happens and not which instruction does it.
#pragma once

#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace neuralmesh {

using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));

/// x, y and z of 16 aligned bytes whose last word is no float; 0 in its place.
inline Four load_xyz(const void* from) {
    FourInts bits;
    std::memcpy(&bits, __builtin_assume_aligned(from, 16), sizeof bits);
    bits &= FourInts{-1, -1, -1, 0};
    Four v;
    std::memcpy(&v, &bits, sizeof v);
    return v;
}

/// Bit i is set where word i of four equals v.
inline unsigned equal_mask(const std::int32_t* words, std::int32_t v) {
#ifdef __SSE2__
    const __m128i four = _mm_loadu_si128(reinterpret_cast<const __m128i*>(words));
    return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(four, _mm_set1_epi32(v)))));
#else
    unsigned mask = 0;
    for (unsigned i = 0; i < 4; ++i) mask |= (words[i] == v ? 1u : 0u) << i;
    return mask;
#endif
}

inline Four cross(Four a, Four b) {
    const Four a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3);
    const Four b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
    const Four c = a * b_yzx - a_yzx * b;  // z, x, y of the product
    return __builtin_shufflevector(c, c, 1, 2, 0, 3);
}

/// Four points into the x, y and z of four lanes.
inline void transpose(const Four* p, float* x, float* y, float* z) {
    const Four low01 = __builtin_shufflevector(p[0], p[1], 0, 4, 1, 5);
    const Four low23 = __builtin_shufflevector(p[2], p[3], 0, 4, 1, 5);
    const Four high01 = __builtin_shufflevector(p[0], p[1], 2, 6, 3, 7);
    const Four high23 = __builtin_shufflevector(p[2], p[3], 2, 6, 3, 7);
    const Four px = __builtin_shufflevector(low01, low23, 0, 1, 4, 5);
    const Four py = __builtin_shufflevector(low01, low23, 2, 3, 6, 7);
    const Four pz = __builtin_shufflevector(high01, high23, 0, 1, 4, 5);
    std::memcpy(x, &px, sizeof px);
    std::memcpy(y, &py, sizeof py);
    std::memcpy(z, &pz, sizeof pz);
}

}  // namespace neuralmesh

// A function marked NEURALMESH_MULTIVERSIONED exists twice and the machine's best is chosen at load time; one
// inside NEURALMESH_HAS_AVX2 asks the machine itself. No fused multiply-add (-ffp-contract=off), so all give
// the same bits. Sanitizers instrument the choice at load time and crash in it.
// NEURALMESH_ONE_INSTRUCTION_SET makes the same instructions run on every machine, to count them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define NEURALMESH_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define NEURALMESH_SANITIZED
#endif
#endif

#if defined(__x86_64__) && defined(__ELF__) && !defined(NEURALMESH_ONE_INSTRUCTION_SET)
#define NEURALMESH_HAS_AVX2
#include <immintrin.h>
#endif

#if defined(NEURALMESH_HAS_AVX2) && !defined(NEURALMESH_SANITIZED)
#define NEURALMESH_MULTIVERSIONED __attribute__((target_clones("avx2", "default")))
#else
#define NEURALMESH_MULTIVERSIONED
#endif
