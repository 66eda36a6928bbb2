// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Pairs of faces from a tree of boxes, then vcglib's test of two triangles.
#include "vcg_core/mesh/self_crossings.h"

#include <vcg/space/intersection/triangle_triangle3.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>

#include "vcg_core/base/parallel_for.h"

namespace neuralmesh {

namespace {

constexpr std::size_t kChunk = 128;

/// Six times the signed volume of the tetrahedron a b c d.
float volume(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    return area_vector(a, b, c).dot(d - a);
}

/// Whether the segment p-q goes through the triangle a b c, not merely along its plane. Without tolerances,
/// so the answer does not depend on the scale.
bool goes_through(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b, const Vector3& c) {
    const float at_p = volume(a, b, c, p);
    const float at_q = volume(a, b, c, q);
    // Not by the sign of their product, which may be too small for float.
    if (!((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0))) return false;
    const float u = volume(p, q, a, b);
    const float v = volume(p, q, b, c);
    const float w = volume(p, q, c, a);
    return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

/// A face smaller than this, and what it meets, get an origin and a unit of their own for vcglib's test,
/// which multiplies up to nine lengths: of edges of 2e-5 nothing is left in float. Larger ones it can do
/// where they are.
constexpr float kSmall = 0x1p-10F;

float extent(const Vector3& a, const Vector3& b, const Vector3& c) {
    return (b - a).cwiseAbs().cwiseMax((c - a).cwiseAbs()).maxCoeff();
}

/// Both faces have an area, so the unit is a number that float has the inverse of.
bool have_common_point(const Surface& surface, int f, int g) {
    std::array<Vector3, 6> corners;
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = surface.corner(f, k);
        corners[k + 3] = surface.corner(g, k);
    }
    if (std::min(extent(corners[0], corners[1], corners[2]), extent(corners[3], corners[4], corners[5])) <
        kSmall) {
        const Vector3 origin = corners[0];
        float reach = 0;
        for (Vector3& c : corners) {
            c -= origin;
            reach = std::max(reach, c.cwiseAbs().maxCoeff());
        }
        // A power of two, which changes no digits.
        for (Vector3& c : corners) c *= std::ldexp(1.0F, -std::ilogb(reach));
    }
    const auto corner = [&](std::size_t k) { return to_vcg(corners[k]); };
    return vcg::NoDivTriTriIsect(corner(0), corner(1), corner(2), corner(3), corner(4), corner(5));
}

bool cut_each_other(const Surface& surface, int f, int g) {
    const Triangle& s = surface.faces[index(f)];
    const Triangle& t = surface.faces[index(g)];
    int common = 0;
    std::size_t in_s = 0;
    std::size_t in_t = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (s[i] == t[j]) {
                ++common;
                in_s = i;
                in_t = j;
            }
    if (common > 1) return false;
    const auto corner = [&](int face, std::size_t k) -> const Vector3& {
        return surface.corner(face, k % 3);
    };
    if (common == 1)
        return goes_through(corner(f, in_s + 1), corner(f, in_s + 2), corner(g, 0), corner(g, 1),
                            corner(g, 2)) ||
               goes_through(corner(g, in_t + 1), corner(g, in_t + 2), corner(f, 0), corner(f, 1),
                            corner(f, 2));
    return have_common_point(surface, f, g);
}

/// In float; what has none can cut nothing, and where vertices share their places there are many.
bool has_area(const Surface& surface, int f) { return area_vector(surface, f) != Vector3(0, 0, 0); }

std::size_t faces_of(const std::vector<Crossing>& crossings) {
    std::vector<Triangle> faces;
    for (const Crossing& c : crossings) {
        faces.push_back({c[0], c[1], c[2]});
        faces.push_back({c[3], c[4], c[5]});
    }
    std::sort(faces.begin(), faces.end());
    return static_cast<std::size_t>(std::unique(faces.begin(), faces.end()) - faces.begin());
}

/// Notes the crossing of two faces, if they cross.
void note(const Surface& surface, int f, int g, std::vector<Crossing>& crossings) {
    if (!cut_each_other(surface, std::min(f, g), std::max(f, g))) return;
    Triangle s = surface.faces[index(f)];
    Triangle t = surface.faces[index(g)];
    std::sort(s.begin(), s.end());
    std::sort(t.begin(), t.end());
    if (t < s) std::swap(s, t);
    crossings.push_back({s[0], s[1], s[2], t[0], t[1], t[2]});
}

/// All that \p find(face, crossings) notes for the faces, sorted.
template <class Find>
std::vector<Crossing> sorted_crossings(std::size_t faces, ThreadTeam& team, const Find& find) {
    std::vector<std::vector<Crossing>> found((faces + kChunk - 1) / kChunk);
    for_chunks(faces, kChunk, team, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) find(i, found[chunk]);
    });
    std::vector<Crossing> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end());
    return all;
}

