// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A view of consecutive values that someone else owns, with int indices (std::span comes with C++20).
#pragma once

#include <cassert>

namespace neuralmesh {

/// Valid as long as the container it was made from is neither changed in size nor destroyed.
template <class T>
class Span {
public:
    Span() = default;
    Span(T* begin, T* end) : begin_(begin), end_(end) {}

    T* begin() const { return begin_; }
    T* end() const { return end_; }
    int size() const { return static_cast<int>(end_ - begin_); }
    bool empty() const { return begin_ == end_; }
    T& operator[](int i) const {
        assert(i >= 0 && i < size());
        return begin_[i];
    }

private:
    T* begin_ = nullptr;
    T* end_ = nullptr;
};

}  // namespace neuralmesh
