// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The half-edges of a network, shortest first, while collapses remove some of them.
#pragma once

#include <algorithm>
#include <queue>
#include <utility>
#include <vector>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

struct QueuedHalfEdge {
    float length;
    VertexId gone, kept;  ///< by its collapse

    /// The shorter one is larger. Ties are ordered by ids, so the result does not depend on the queue.
    bool operator<(const QueuedHalfEdge& other) const {
        if (length != other.length) return length > other.length;
        return std::pair(gone, kept) > std::pair(other.gone, other.kept);
    }
};

/// The half-edges of \p network by lengths that collapses do not change: length(a, b) of the one from a to b,
/// the same in both directions, at least 0. O(n log n) to make it, O(log n) for each half-edge taken.
template <class Length>
class HalfEdgeQueue {
public:
    HalfEdgeQueue(Network& network, Length length)
        : network_(network), length_(std::move(length)), neighbour_of_(network.slot_count(), -1) {
        for (const VertexId v : network.vertices())
            for (const VertexId w : network.ring(v)) first_.push_back({length_(v, w), v, w});
        std::sort(first_.begin(), first_.end());
    }
    bool empty() const { return first_.empty() && again_.empty(); }
    /// The shortest one. Its vertices, or the edge, may be there no more.
    QueuedHalfEdge take() {
        const bool again = first_.empty() || (!again_.empty() && first_.back() < again_.top());
        const QueuedHalfEdge shortest = again ? again_.top() : first_.back();
        if (again) {
            again_.pop();
        } else {
            first_.pop_back();
        }
        longest_taken_ = std::max(longest_taken_, shortest.length);
        return shortest;
    }
    /// Network::collapse(). Of the half-edges at \p kept, the new ones join the queue, and once more those
    /// that were taken before: what spoke against their collapse may have gone.
    void collapse(VertexId gone, VertexId kept) {
        for (const VertexId w : network_.ring(kept)) neighbour_of_[w] = kept;
        network_.collapse(gone, kept);
        for (const VertexId w : network_.ring(kept)) {
            const float length = length_(kept, w);
            // Nothing as long was taken yet.
            const bool waits = neighbour_of_[w] == kept && length > longest_taken_;
            if (waits) continue;
            again_.push({length, kept, w});
            again_.push({length, w, kept});
        }
    }

private:
    Network& network_;
    Length length_;
    std::vector<QueuedHalfEdge> first_;  ///< those of the start, longest first: sorted once, which is faster
    std::priority_queue<QueuedHalfEdge> again_;
    float longest_taken_ = 0;
    PerVertex<VertexId> neighbour_of_;  ///< a vertex beside which each has been; tells new neighbours
};

}  // namespace neuralmesh
