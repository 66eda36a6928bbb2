// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The target space Omega of the paper: the points or faces from which signals are drawn.
#pragma once

#include <vcg/space/box3.h>
#include <vcg/space/point3.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vcg_core/base/colors_and_normals.h"
#include "vcg_core/base/error.h"
#include "vcg_core/base/indexed.h"
#include "vcg_core/base/random.h"
#include "vcg_core/cloud/percentile_box.h"

namespace neuralmesh {

struct CloudSurvey;

/// Draws numbers with given probabilities in constant time (Walker 1974; built as by Vose, "A linear
/// algorithm for generating random numbers with a given distribution", 1991). Eight bytes per number.
class AliasTable {
public:
    AliasTable() = default;
    /// \param weights positive, fewer than 2^32; number i is drawn in proportion to weights[i]. O(n).
    explicit AliasTable(const std::vector<double>& weights);

    bool empty() const { return columns_.empty(); }
    /// A random number in [0, size of the weights). O(1), one draw of 32 bits. The probabilities are exact to
    /// about size / 2^32. \pre !empty()
    std::uint32_t draw(Random& random) const {
        const std::uint64_t product = std::uint64_t{random.bits()} * columns_.size();
        const auto number = static_cast<std::uint32_t>(product >> 32);
        const Column& column = columns_[number];
        return static_cast<std::uint32_t>(product) < column.own ? number : column.other;
    }

private:
    struct Column {
        std::uint32_t own;    ///< share of the column that is its own number, in 2^-32
        std::uint32_t other;  ///< the number of the rest
    };
    std::vector<Column> columns_;
};

/// The frame of the core: the centre of the bounding box is the origin, its diagonal has length 1. Converted
/// in double, so the precision of learning in float does not depend on the position and the size of the
/// cloud. If nearly all points lie in a box of less than a thousandth of the diagonal, the centre of that box
/// is the origin, because float has its highest resolution there.
struct Frame {
    vcg::Point3d centre{0, 0, 0};
    double diagonal = 1;

    /// From the frame of the input to this one.
    vcg::Point3f inside(const vcg::Point3d& p) const;
    /// From this frame to that of the input.
    vcg::Point3d outside(const vcg::Point3f& p) const;
};

/// Points, triangles weighted by area, or what a sampler draws. Memory: 12 bytes per point, or 44 bytes per
/// triangle; with colours 3 more per position, with normals another 3.
class TargetSpace {
public:
    /// A cloud. \p point_at(i), i in [0, count), returns point i as vcg::Point3d; it is called more than once
    /// per point. \throws InputError if there are no points, coordinates are not finite, fewer than 4 points
    /// are distinct, or all lie on a line. O(count)
    template <class PointAt>
    static TargetSpace points(std::size_t count, const PointAt& point_at);

    /// Triangles; a signal is uniform over their area. \p corner_at(i, k), i in [0, count), k in 0..2,
    /// returns corner k of triangle i. \throws InputError as points(), and if the total area is 0. O(count)
    template <class CornerAt>
    static TargetSpace triangles(std::size_t count, const CornerAt& corner_at);

    using Sampler = std::function<vcg::Point3d(Random&)>;

    /// What \p draw returns, such as random points of an implicit surface: every signal is a new one. The
    /// start mesh, the fit and the error use \p count points that are drawn first, at least two for every
    /// vertex asked for. They count as exact, like those of faces: none is left out or weighted. \p draw
    /// must return finite points, must not throw, and must depend on its argument alone; it is called from
    /// one thread at a time, but not always from the same one. \throws InputError as points(). O(count)
    static TargetSpace drawn_by(Sampler draw, std::size_t count = 200000);

    /// Gives every one of positions() a colour. The targets made of this one keep them; of repeated points
    /// the first given counts. \pre there are as many as positions()
    void set_colors(std::vector<Color> colors) { colors_ = std::move(colors); }

    /// Gives every one of positions() a normal; kNoNormal: it has none. All of them none: the cloud has no
    /// normals. The targets made of this one keep them, as colours. \pre there are as many as positions(),
    /// and !has_faces()
    void set_normals(std::vector<PackedNormal> normals);

    /// Tells how far single precision has rounded coordinates, see rounded_coordinates.h. The targets made of
    /// this one do not keep it.
    void set_rounding(double step) { rounding_ = step; }
    /// In the units of the input; 0: not, or too little to matter.
    double rounding() const { return rounding_; }

