// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Space cut into slabs, one for each thread that learns.
#pragma once

#include <vcg/space/point3.h>

#include <vector>

namespace neuralmesh {

/// Slabs across the longest axis of a sample, cut so that each holds as many of its points as the others.
class AxisPartition {
public:
    /// One slab, which is all space. O(n log n) in the points of the \p sample.
    explicit AxisPartition(const std::vector<vcg::Point3f>& sample);

    /// Cuts anew into \p count slabs, at least 1. O(count).
    void split(int count);
    int count() const { return static_cast<int>(borders_.size()) - 1; }

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
    /// The slab that holds p. O(count).
    int of(const vcg::Point3f& p) const;

private:
    int axis_ = 0;
    std::vector<float> places_;   ///< of the sample along the axis, in order
    std::vector<float> borders_;  ///< slab i from borders_[i] to borders_[i + 1]
};

}  // namespace neuralmesh