/// Whether \p surface has the face, whichever way round.
bool has_face(const Surface& surface, const Triangle& face) {
    if (index(face[0]) >= surface.at.size()) return false;
    const auto begin = surface.face_of.begin();
    return std::any_of(begin + surface.first_face[index(face[0])],
                       begin + surface.first_face[index(face[0]) + 1], [&](int f) {
                           const Triangle& t = surface.faces[index(f)];
                           const auto in_t = [&](VertexId v) { return v == t[0] || v == t[1] || v == t[2]; };
                           return in_t(face[1]) && in_t(face[2]);
                       });
}

/// Whether both have the face, at the same place.
bool have_same_face(const Surface& a, const Surface& b, const Triangle& face) {
    return has_face(a, face) && has_face(b, face) && std::all_of(face.begin(), face.end(), [&](VertexId v) {
               return a.at[index(v)] == b.at[index(v)];
           });
}

}  // namespace

std::vector<Crossing> crossings_of(const Surface& surface, ThreadTeam& team, std::int64_t* pairs_looked_at) {
    std::vector<int> faces;
    for (int f = 0; f < static_cast<int>(surface.faces.size()); ++f)
        if (has_area(surface, f)) faces.push_back(f);
    const std::size_t count = faces.size();
    const FaceTree tree(surface, std::move(faces));
    std::atomic<std::int64_t> looked_at{0};
    std::vector<Crossing> all =
        sorted_crossings(count, team, [&](std::size_t i, std::vector<Crossing>& found) {
            std::int64_t near = 0;
            tree.for_overlapping(i, [&](int f, int g) {
                ++near;
                note(surface, f, g, found);
            });
            looked_at += near;
        });
    if (pairs_looked_at != nullptr) *pairs_looked_at = looked_at;
    return all;
}

std::vector<Crossing> crossings_after(const Surface& surface, const Surface& before,
                                      const std::vector<Crossing>& known, ThreadTeam& team) {
    std::vector<int> changed;
    std::vector<char> is_changed(surface.faces.size(), 0);
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        if (have_same_face(surface, before, surface.faces[f])) continue;
        is_changed[f] = 1;
        if (has_area(surface, static_cast<int>(f))) changed.push_back(static_cast<int>(f));
    }
    const FaceTree tree(surface, changed);
    const auto find = [&](std::size_t i, std::vector<Crossing>& found) {
        const int f = static_cast<int>(i);
        if (!has_area(surface, f)) return;
        tree.for_overlapping(surface, f, [&](int g) {
            // Two changed faces meet twice, and each meets itself.
            if (is_changed[i] == 0 || f < g) note(surface, f, g, found);
        });
    };
    std::vector<Crossing> all = sorted_crossings(surface.faces.size(), team, find);
    const auto found = static_cast<std::ptrdiff_t>(all.size());
    for (const Crossing& c : known)
        if (have_same_face(surface, before, {c[0], c[1], c[2]}) &&
            have_same_face(surface, before, {c[3], c[4], c[5]}))
            all.push_back(c);
    std::inplace_merge(all.begin(), all.begin() + found, all.end());
    return all;
}

CrossingGuard::CrossingGuard(std::vector<Crossing> standing)
    : standing_(std::move(standing)), most_faces_(faces_of(standing_)) {}

std::vector<VertexId> CrossingGuard::objections(std::vector<Crossing> now) {
    std::vector<Crossing> added;
    std::set_difference(now.begin(), now.end(), standing_.begin(), standing_.end(),
                        std::back_inserter(added));
    std::vector<VertexId> result;
    if (added.empty() || faces_of(now) <= most_faces_) {
        standing_ = std::move(now);
    } else {
        for (const Crossing& crossing : added) result.insert(result.end(), crossing.begin(), crossing.end());
    }
    return result;
}

}  // namespace neuralmesh
