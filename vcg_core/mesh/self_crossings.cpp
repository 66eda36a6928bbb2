// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A bounding-volume hierarchy gives the pairs of faces, vcglib's triangle-triangle test judges them.
#include "vcg_core/mesh/self_crossings.h"

#include <vcg/space/intersection/triangle_triangle3.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {

namespace {

constexpr int kCrossingChunk = 128;

/// Six times the signed volume of the tetrahedron a b c d.
float volume(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    return area_vector(a, b, c).dot(d - a);
}

/// vcglib's test multiplies up to nine lengths, which underflows in float for edges of about 2e-5. If one of
/// the two faces is smaller than this, both are moved to the origin and scaled up for the test.
constexpr float kSmall = 0x1p-10F;

float extent(const Vector3& a, const Vector3& b, const Vector3& c) {
    return (b - a).cwiseAbs().cwiseMax((c - a).cwiseAbs()).maxCoeff();
}

/// For faces without a common corner. Both must have an area.
bool intersect(const Surface& surface, int f, int g) {
    std::array<Vector3, 6> corners;
    for (int k = 0; k < 3; ++k) {
        corners[static_cast<std::size_t>(k)] = surface.corner(f, k);
        corners[static_cast<std::size_t>(k + 3)] = surface.corner(g, k);
    }
    if (std::min(extent(corners[0], corners[1], corners[2]), extent(corners[3], corners[4], corners[5])) <
        kSmall) {
        const Vector3 shift = corners[0];
        float largest = 0;
        for (Vector3& c : corners) {
            c -= shift;
            largest = std::max(largest, c.cwiseAbs().maxCoeff());
        }
        // A power of two, which keeps all digits.
        for (Vector3& c : corners) c *= std::ldexp(1.0F, -std::ilogb(largest));
    }
    const auto corner = [&](std::size_t k) { return to_vcg(corners[k]); };
    return vcg::NoDivTriTriIsect(corner(0), corner(1), corner(2), corner(3), corner(4), corner(5));
}

/// The faces of a surface with their area vectors, which each of them needs for several others.
class Faces {
public:
    Faces(const Surface& surface, ThreadTeam& team) : surface_(surface), area_vectors_(surface.face_count()) {
        parallel_for(surface.face_count(), kCrossingChunk, team,
                     [&](int f) { area_vectors_[f] = area_vector(surface, f); });
    }

    /// A face without area cuts nothing; where many vertices coincide there are many of them.
    bool has_area(int f) const { return area_vectors_[f] != Vector3(0, 0, 0); }

    /// Appends the crossing of the faces \p f and \p g, if they cross.
    void append_crossing(int f, int g, std::vector<SelfCrossing>& crossings) const {
        if (!cut_each_other(std::min(f, g), std::max(f, g))) return;
        Triangle s = surface_.faces[f];
        Triangle t = surface_.faces[g];
        std::sort(s.begin(), s.end());
        std::sort(t.begin(), t.end());
        if (t < s) std::swap(s, t);
        crossings.push_back({s[0], s[1], s[2], t[0], t[1], t[2]});
    }

private:
    bool cut_each_other(int f, int g) const {
        const Triangle& s = surface_.faces[f];
        const Triangle& t = surface_.faces[g];
        int common = 0;
        int in_s = 0;
        int in_t = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (s[static_cast<std::size_t>(i)] == t[static_cast<std::size_t>(j)]) {
                    ++common;
                    in_s = i;
                    in_t = j;
                }
        if (common > 1) return false;
        if (common == 1)
            return opposite_edge_goes_through(f, in_s, g) || opposite_edge_goes_through(g, in_t, f);
        return intersect(surface_, f, g);
    }

    /// Whether the edge opposite to corner \p k of face \p f goes through face \p g, rather than along its
    /// plane. Without tolerances, so the answer does not depend on the scale.
    bool opposite_edge_goes_through(int f, int k, int g) const {
        const Vector3& p = surface_.corner(f, (k + 1) % 3);
        const Vector3& q = surface_.corner(f, (k + 2) % 3);
        const Vector3& a = surface_.corner(g, 0);
        const float at_p = area_vectors_[g].dot(p - a);
        const float at_q = area_vectors_[g].dot(q - a);
        // The product of the two could underflow, so compare the signs.
        if (!((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0))) return false;
        const Vector3& b = surface_.corner(g, 1);
        const Vector3& c = surface_.corner(g, 2);
        const float u = volume(p, q, a, b);
        const float v = volume(p, q, b, c);
        const float w = volume(p, q, c, a);
        return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
    }

    const Surface& surface_;
    PerFace<Vector3> area_vectors_;
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

std::vector<SelfCrossing> self_crossings(const Surface& surface, ThreadTeam& team,
                                         std::int64_t* tested_pairs) {
    const Faces faces(surface, team);
    std::vector<int> with_area;
    for (int f = 0; f < surface.face_count(); ++f)
        if (faces.has_area(f)) with_area.push_back(f);
    const FaceTree tree(surface, std::move(with_area), team);
    std::atomic<std::int64_t> tested{0};
    const auto find = [&](int group, std::vector<SelfCrossing>& found) {
        std::int64_t pairs = 0;
        tree.for_overlapping_pairs(group, [&](int f, int g) {
            ++pairs;
            faces.append_crossing(f, g, found);
        });
        tested += pairs;
    };
    std::vector<SelfCrossing> all =
        parallel_collect<SelfCrossing>(tree.group_count(), kCrossingChunk, team, find);
    std::sort(all.begin(), all.end());
    if (tested_pairs != nullptr) *tested_pairs = tested;
    return all;
}

std::vector<SelfCrossing> update_self_crossings(const Surface& surface, const Surface& before,
                                                const std::vector<SelfCrossing>& known, ThreadTeam& team) {
    const CommonFaces common(surface, before);
    const Faces faces(surface, team);
    PerFace<char> is_changed(surface.face_count(), 0);
    const auto examine = [&](int f, std::vector<int>& changed) {
        if (common.contain(surface.faces[f])) return;
        is_changed[f] = 1;
        if (faces.has_area(f)) changed.push_back(f);
    };
    std::vector<int> changed = parallel_collect<int>(surface.face_count(), kCrossingChunk, team, examine);
    const FaceTree tree(surface, std::move(changed), team);
    const auto find = [&](int f, std::vector<SelfCrossing>& found) {
        if (!faces.has_area(f)) return;
        tree.for_overlapping(surface, f, [&](int g) {
            // Two changed faces meet twice, and each meets itself.
            if (is_changed[f] == 0 || f < g) faces.append_crossing(f, g, found);
        });
    };
    std::vector<SelfCrossing> all =
        parallel_collect<SelfCrossing>(surface.face_count(), kCrossingChunk, team, find);
    std::sort(all.begin(), all.end());
    const auto found = static_cast<std::ptrdiff_t>(all.size());
    for (const SelfCrossing& c : known)
        if (common.contain({c[0], c[1], c[2]}) && common.contain({c[3], c[4], c[5]})) all.push_back(c);
    std::inplace_merge(all.begin(), all.begin() + found, all.end());
    return all;
}

}  // namespace neuralmesh
