// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Networks and target spaces of shapes and clouds, and slow and simple checks of meshes from their lists of
// faces.
#pragma once

#include <vcg/space/point3.h>

#include <algorithm>
#include <limits>
#include <map>
#include <ostream>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/unit/support/shapes.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/mesh/surface.h"

namespace neuralmesh {

/// Of a surface; two are equal only if both are whole.
struct Topology {
    int components, genus, loops;
    std::string breach{};

    bool operator==(const Topology& other) const {
        return std::tie(components, genus, loops, breach) ==
               std::tie(other.components, other.genus, other.loops, other.breach);
    }
    friend std::ostream& operator<<(std::ostream& out, const Topology& t) {
        return out << t.components << " components of genus " << t.genus << ", " << t.loops << " boundaries. "
                   << t.breach;
    }
};
inline const Topology kBall{1, 0, 0}, kRing{1, 1, 0}, kDisc{1, 0, 1};

inline Topology topology_of(const Network& network) {
    return {network.component_count(), network.genus(), network.boundary_loop_count(), network.validate()};
}

/// The shape as a network, every vertex moved by up to \p noise.
inline Network network_of(const Shape& shape, double noise = 0, std::uint64_t seed = 3) {
    Random random(seed);
    std::vector<vcg::Point3f> positions;
    for (const vcg::Point3d& p : shape.positions)
        positions.push_back(vcg::Point3f::Construct(p + shapes::in_ball(random) * noise));
    return {positions, shape.faces};
}

inline TargetSpace target_of(const Cloud& cloud) {
    return TargetSpace::points(cloud.size(), [&](std::size_t i) { return cloud[i]; });
}

/// Signals are drawn from the faces.
inline TargetSpace target_of(const Shape& shape) {
    return TargetSpace::triangles(shape.faces.size(), [&](std::size_t i, int k) {
        return shape.positions[static_cast<std::size_t>(shape.faces[i][static_cast<std::size_t>(k)])];
    });
}

/// The shape, in the coordinates of the cloud, as a network in the frame of \p target. Every vertex is moved
/// by up to \p noise, in diagonals of the target's bounding box.
inline Network network_in_frame(const TargetSpace& target, Shape shape, double noise = 0) {
    for (vcg::Point3d& p : shape.positions) p = vcg::Point3d::Construct(target.frame().inside(p));
    return network_of(shape, noise);
}

inline std::vector<vcg::Point3f> positions_of(const Network& network) {
    std::vector<vcg::Point3f> positions;
    for (const VertexId v : network.vertices()) positions.push_back(network.position(v));
    return positions;
}

/// An id, of a vertex or of none.
inline VertexId any_slot(const Network& network, Random& random) {
    return static_cast<VertexId>(random.below(static_cast<std::uint32_t>(network.slot_count())));
}

/// The sorted faces, each rotated to start with its smallest vertex: equal for equal meshes.
inline std::vector<Triangle> canonical(std::vector<Triangle> faces) {
    for (Triangle& f : faces) std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    std::sort(faces.begin(), faces.end());
    return faces;
}

/// Counts and topology of a list of faces.
struct Census {
    std::string breach;  ///< empty if the faces form an oriented 2-manifold with or without boundary
    int vertices = 0;
    int edges = 0;
    int faces = 0;
    int components = 0;
    int loops = 0;
    std::map<VertexId, int> valence;

