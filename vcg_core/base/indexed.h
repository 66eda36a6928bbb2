// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Arrays indexed by signed ids, such as those of vertices and faces.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace neuralmesh {

/// An int as index of a std::vector.
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// std::vector with int indices: values[v] instead of values[static_cast<std::size_t>(v)]. An index out of
/// range is undefined behaviour, caught by assert().
template <class T, class Allocator = std::allocator<T>>
class Indexed {
public:
    using Vector = std::vector<T, Allocator>;
    using value_type = T;
    using iterator = typename Vector::iterator;
    using const_iterator = typename Vector::const_iterator;

    Indexed() = default;
    explicit Indexed(int size) : values_(static_cast<std::size_t>(size)) {}
    Indexed(int size, const T& value) : values_(static_cast<std::size_t>(size), value) {}
    Indexed(std::initializer_list<T> values) : values_(values) {}
    explicit Indexed(Vector values) : values_(std::move(values)) {}

    T& operator[](int i) {
        assert(i >= 0 && i < size());
        return values_[static_cast<std::size_t>(i)];
    }
    const T& operator[](int i) const {
        assert(i >= 0 && i < size());
        return values_[static_cast<std::size_t>(i)];
    }

    int size() const { return static_cast<int>(values_.size()); }
    bool empty() const { return values_.empty(); }
    void resize(int size, const T& value = T()) { values_.resize(static_cast<std::size_t>(size), value); }
    void assign(int size, const T& value) { values_.assign(static_cast<std::size_t>(size), value); }
    void reserve(int size) { values_.reserve(static_cast<std::size_t>(size)); }
    void push_back(T value) { values_.push_back(std::move(value)); }
    void clear() { values_.clear(); }

    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    T& back() { return values_.back(); }
    const T& back() const { return values_.back(); }
    iterator begin() { return values_.begin(); }
    iterator end() { return values_.end(); }
    const_iterator begin() const { return values_.begin(); }
    const_iterator end() const { return values_.end(); }

    /// The underlying vector.
    Vector& vector() { return values_; }
    const Vector& vector() const { return values_; }

    bool operator==(const Indexed& other) const { return values_ == other.values_; }
    bool operator!=(const Indexed& other) const { return values_ != other.values_; }

private:
    Vector values_;
};

/// A view of consecutive values that someone else owns (std::span comes with C++20). Valid as long as the
/// container it was made from is neither changed in size nor destroyed.
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

/// \p values permuted: result[i] = values[order[i]], or \p fill where order[i] is -1. Keeps the capacity that
/// \p values has reserved for growth.
template <class T>
Indexed<T> permuted(const Indexed<T>& values, const std::vector<std::int32_t>& order, T fill) {
    Indexed<T> result;
    result.reserve(static_cast<int>(std::max(values.vector().capacity(), order.size())));
    for (const std::int32_t i : order) result.push_back(i < 0 ? fill : values[i]);
    return result;
}

}  // namespace neuralmesh
