// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The target space Omega of the paper: what signals are drawn from, in the core's own frame.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/base/random.h"

namespace neuralmesh {

/// The core's frame: the bounding box centred on the origin, its diagonal of length 1. Computed in double,
/// so that learning in float is indifferent to where and how large the cloud is. (Where all but a few points
/// lie in a thousandth of the box, these are centred: near the origin float tells most places apart.)
struct Frame {
    vcg::Point3d centre{0, 0, 0};
    double diagonal = 1;

    vcg::Point3f inside(const vcg::Point3d& p) const;
    vcg::Point3d outside(const vcg::Point3f& p) const;
};

/// Points, or triangles weighted by their area, with a uniform random sample(), O(1) for points and O(log n)
/// for triangles. Memory: 12 bytes per point; 12 bytes per corner and 8 per triangle.
class TargetSpace {
public:
    /// A cloud. \p point_at(i), i in [0, count), gives a point as vcg::Point3d; called more than once per
    /// point. \throws InputError: no points, not finite, fewer than 4 distinct, all on a line
    template <class PointAt>
    static TargetSpace points(std::size_t count, const PointAt& point_at);

    /// Triangles, drawn from in proportion to their areas. \p corner_at(i, k), i in [0, count), k in 0..2.
    /// \throws InputError as points(), and if the total area is zero
    template <class CornerAt>
    static TargetSpace triangles(std::size_t count, const CornerAt& corner_at);

    /// One random point of the target space, in the core's frame.
    vcg::Point3f sample(Random& random) const;

    /// The cloud without the points where \p left_out is not 0, in the frame of what remains; nothing if that
    /// spans no surface. O(points).
    std::optional<TargetSpace> without(const std::vector<std::uint8_t>& left_out) const;

    /// The cloud with every place once, in the same frame, if more than a tenth of its points repeat others
    /// to the bit; nothing otherwise, or if the target has faces. That share is estimated from 100,000 points
    /// and places, exact for fewer points. O(points), O(points log points) if there is something to do.
    std::optional<TargetSpace> each_place_once() const;

    const Frame& frame() const { return frame_; }
    bool has_faces() const { return !cumulative_area_.empty(); }
    /// The points, or the corners of the triangles three by three, in the core's frame.
    const std::vector<vcg::Point3f>& positions() const { return positions_; }

private:
    template <class PointAt>
    void take(std::size_t count, const PointAt& point_at);
    template <class PointAt>
    static vcg::Box3d box_of_most(std::size_t count, const PointAt& point_at);
    void centre_on(const vcg::Box3d& most);
    void set_frame(const vcg::Box3d& box, std::size_t not_finite, std::size_t count);
    /// Why the points cannot be learned, as a sentence; empty if they can.
    std::string lack_of_spread() const;
    void check_spread() const;
    void accumulate_areas();

    Frame frame_;
    bool off_centre_ = false;  ///< the frame is centred on most of the points, not on their box
    std::vector<vcg::Point3f> positions_;
    std::vector<double> cumulative_area_;
};

template <class PointAt>
TargetSpace TargetSpace::points(std::size_t count, const PointAt& point_at) {
    TargetSpace target;
    target.take(count, point_at);
    target.check_spread();
    return target;
}

template <class CornerAt>
TargetSpace TargetSpace::triangles(std::size_t count, const CornerAt& corner_at) {
    TargetSpace target;
    target.take(3 * count, [&](std::size_t i) { return corner_at(i / 3, static_cast<int>(i % 3)); });
    target.check_spread();
    target.accumulate_areas();
    return target;
}

template <class PointAt>
void TargetSpace::take(std::size_t count, const PointAt& point_at) {
    vcg::Box3d box;
    std::size_t not_finite = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const vcg::Point3d p = point_at(i);
        // p - p is 0 for finite p only; a sum would overflow for coordinates near the end of the range.
        if (((p - p) == vcg::Point3d(0, 0, 0))) {
            box.Add(p);
        } else {
            ++not_finite;
        }
    }
    set_frame(box, not_finite, count);
    centre_on(box_of_most(count, point_at));
    positions_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) positions_.push_back(frame_.inside(point_at(i)));
}

/// The box, along each axis, of the middle nine tenths of a thousand of the points.
template <class PointAt>
vcg::Box3d TargetSpace::box_of_most(std::size_t count, const PointAt& point_at) {
    constexpr std::size_t kLooked = 1000;
    const std::size_t stride = count / kLooked + 1;
    vcg::Box3d box;
    for (int k = 0; k < 3; ++k) {
        std::vector<double> along;
        for (std::size_t i = 0; i < count; i += stride) along.push_back(vcg::Point3d(point_at(i))[k]);
        std::sort(along.begin(), along.end());
        const std::size_t end = along.size() / 20;
        box.min[k] = along[end];
        box.max[k] = along[along.size() - 1 - end];
    }
    return box;
}

}  // namespace neuralmesh
