// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Memory in pages of 2 MB for arrays with random access. In the usual pages of 4 KB, a network of a million
// vertices exceeds the translation lookaside buffer (TLB).
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <vector>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

/// Allocator that requests huge pages for blocks of at least two of them. Throws std::bad_alloc.
template <class T>
class HugePages {
public:
    using value_type = T;

    HugePages() = default;
    template <class U>
    HugePages(const HugePages<U>&) {}  // NOLINT(google-explicit-constructor): allocators are converted

    T* allocate(std::size_t count) {
        const std::size_t bytes = count * sizeof(T);
        if (bytes < kLeast) return std::allocator<T>().allocate(count);
        if (count > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_alloc();
        void* const memory = ::operator new (bytes, std::align_val_t{kHugePageBytes});
        advise_huge_pages(memory, bytes);
        return static_cast<T*>(memory);
    }
    void deallocate(T* memory, std::size_t count) noexcept {
        if (count * sizeof(T) < kLeast) {
            std::allocator<T>().deallocate(memory, count);
        } else {
            ::operator delete (memory, std::align_val_t{kHugePageBytes});
        }
    }

    template <class U>
    bool operator==(const HugePages<U>&) const {
        return true;
    }
    template <class U>
    bool operator!=(const HugePages<U>&) const {
        return false;
    }

private:
    static constexpr std::size_t kLeast = 2 * kHugePageBytes;
};

template <class T>
using HugeVector = std::vector<T, HugePages<T>>;

}  // namespace neuralmesh
