// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// std::bit_cast of C++20.
#pragma once

#include <cstring>
#include <type_traits>

namespace neuralmesh {

/// The value of type \p To that has the same bytes as \p from. Compiles to at most one register move.
template <class To, class From>
To bit_cast(const From& from) noexcept {
    static_assert(sizeof(To) == sizeof(From), "bit_cast between types of different size");
    static_assert(std::is_trivially_copyable_v<To> && std::is_trivially_copyable_v<From>);
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

}  // namespace neuralmesh
