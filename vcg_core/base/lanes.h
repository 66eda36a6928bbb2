// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The vectors of simd.h in plain C++17, for compilers without vector extensions (MSVC). The results have the
// same bits.
#pragma once

#include <cstdint>
#include <type_traits>

namespace neuralmesh {

/// N numbers with the operators of a vector of GCC: lane by lane, a scalar operand stands for all lanes, and
/// a comparison gives -1 where it holds, else 0.
template <class T, int N>
struct alignas(N * sizeof(T)) Lanes {
    Lanes() = default;
    Lanes(T all) {  // NOLINT(google-explicit-constructor): so that a scalar can be an operand
        for (T& lane : lanes) lane = all;
    }
    template <class... Each, std::enable_if_t<sizeof...(Each) == N, int> = 0>
    Lanes(Each... each) : lanes{static_cast<T>(each)...} {}  // NOLINT(google-explicit-constructor): the same

    T& operator[](std::size_t i) { return lanes[i]; }
    const T& operator[](std::size_t i) const { return lanes[i]; }

    Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
    Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
    Lanes& operator&=(const Lanes& b) { return *this = *this & b; }

    friend Lanes operator+(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x + y; });
    }
    friend Lanes operator-(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x - y; });
    }
    friend Lanes operator*(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x * y; });
    }
    friend Lanes operator/(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x / y; });
    }
    friend Lanes operator&(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x & y; });
    }
    friend Lanes operator|(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x | y; });
    }
    friend Lanes operator^(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x ^ y; });
    }
    friend Lanes operator<<(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x << y; });
    }
    friend Lanes operator>>(const Lanes& a, const Lanes& b) {
        return each<T>(a, b, [](T x, T y) { return x >> y; });
    }
    friend Lanes operator~(const Lanes& a) {
        return each<T>(a, a, [](T x, T) { return ~x; });
    }

    using Mask = Lanes<std::int32_t, N>;
    friend Mask operator<(const Lanes& a, const Lanes& b) {
        return each<std::int32_t>(a, b, [](T x, T y) { return x < y ? -1 : 0; });
    }
    friend Mask operator>(const Lanes& a, const Lanes& b) { return b < a; }
    friend Mask operator==(const Lanes& a, const Lanes& b) {
        return each<std::int32_t>(a, b, [](T x, T y) { return x == y ? -1 : 0; });
    }

    T lanes[N];

private:
    template <class To, class Function>
    static Lanes<To, N> each(const Lanes& a, const Lanes& b, const Function& function) {
        Lanes<To, N> result;
        for (int i = 0; i < N; ++i) result.lanes[i] = static_cast<To>(function(a.lanes[i], b.lanes[i]));
        return result;
    }
};

}  // namespace neuralmesh