    /// A random point, in the frame of the core: what the sampler draws, uniform over the points, in
    /// proportion to their weights, or uniform over the area of the triangles. O(1) for points, O(log n) for
    /// n triangles.
    vcg::Point3f sample(Random& random) const;
    /// Makes \p samples what \p count calls of sample() would return. Points that do not fit into the cache
    /// take a quarter of the time, because reading one does not wait for the one before.
    void sample(Random& random, int count, std::vector<vcg::Point3f>& samples) const;

    struct ColoredPoint {
        vcg::Point3f position;
        vcg::Point3f color;  ///< 0 to 255; of faces interpolated between their corners
    };
    /// A random point of the faces with its colour. O(log faces). \pre has_faces() and has_colors()
    ColoredPoint sample_colored(Random& random) const;

    /// The cloud without the points i with left_out[i] != 0, in a frame of its own; nothing if the remaining
    /// points span no surface. O(points). \pre !has_faces()
    std::optional<TargetSpace> without(const std::vector<std::uint8_t>& left_out) const;

    using Move = std::function<vcg::Point3f(const vcg::Point3f&)>;

    /// The same target with every signal p at \p move(p), in the same frame. positions() stays as it is.
    /// \p move is called from several threads at a time. O(points) \pre is_exact()
    TargetSpace moved(Move move) const;
    /// The cloud with its points moved by \p move, which gets many of them at a time, in the same order and
    /// the same frame. O(points) \pre !is_exact()
    TargetSpace moved_in_batches(const std::function<void(Span<vcg::Point3f>)>& move) const;

    /// The cloud without duplicate points, in the same frame, if more than a tenth of the points are exact
    /// duplicates; nothing otherwise, or for triangles. O(points log points)
    std::optional<TargetSpace> each_place_once() const;

    /// The cloud with weights by which signals are even over the surface, in another order and the same
    /// frame, if its density is uneven. Nothing otherwise. O(points). \pre \p survey is
    /// that of positions(), and !has_faces()
    std::optional<TargetSpace> evenly(const CloudSurvey& survey) const;
    bool is_weighted() const { return !weights_.empty(); }
    /// The area that point \p i stands for; 1 in the mean. \pre !has_faces()
    float weight(std::size_t i) const;

    const Frame& frame() const { return frame_; }
    bool has_faces() const { return !cumulative_area_.empty(); }
    /// Whether every point is one of the surface: it was drawn from faces or by a sampler.
    bool is_exact() const { return has_faces() || sampler_ != nullptr; }
    /// The points, or three corners per triangle, in the frame of the core.
    const std::vector<vcg::Point3f>& positions() const { return positions_; }
    bool has_colors() const { return !colors_.empty(); }
    /// Of positions(); empty if there are none.
    const std::vector<Color>& colors() const { return colors_; }
    bool has_normals() const { return !normals_.empty(); }
    /// Of positions(), as they were given, which may be to either side; empty if there are none.
    const std::vector<PackedNormal>& normals() const { return normals_; }

private:
    template <class PointAt>
    void take(std::size_t count, const PointAt& point_at);
    void centre_on(const vcg::Box3d& most);
    void set_frame(const vcg::Box3d& box, std::size_t not_finite, std::size_t count);
    /// A sentence if the points span no surface, empty if they do.
    std::string lack_of_spread() const;
    void check_spread() const;
    void accumulate_areas();
    /// A point of a face: its first corner, and coordinates along the two edges from there.
    struct FacePoint {
        std::size_t corner;
        float u, v;
    };
    FacePoint draw_from_faces(Random& random) const;
    /// The index of a random point, see sample().
    std::size_t draw_point(Random& random) const;
    vcg::Point3f draw_exact(Random& random) const;

    Frame frame_;
    bool off_centre_ = false;  ///< the origin is the centre of most points, not of the box
    std::vector<vcg::Point3f> positions_;
    std::vector<double> cumulative_area_;
    std::vector<float> weights_;         ///< of the runs of points; empty: all points weigh 1
    AliasTable runs_;                    ///< draws runs
    std::vector<Color> colors_;          ///< of the positions; may be empty
    std::vector<PackedNormal> normals_;  ///< the same
    double rounding_ = 0;
    Sampler sampler_;  ///< may be empty
    Move move_;        ///< of exact signals; may be empty
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
        // p - p is 0 for finite p only; a sum of finite coordinates could overflow.
        if ((p - p) == vcg::Point3d(0, 0, 0)) {
            box.Add(p);
        } else {
            ++not_finite;
        }
    }
    set_frame(box, not_finite, count);
    centre_on(percentile_box(count, point_at));
    positions_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) positions_.push_back(frame_.inside(point_at(i)));
}

}  // namespace neuralmesh
