// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/mesh/exact_cuts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace neuralmesh {

namespace {

// In double, in which the signs of volumes of float corners are as good as exact.
using Corners = std::array<Eigen::Vector3d, 3>;

Corners corners_of(const Surface& surface, const SelfCrossing& crossing, std::size_t first) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = surface.positions[crossing[first + k]].cast<double>();
    return corners;
}

double largest(const Eigen::Vector3d& v) { return v.cwiseAbs().maxCoeff(); }

/// The height of \p p over the plane of \p t, times a positive number; 0 if rounding could have made its
/// sign.
double height(const Eigen::Vector3d& p, const Corners& t) {
    constexpr double kRounding = 1e-14;
    const Eigen::Vector3d a = t[1] - t[0], b = t[2] - t[0], c = p - t[0];
    const double height = a.cross(b).dot(c);
    return std::abs(height) > kRounding * largest(a) * largest(b) * largest(c) ? height : 0;
}

/// Whether the line through \p p and \p q, which crosses the plane of the triangle \p t, meets t.
bool meets(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Corners& t) {
    const Eigen::Vector3d along = q - p, a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double u = along.dot(a.cross(b)), v = along.dot(b.cross(c)), w = along.dot(c.cross(a));
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

/// Whether an edge of \p s goes through \p t. \param common the corner of s that is one of t, too, and whose
/// edges do not count; 3 if there is none
bool pierces(const Corners& s, const Corners& t, std::size_t common) {
    const std::array<double, 3> heights{height(s[0], t), height(s[1], t), height(s[2], t)};
    for (std::size_t k = 0; k < 3; ++k) {
        if (common < 3 && common != k) continue;
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        // The product of the two could underflow, so compare the signs.
        const bool opposite = (heights[i] < 0 && heights[j] > 0) || (heights[i] > 0 && heights[j] < 0);
        if (opposite && meets(s[i], s[j], t)) return true;
    }
    return false;
}

/// The place, from 0, of the corner among those of one face that the other has, too; 3 if there is none.
std::size_t common_corner(const SelfCrossing& crossing, std::size_t first, std::size_t other) {
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < 3; ++j)
            if (crossing[first + k] == crossing[other + j]) return k;
    return 3;
}

}  // namespace

void drop_apparent(const Surface& surface, std::vector<SelfCrossing>& crossings) {
    const auto is_apparent = [&](const SelfCrossing& crossing) {
        const Corners s = corners_of(surface, crossing, 0), t = corners_of(surface, crossing, 3);
        return !pierces(s, t, common_corner(crossing, 0, 3)) && !pierces(t, s, common_corner(crossing, 3, 0));
    };
    crossings.erase(std::remove_if(crossings.begin(), crossings.end(), is_apparent), crossings.end());
}

}  // namespace neuralmesh
