// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A bounding-volume hierarchy gives the pairs of faces.
#include "vcg_core/mesh/self_intersections.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

namespace {

constexpr int kCrossingChunk = 128;

// In double, in which the signs of volumes of float corners are as good as exact.
using Corners = std::array<Eigen::Vector3d, 3>;

double largest(const Eigen::Vector3d& v) { return v.cwiseAbs().maxCoeff(); }

using Heights = std::array<double, 3>;

/// The heights of the corners of \p s over the plane of \p t, times a positive number; 0 where rounding could
/// have made the sign, as of faces that lie apart in one tilted plane.
Heights heights(const Corners& s, const Corners& t) {
    constexpr double kRounding = 1e-14;
    const Eigen::Vector3d a = t[1] - t[0], b = t[2] - t[0], normal = a.cross(b);
    const double rounding = kRounding * largest(a) * largest(b);
    Heights found;
    for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d c = s[k] - t[0];
        const double height = normal.dot(c);
        found[k] = std::abs(height) > rounding * largest(c) ? height : 0;
    }
    return found;
}

/// Whether all corners but \p common are on one side of the plane: then the faces meet there at most.
bool on_one_side(const Heights& height, std::size_t common) {
    int above = 0, below = 0, counted = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (k == common) continue;
        ++counted;
        above += height[k] > 0 ? 1 : 0;
        below += height[k] < 0 ? 1 : 0;
    }
    return above == counted || below == counted;
}

/// Whether the line through \p p and \p q, which crosses the plane of the triangle \p t, meets t.
bool meets(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Corners& t) {
    const Eigen::Vector3d along = q - p, a = t[0] - p, b = t[1] - p, c = t[2] - p;
    const double u = along.dot(a.cross(b)), v = along.dot(b.cross(c)), w = along.dot(c.cross(a));
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

/// Whether an edge of \p s, whose corners have that \p height over the plane of \p t, goes through t.
/// \param common the corner of s that is one of t, too, and whose edges do not count; 3 if there is none
bool pierces(const Corners& s, const Heights& height, const Corners& t, std::size_t common) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (common < 3 && common != k) continue;
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        // The product of the two could underflow, so compare the signs.
        const bool opposite = (height[i] < 0 && height[j] > 0) || (height[i] > 0 && height[j] < 0);
        if (opposite && meets(s[i], s[j], t)) return true;
    }
    return false;
}

class Faces {
public:
    explicit Faces(const Surface& surface) : surface_(surface) {}

    /// A face without area cuts nothing; where many vertices coincide there are many of them.
    bool has_area(int f) const { return area_vector(surface_, f) != Vector3(0, 0, 0); }

    /// Appends the intersection of the faces \p f and \p g, if they cross.
    void append_crossing(int f, int g, std::vector<SelfIntersection>& intersections) const {
        if (!cut_each_other(std::min(f, g), std::max(f, g))) return;
        Triangle s = surface_.faces[f];
        Triangle t = surface_.faces[g];
        std::sort(s.begin(), s.end());
        std::sort(t.begin(), t.end());
        if (t < s) std::swap(s, t);
        intersections.push_back({s[0], s[1], s[2], t[0], t[1], t[2]});
    }

private:
    Corners corners_of(int f) const {
        return {surface_.corner(f, 0).cast<double>(), surface_.corner(f, 1).cast<double>(),
                surface_.corner(f, 2).cast<double>()};
    }

    bool cut_each_other(int f, int g) const {
        const Triangle& s = surface_.faces[f];
        const Triangle& t = surface_.faces[g];
        int common = 0;
        std::size_t in_s = 3, in_t = 3;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                if (s[i] == t[j]) {
                    ++common;
                    in_s = i;
                    in_t = j;
                }
        if (common > 1) return false;
        const Corners of_f = corners_of(f), of_g = corners_of(g);
        const Heights over_g = heights(of_f, of_g);
        if (on_one_side(over_g, in_s)) return false;
        return pierces(of_f, over_g, of_g, in_s) || pierces(of_g, heights(of_g, of_f), of_f, in_t);
    }

