// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Arrays that are written whole before they are read: clearing them first would read and write memory once
// more, on one thread.
#pragma once

#include <memory>
#include <new>
#include <utility>

namespace neuralmesh {

/// Allocator by which new elements of a vector have no value yet, if their type has no default values.
template <class T>
class Unset : public std::allocator<T> {
public:
    template <class U>
    struct rebind {
        using other = Unset<U>;
    };

    Unset() = default;
    template <class U>
    Unset(const Unset<U>&) {}  // NOLINT(google-explicit-constructor): allocators are converted

    template <class U>
    void construct(U* place) {
        ::new (static_cast<void*>(place)) U;
    }
    template <class U, class First, class... Rest>
    void construct(U* place, First&& first, Rest&&... rest) {
        ::new (static_cast<void*>(place)) U(std::forward<First>(first), std::forward<Rest>(rest)...);
    }
};

}  // namespace neuralmesh