    int euler() const { return vertices - edges + faces; }
    int greatest_valence() const {
        int most = 0;
        for (const auto& entry : valence) most = std::max(most, entry.second);
        return most;
    }
    bool same_topology(const Census& other) const {
        return euler() == other.euler() && components == other.components && loops == other.loops;
    }
};

/// The number of connected components of \p graph.
inline int connected_parts(const std::map<VertexId, std::set<VertexId>>& graph) {
    std::set<VertexId> seen;
    int parts = 0;
    for (const auto& entry : graph) {
        if (!seen.insert(entry.first).second) continue;
        ++parts;
        std::vector<VertexId> open{entry.first};
        while (!open.empty()) {
            const VertexId v = open.back();
            open.pop_back();
            for (const VertexId w : graph.at(v))
                if (seen.insert(w).second) open.push_back(w);
        }
    }
    return parts;
}

/// The graph of the edges that only one face contains, given all directed edges of the faces.
inline std::map<VertexId, std::set<VertexId>> boundary_of(
    const std::set<std::pair<VertexId, VertexId>>& directed) {
    std::map<VertexId, std::set<VertexId>> boundary;
    for (const auto& [from, to] : directed) {
        if (directed.count({to, from}) != 0) continue;
        boundary[from].insert(to);
        boundary[to].insert(from);
    }
    return boundary;
}

inline Census census(const std::vector<Triangle>& faces) {
    Census result;
    std::set<std::pair<VertexId, VertexId>> directed;
    std::map<VertexId, std::set<VertexId>> neighbours;
    std::map<VertexId, std::map<VertexId, std::set<VertexId>>> links;
    for (const Triangle& f : faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = f[k];
            const VertexId b = f[(k + 1) % 3];
            const VertexId c = f[(k + 2) % 3];
            if (a == b) result.breach = "a face has a corner twice";
            if (!directed.emplace(a, b).second)
                result.breach = "two faces run along an edge in one direction";
            neighbours[a].insert(b);
            neighbours[b].insert(a);
            links[a][b].insert(c);
            links[a][c].insert(b);
        }
    }
    const auto boundary = boundary_of(directed);
    int ends = 0;
    for (const auto& [v, around] : neighbours) {
        const auto valence = static_cast<int>(around.size());
        ends += valence;
        result.valence[v] = valence;
        if (connected_parts(links[v]) != 1) result.breach = "the faces at a vertex form no single fan";
        if (valence < (boundary.count(v) != 0 ? 2 : 3)) result.breach = "a valence is too low";
    }
    result.vertices = static_cast<int>(neighbours.size());
    result.edges = ends / 2;
    result.faces = static_cast<int>(faces.size());
    result.components = connected_parts(neighbours);
    result.loops = connected_parts(boundary);
    return result;
}

/// A corner of a face of a mesh with vectors of positions and faces.
template <class Mesh>
vcg::Point3d corner(const Mesh& mesh, const Triangle& face, std::size_t k) {
    return vcg::Point3d::Construct(mesh.positions[static_cast<std::size_t>(face[k % 3])]);
}

/// At right angles to a face, towards its outside; its length is the area.
template <class Mesh>
vcg::Point3d area_of(const Mesh& mesh, const Triangle& face) {
    const vcg::Point3d a = corner(mesh, face, 0);
    return ((corner(mesh, face, 1) - a) ^ (corner(mesh, face, 2) - a)) / 2;
}

template <class Mesh>
vcg::Point3d middle_of(const Mesh& mesh, const Triangle& face) {
    return (corner(mesh, face, 0) + corner(mesh, face, 1) + corner(mesh, face, 2)) / 3;
}

/// The area of the faces, and of those whose vectors and middles \p counts accepts.
template <class Mesh, class Counts>
std::pair<double, double> areas_of(const Mesh& mesh, const Counts& counts) {
    std::pair<double, double> sums(0, 0);
    for (const Triangle& face : mesh.faces) {
        const vcg::Point3d area = area_of(mesh, face);
        sums.first += area.Norm();
        if (counts(area, middle_of(mesh, face))) sums.second += area.Norm();
    }
    return sums;
}

/// The volume that the faces enclose; positive if they are counter-clockwise seen from outside.
template <class Position>
double enclosed_volume(const std::vector<Triangle>& faces, const Position& position) {
    double six_volumes = 0;
    for (const Triangle& f : faces) {
        const auto a = vcg::Point3d::Construct(position(f[0]));
        const auto b = vcg::Point3d::Construct(position(f[1]));
        const auto c = vcg::Point3d::Construct(position(f[2]));
        six_volumes += a * (b ^ c);
    }
    return six_volumes / 6;
}

/// The same of a mesh with vectors of positions and faces.
template <class Mesh>
double enclosed_volume(const Mesh& mesh) {
    return enclosed_volume(mesh.faces,
                           [&](VertexId v) { return mesh.positions[static_cast<std::size_t>(v)]; });
}

inline double enclosed_volume(const Network& network) {
    return enclosed_volume(network.faces(), [&](VertexId v) { return network.position(v); });
}

/// The smallest triangle_quality() of the faces.
inline float worst_quality(const Network& network) {
    float worst = 1;
    for (const auto& [a, b, c] : network.faces())
        worst = std::min(worst, triangle_quality(to_eigen(network.position(a)), to_eigen(network.position(b)),
                                                 to_eigen(network.position(c))));
    return worst;
}

/// The face of \p faces nearest to \p p, the first among equals; face -1 if there are none.
template <class Faces>
Hit nearest_face(const Vector3& p, const PerVertex<Vector3>& positions, const Faces& faces) {
    Hit best{-1, {std::numeric_limits<float>::max(), {1, 0, 0}}};
    int index = 0;
    for (const Triangle& face : faces) {
        const Foot foot = foot_on_triangle(p, positions[face[0]], positions[face[1]], positions[face[2]]);
        if (foot.squared_distance < best.foot.squared_distance) best = {index, foot};
        ++index;
    }
    return best;
}

}  // namespace neuralmesh
