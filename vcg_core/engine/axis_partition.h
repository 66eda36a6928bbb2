// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Space cut into slabs across one axis, one slab per thread.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

namespace neuralmesh {

/// Slabs across the longest axis of a sample, each with equally many of its points.
class AxisPartition {
public:
    /// Starts with one slab, all of space. \p sample may be empty. O(n log n) for n points.
    explicit AxisPartition(const std::vector<vcg::Point3f>& sample);

    /// Replaces the slabs by \p count new ones, at least 1. O(count).
    void cut(int count);
    int count() const { return static_cast<int>(borders_.size()) - 1; }

    /// The points p with begin <= p[axis] < end.
    struct Range {
        int axis;
        float begin;
        float end;

        bool holds(const vcg::Point3f& p) const {
            return static_cast<int>(begin <= p[axis]) & static_cast<int>(p[axis] < end);  // without a branch
        }
    };
    Range range(int slab) const {
        const auto i = static_cast<std::size_t>(slab);
        return {axis_, borders_[i], borders_[i + 1]};
    }
    /// The slab that holds p. O(count). \pre p is finite
    int of(const vcg::Point3f& p) const;

private:
    int axis_ = 0;
    std::vector<float> coordinates_;  ///< of the sample along the axis, in rising order
    std::vector<float> borders_;      ///< slab i reaches from borders_[i] to borders_[i + 1]
};

}  // namespace neuralmesh
