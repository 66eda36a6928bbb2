// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Extensions of compilers, processors and operating systems, each with a portable branch. Vector arithmetic
// is in simd.h; no other file of the core and of the filter uses such extensions. NEURALMESH_PORTABLE chooses
// the portable branches everywhere, to test them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__GNUC__) && !defined(NEURALMESH_PORTABLE)
#define NEURALMESH_GNU
#endif
// Around headers in which gcc takes variables for uninitialized; each with a semicolon.
#if defined(__GNUC__) && !defined(__clang__)
#define NEURALMESH_BEGIN_UNINITIALIZED() \
    _Pragma("GCC diagnostic push")       \
        _Pragma("GCC diagnostic ignored \"-Wmaybe-uninitialized\"") static_assert(true, "")
#define NEURALMESH_END_UNINITIALIZED() _Pragma("GCC diagnostic pop") static_assert(true, "")
#else
#define NEURALMESH_BEGIN_UNINITIALIZED() static_assert(true, "")
#define NEURALMESH_END_UNINITIALIZED() static_assert(true, "")
#endif

#if defined(__SSE2__) && !defined(NEURALMESH_PORTABLE)
#define NEURALMESH_SSE2
#endif

#ifdef NEURALMESH_SSE2
#include <emmintrin.h>
#endif
#if defined(__linux__) && !defined(NEURALMESH_PORTABLE)
#include <dlfcn.h>
#endif

/// Inlines a function regardless of its size.
#ifdef NEURALMESH_GNU
#define NEURALMESH_ALWAYS_INLINE [[gnu::always_inline]] inline
#elif defined(_MSC_VER)
#define NEURALMESH_ALWAYS_INLINE __forceinline
#else
#define NEURALMESH_ALWAYS_INLINE inline
#endif

namespace neuralmesh {

/// Starts to load the cache line of \p address, which may be any address, even an invalid one.
NEURALMESH_ALWAYS_INLINE void prefetch([[maybe_unused]] const void* address) {
#ifdef NEURALMESH_GNU
    __builtin_prefetch(address);
#endif
}

/// As prefetch(), for a cache line that will be written: other cores give up their copies.
NEURALMESH_ALWAYS_INLINE void prefetch_for_write([[maybe_unused]] const void* address) {
#ifdef NEURALMESH_GNU
    __builtin_prefetch(address, 1);
#endif
}

/// std::bit_cast of C++20.
template <class To, class From>
To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
                  std::is_trivially_copyable_v<From>);
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

/// Number of set bits.
inline int bit_count(std::uint64_t word) {
#ifdef NEURALMESH_GNU
    return __builtin_popcountll(word);
#else
    int count = 0;
    for (; word != 0; word &= word - 1) ++count;
    return count;
#endif
}

/// Position of the lowest set bit. \pre word != 0
inline int lowest_bit(std::uint64_t word) {
#ifdef NEURALMESH_GNU
    return __builtin_ctzll(word);
#else
    return bit_count((word & (~word + 1)) - 1);
#endif
}

/// Position of the highest set bit. \pre word != 0
inline int highest_bit(std::uint64_t word) {
#ifdef NEURALMESH_GNU
    return 63 - __builtin_clzll(word);
#else
    int position = 0;
    while ((word >>= 1) != 0) ++position;
    return position;
#endif
}

/// Returns \p from and promises the compiler that it is aligned to \p Alignment bytes.
template <std::size_t Alignment, class T>
NEURALMESH_ALWAYS_INLINE T* assume_aligned(T* from) {
#ifdef NEURALMESH_GNU
    return static_cast<T*>(__builtin_assume_aligned(from, Alignment));
#else
    return from;
#endif
}

/// For loops that wait for another thread: saves power and leaves the core to its other hardware thread.
inline void spin_pause() {
#ifdef NEURALMESH_SSE2
    _mm_pause();
#endif
}

/// Whether a library of this process exports \p symbol; \p unknown where the system is not asked.
inline bool is_exported([[maybe_unused]] const char* symbol, [[maybe_unused]] bool unknown) {
#if defined(__linux__) && !defined(NEURALMESH_PORTABLE)
    return dlsym(RTLD_DEFAULT, symbol) != nullptr;
#else
    return unknown;
#endif
}

}  // namespace neuralmesh
