// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Replacements of the allocation functions. The linker option --wrap redirects the calls of malloc, calloc,
// realloc and free in our own objects to them, but not those within libraries.
#include "allocations.h"

#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <new>

namespace {

std::atomic<long long> made{0};
std::atomic<long long> alive{0};
std::atomic<long long> failing{-1};
std::atomic<bool> all_after{false};

/// Counts one allocation. \return true if it has to fail
bool denied() {
    const long long nth = made++;
    const long long bound = failing;
    return bound >= 0 && (nth == bound || (all_after && nth > bound));
}

}  // namespace

// NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming): the linker names them
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* block, std::size_t size);
void __real_free(void* block);

void* __wrap_malloc(std::size_t size) {
    void* block = denied() ? nullptr : __real_malloc(size);
    if (block != nullptr) ++alive;
    return block;
}

void* __wrap_calloc(std::size_t count, std::size_t size) {
    void* block = denied() ? nullptr : __real_calloc(count, size);
    if (block != nullptr) ++alive;
    return block;
}

void* __wrap_realloc(void* block, std::size_t size) {
    void* moved = denied() ? nullptr : __real_realloc(block, size);
    if (moved != nullptr && block == nullptr) ++alive;
    return moved;
}

void __wrap_free(void* block) {
    if (block != nullptr) --alive;
    __real_free(block);
}
}
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming)

// free() accepts blocks of aligned_alloc(), so the aligned and the plain forms share it.
void* operator new(std::size_t size) {
    void* block = denied() ? nullptr : __real_malloc(size == 0 ? 1 : size);
    if (block == nullptr) throw std::bad_alloc();
    ++alive;
    return block;
}

void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto step = static_cast<std::size_t>(alignment);
    void* block = denied() ? nullptr : std::aligned_alloc(step, (size + step - 1) / step * step);
    if (block == nullptr) throw std::bad_alloc();
    ++alive;
    return block;
}

void operator delete(void* block) noexcept {
    if (block != nullptr) --alive;
    __real_free(block);
}
void operator delete(void* block, std::size_t /*size*/) noexcept { operator delete(block); }
void operator delete(void* block, std::align_val_t /*alignment*/) noexcept { operator delete(block); }
void operator delete(void* block, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
    operator delete(block);
}

namespace neuralmesh::allocations {

void fail_at(long long nth, Failure failure) {
    all_after = failure == Failure::from_then_on;
    failing = nth;
    made = 0;
}

long long count() { return made; }
long long living() { return alive; }

long long resident_bytes() {
    long long size = 0;
    long long resident = 0;
    std::ifstream("/proc/self/statm") >> size >> resident;
    return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace neuralmesh::allocations