    const Surface& surface_;
};

/// Whether \p surface has the face, in either orientation.
bool has_face(const Surface& surface, const Triangle& face) {
    if (face[0] >= surface.positions.size()) return false;
    const Span<const int> around = surface.faces_around(face[0]);
    return std::any_of(around.begin(), around.end(), [&](int f) {
        const Triangle& t = surface.faces[f];
        const auto in_t = [&](VertexId v) { return v == t[0] || v == t[1] || v == t[2]; };
        return in_t(face[1]) && in_t(face[2]);
    });
}

/// Tells which faces two surfaces have in common, at the same position.
class CommonFaces {
public:
    CommonFaces(const Surface& a, const Surface& b) : a_(a), b_(b), same_faces_(a.faces == b.faces) {}

    /// \param face of either surface
    bool contain(const Triangle& face) const {
        return (same_faces_ || (has_face(a_, face) && has_face(b_, face))) &&
               std::all_of(face.begin(), face.end(),
                           [&](VertexId v) { return a_.positions[v] == b_.positions[v]; });
    }

private:
    const Surface& a_;
    const Surface& b_;
    bool same_faces_;  ///< only vertices have moved
};

}  // namespace

std::vector<SelfIntersection> self_intersections(const Surface& surface, ThreadTeam& team,
                                                 std::int64_t* tested_pairs) {
    const Faces faces(surface);
    std::vector<int> with_area;
    for (int f = 0; f < surface.face_count(); ++f)
        if (faces.has_area(f)) with_area.push_back(f);
    const FaceTree tree(surface, std::move(with_area), team);
    std::atomic<std::int64_t> tested{0};
    const auto find = [&](int group, std::vector<SelfIntersection>& found) {
        std::int64_t pairs = 0;
        tree.for_overlapping_pairs(group, [&](int f, int g) {
            ++pairs;
            faces.append_crossing(f, g, found);
        });
        tested += pairs;
    };
    std::vector<SelfIntersection> all =
        parallel_collect<SelfIntersection>(tree.group_count(), kCrossingChunk, team, find);
    std::sort(all.begin(), all.end());
    if (tested_pairs != nullptr) *tested_pairs = tested;
    return all;
}

std::vector<SelfIntersection> update_self_intersections(const Surface& surface, const Surface& before,
                                                        const std::vector<SelfIntersection>& known,
                                                        ThreadTeam& team) {
    const CommonFaces common(surface, before);
    const Faces faces(surface);
    PerFace<char> is_changed(surface.face_count(), 0);
    const auto examine = [&](int f, std::vector<int>& changed) {
        if (common.contain(surface.faces[f])) return;
        is_changed[f] = 1;
        if (faces.has_area(f)) changed.push_back(f);
    };
    std::vector<int> changed = parallel_collect<int>(surface.face_count(), kCrossingChunk, team, examine);
    const FaceTree tree(surface, std::move(changed), team);
    const auto find = [&](int f, std::vector<SelfIntersection>& found) {
        if (!faces.has_area(f)) return;
        tree.for_overlapping(surface, f, [&](int g) {
            // Two changed faces meet twice, and each meets itself.
            if (is_changed[f] == 0 || f < g) faces.append_crossing(f, g, found);
        });
    };
    std::vector<SelfIntersection> all =
        parallel_collect<SelfIntersection>(surface.face_count(), kCrossingChunk, team, find);
    std::sort(all.begin(), all.end());
    const auto found = static_cast<std::ptrdiff_t>(all.size());
    for (const SelfIntersection& c : known)
        if (common.contain({c[0], c[1], c[2]}) && common.contain({c[3], c[4], c[5]})) all.push_back(c);
    std::inplace_merge(all.begin(), all.begin() + found, all.end());
    return all;
}

}  // namespace neuralmesh
