// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How much surface each point of an uneven cloud stands for, and numbers drawn in proportion to it.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/cloud/cloud_survey.h"

namespace neuralmesh {

/// A cloud in an order in which points near in space mostly come near, and the area that each stands for. One
/// area holds for a run of kRun consecutive points: the squared spacing there.
struct PointAreas {
    static constexpr std::size_t kRun = CloudSurvey::kRun;

    std::vector<vcg::Point3f> points;
    std::vector<float> of_run;  ///< area per point; 1 in the mean over the points
};

/// The areas of the points of \p survey; nothing if their density is even but for chance, or if they are too
/// few to tell. O(n).
std::optional<PointAreas> areas_if_uneven(const CloudSurvey& survey);

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

}  // namespace neuralmesh
