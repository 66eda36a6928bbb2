// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Keeps operator new and delete out of what the library for macOS exports: zig's linker exports those of its
// static libc++, whatever list of names it is given, and the loader could let other libraries use them.
// Compiled with -fvisibility-global-new-delete=force-hidden, these take their place.
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

void* checked(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

void* allocated(std::size_t size) { return checked(std::malloc(size == 0 ? 1 : size)); }

void* allocated(std::size_t size, std::align_val_t alignment) {
    void* memory = nullptr;
    const auto bytes = static_cast<std::size_t>(alignment);
    return checked(posix_memalign(&memory, bytes < sizeof(void*) ? sizeof(void*) : bytes, size) == 0 ? memory : nullptr);
}

}  // namespace

void* operator new(std::size_t size) { return allocated(size); }
void* operator new[](std::size_t size) { return allocated(size); }
void* operator new(std::size_t size, std::align_val_t alignment) { return allocated(size, alignment); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return allocated(size, alignment); }

void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size == 0 ? 1 : size); }

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
