// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A priority queue with lazy deletion, most of whose entries are out of date before they come to the top.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace neuralmesh {

/// Only the cheapest entries are in a heap, one that fits into the cache. The others wait unordered, and
/// those that are out of date by then are dropped when the next ones move up. \p Entry has operator<, cheaper
/// first.
template <class Entry>
class LazyPriorityQueue {
public:
    /// Amortised O(1) for most entries, O(log n) for the cheapest.
    void push(const Entry& entry) {
        if (!bounded_ || bound_ < entry) {
            later_.push_back(entry);
        } else {
            soon_.push_back(entry);
            std::push_heap(soon_.begin(), soon_.end(), Dearer());
        }
    }

    /// Takes the cheapest entry for which \p is_current(entry) holds, and drops the cheaper ones. \return
    /// false if there is none
    template <class IsCurrent>
    bool pop(Entry& entry, const IsCurrent& is_current) {
        while (!soon_.empty() || refill(is_current)) {
            std::pop_heap(soon_.begin(), soon_.end(), Dearer());
            entry = soon_.back();
            soon_.pop_back();
            if (is_current(entry)) return true;
        }
        return false;
    }

private:
    struct Dearer {
        bool operator()(const Entry& a, const Entry& b) const { return b < a; }
    };

    template <class IsCurrent>
    bool refill(const IsCurrent& is_current) {
        constexpr std::size_t kLeast = 1024, kShare = 8;
        later_.erase(std::remove_if(later_.begin(), later_.end(),
                                    [&](const Entry& entry) { return !is_current(entry); }),
                     later_.end());
        if (later_.empty()) return false;
        const auto count =
            static_cast<std::ptrdiff_t>(std::min(later_.size(), std::max(kLeast, later_.size() / kShare)));
        // The cheapest ones to the end, from where they are taken.
        const auto first = later_.end() - count;
        std::nth_element(later_.begin(), first, later_.end(), Dearer());
        bound_ = *first;
        bounded_ = true;
        soon_.assign(first, later_.end());
        later_.erase(first, later_.end());
        std::make_heap(soon_.begin(), soon_.end(), Dearer());
        return true;
    }

    std::vector<Entry> soon_;   ///< a heap
    std::vector<Entry> later_;  ///< dearer than bound_
    Entry bound_{};
    bool bounded_ = false;  ///< some have been taken
};

}  // namespace neuralmesh
