// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Takes faces that cut others away from a surface with boundary.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "vcg_core/fit/sound_meshes.h"

namespace neuralmesh {

namespace {

/// Most faces that go together. A boundary that pierces a sheet does so by a few; more would be surface.
constexpr std::size_t kMostTogether = 12;
/// One face in so many may go in all.
constexpr int kKeptPerGone = 10;

/// What is removed to be rid of a self-intersection. What is first here is tried first, and again after every
/// removal.
enum class Removal {
    boundary_faces,  ///< faces along the boundary that leave loops, genus and components as they are
    folds,           ///< vertices in a fold, by half-edge collapses, which keep the topology, too
    any_faces,       ///< also across strands of surface, whose ends then are apart, or leaving holes
};

/// By their sorted corners.
using Faces = std::set<Triangle>;

Triangle sorted(Triangle face) {
    std::sort(face.begin(), face.end());
    return face;
}

/// The face between neighbours i and i + 1 of \p v, sorted.
Triangle face_at(const Network& network, VertexId v, int i) {
    const Ring& ring = network.ring(v);
    return sorted({v, ring[i], ring.next(i)});
}

/// The face with these corners, sorted, in the orientation of the network; nothing if there is none.
std::optional<Triangle> find_face(const Network& network, const Triangle& corners) {
    if (!network.alive(corners[0])) return {};
    const Ring& ring = network.ring(corners[0]);
    for (int i = 0; i < ring.face_count(); ++i)
        if (face_at(network, corners[0], i) == corners) return Triangle{corners[0], ring[i], ring.next(i)};
    return {};
}

/// The faces around \p v that are not \p gone, by the fans that they form.
std::vector<std::vector<Triangle>> fans_left(const Network& network, VertexId v, const Faces& gone) {
    std::vector<std::vector<Triangle>> fans;
    const int count = network.ring(v).face_count();
    const auto is_gone = [&](int i) { return gone.count(face_at(network, v, i)) > 0; };
    for (int i = 0; i < count; ++i) {
        if (is_gone(i)) continue;
        if (i == 0 || is_gone(i - 1)) fans.emplace_back();
        fans.back().push_back(face_at(network, v, i));
    }
    const bool is_cycle = network.ring(v).open == 0 && fans.size() > 1 && !is_gone(0) && !is_gone(count - 1);
    if (is_cycle) {
        fans.front().insert(fans.front().end(), fans.back().begin(), fans.back().end());
        fans.pop_back();
    }
    return fans;
}

/// Adds to \p gone what it would cut off at the corners of its faces: all fans but the largest. \return
/// whether there was any
bool add_lesser_fans(const Network& network, Faces& gone) {
    std::set<VertexId> corners;
    for (const Triangle& face : gone) corners.insert(face.begin(), face.end());
    const std::size_t before = gone.size();
    for (const VertexId v : corners) {
        std::vector<std::vector<Triangle>> fans = fans_left(network, v, gone);
        if (fans.size() < 2) continue;
        const auto larger = [](const auto& a, const auto& b) { return a.size() < b.size(); };
        fans.erase(std::max_element(fans.begin(), fans.end(), larger));
        for (const std::vector<Triangle>& fan : fans) gone.insert(fan.begin(), fan.end());
    }
    return gone.size() > before;
}

/// The face and all that has to go with it, so that what is left is a manifold; nothing if that is too much.
Faces with_lesser_fans(const Network& network, const Triangle& face) {
    Faces gone{face};
    while (gone.size() <= kMostTogether)
        if (!add_lesser_fans(network, gone)) return gone;
    return {};
}

int corners_on_boundary(const Network& network, const Triangle& face) {
    return static_cast<int>(
        std::count_if(face.begin(), face.end(), [&](VertexId v) { return network.ring(v).open != 0; }));
}

float perimeter(const Network& network, const Triangle& face) {
    const auto edge = [&](int i, int j) {
        return (network.position(face[i]) - network.position(face[j])).Norm();
    };
    return edge(0, 1) + edge(1, 2) + edge(2, 0);
}

/// Whether a corner of one face is one of the other, or next to one: the surface is folded there. Else two
/// sheets meet, and collapses would eat a hole into one of them.
bool are_close(const Network& network, const Triangle& first, const Triangle& second) {
    return std::any_of(first.begin(), first.end(), [&](VertexId a) {
        return std::any_of(second.begin(), second.end(),
                           [&](VertexId b) { return a == b || network.adjacent(a, b); });
    });
}

/// Of two faces in a fold, collapses the shortest edge that can be collapsed. \return the number of faces
/// removed
int collapse_shortest(Network& network, const Triangle& first, const Triangle& second) {
    if (!are_close(network, first, second)) return 0;
    float shortest = HUGE_VALF;
    VertexId best_gone = -1, best_kept = -1;
    for (const Triangle& face : {first, second})
        for (const VertexId gone : face)
            for (const VertexId kept : face) {
                if (gone == kept) continue;
                const float length = (network.position(gone) - network.position(kept)).SquaredNorm();
                if (!(length < shortest) || !network.can_collapse(gone, kept)) continue;
                shortest = length;
                best_gone = gone;
                best_kept = kept;
            }
    if (best_gone < 0) return 0;
    const Ring& kept = network.ring(best_kept);
    const bool along_boundary =
        kept.open != 0 && (kept[0] == best_gone || kept[kept.valence - 1] == best_gone);
    network.collapse(best_gone, best_kept);
    return along_boundary ? 1 : 2;
}

/// \return the number of faces removed with the one given by its sorted corners
int remove_face(Network& network, const Triangle& face, Removal kind) {
    const bool keeps_topology = kind == Removal::boundary_faces;
    if (keeps_topology && corners_on_boundary(network, face) == 0) return 0;
    std::vector<Triangle> oriented;
    for (const Triangle& f : with_lesser_fans(network, face)) oriented.push_back(*find_face(network, f));
    if (oriented.empty() || !network.can_exchange_faces(oriented, {})) return 0;
    const Network before = network;
    network.exchange_faces(oriented, {});
    // With the Euler characteristic loops and components stay: the boundary changes only where the faces
    // were.
    if (!keeps_topology || network.euler_characteristic() == before.euler_characteristic())
        return static_cast<int>(oriented.size());
    network = before;
    return 0;
}

/// A face, or what goes with it, of every intersection whose faces are still there. \return the number of
/// faces removed
int remove_once(Network& network, const std::vector<SelfIntersection>& intersections, Removal kind,
                int most_faces) {
    int removed = 0;
    for (const SelfIntersection& intersection : intersections) {
        if (removed >= most_faces) break;
        Triangle first{intersection[0], intersection[1], intersection[2]},
            second{intersection[3], intersection[4], intersection[5]};
        if (!find_face(network, first) || !find_face(network, second)) continue;
        const auto rank = [&](const Triangle& face) {
            return std::pair(corners_on_boundary(network, face), perimeter(network, face));
        };
        if (rank(second) > rank(first)) std::swap(first, second);
        if (kind == Removal::folds) {
            removed += collapse_shortest(network, first, second);
            continue;
        }
        const int done = remove_face(network, first, kind);
        removed += done > 0 ? done : remove_face(network, second, kind);
    }
    return removed;
}

}  // namespace

int remove_cut_faces(Network& network, std::vector<SelfIntersection>& intersections, ThreadTeam& team) {
    constexpr std::array<Removal, 3> kInOrder{Removal::boundary_faces, Removal::folds, Removal::any_faces};
    const int most_faces = network.face_count() / kKeptPerGone;
    Surface surface(network);
    int removed = 0;
    for (std::size_t level = 0; level < kInOrder.size() && !intersections.empty();) {
        const int now = remove_once(network, intersections, kInOrder[level], most_faces - removed);
        removed += now;
        level = now > 0 ? 0 : level + 1;
        if (now == 0) continue;
        const Surface before = std::exchange(surface, Surface(network));
        intersections = update_self_intersections(surface, before, intersections, team);
    }
    return removed;
}

}  // namespace neuralmesh
