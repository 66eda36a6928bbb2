// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/given_start.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {

namespace {

using CornerPair = std::pair<int, int>;

/// A vertex that is split lets its twin move this share of the way to the middle of the twin's neighbours.
constexpr float kTwinStep = 0.25F;

/// How the sentences name the mesh, and what they advise.
struct Words {
    const char* layer;
    const char* manifold;  ///< what it has to be
    const char* or_else;   ///< than mending it
    const char* without_faces;
    const char* apart;
};

const Words& words_for(GivenAs role) {
    static const Words start = {
        "The start layer", "no manifold that learning can go on from", ", or choose another 'Start mesh'",
        "choose a layer with a triangle mesh as 'Start layer', or another 'Start mesh'",
        "Choose the layer that belongs to the points as 'Start layer', or move it by its matrix"};
    static const Words current = {
        "The current layer", "no manifold, so its vertices cannot learn", "",
        "make a layer with a triangle mesh the current one; points belong into the 'Signal layer'",
        "Choose the layer that belongs to the current one as 'Signal layer', or move it by its matrix"};
    return role == GivenAs::start_layer ? start : current;
}

[[noreturn]] void refuse(const Words& words, std::size_t count, const char* things, const char* breach,
                         const char* filter) {
    throw InputError(std::string(words.layer) + " is " + words.manifold + ": it has " + things + ' ' +
                     breach + " (" + std::to_string(count) + "). Mend it with the filter '" + filter + "'" +
                     words.or_else + '.');
}

/// How many elements of a sorted list equal the one before them.
template <class T>
std::size_t repetitions(const std::vector<T>& sorted) {
    std::size_t count = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) count += sorted[i] == sorted[i - 1] ? 1 : 0;
    return count;
}

void check_faces(const std::vector<Triangle>& faces, const Words& words) {
    if (faces.empty())
        throw InputError(std::string(words.layer) + " has no faces: " + words.without_faces + '.');
    const auto degenerate = std::count_if(faces.begin(), faces.end(), [](const Triangle& f) {
        return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
    });
    if (degenerate > 0)
        refuse(words, static_cast<std::size_t>(degenerate), "faces", "with a corner twice",
               "Remove Zero Area Faces");
    std::vector<Triangle> sorted = faces;
    for (Triangle& f : sorted) std::sort(f.begin(), f.end());
    std::sort(sorted.begin(), sorted.end());
    if (const std::size_t count = repetitions(sorted))
        refuse(words, count, "faces", "that repeat others", "Remove Duplicate Faces");
}

void check_edges(const std::vector<Triangle>& faces, const Words& words) {
    std::vector<CornerPair> directed, plain;
    for (const Triangle& f : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            directed.emplace_back(f[k], f[(k + 1) % 3]);
            plain.emplace_back(std::minmax(f[k], f[(k + 1) % 3]));
        }
    std::sort(plain.begin(), plain.end());
    std::size_t crowded = 0;
    for (std::size_t i = 2; i < plain.size(); ++i) crowded += plain[i] == plain[i - 2] ? 1 : 0;
    if (crowded > 0) refuse(words, crowded, "edges", "with more than two faces", "Repair non Manifold Edges");
    std::sort(directed.begin(), directed.end());
    if (const std::size_t count = repetitions(directed))
        refuse(words, count, "edges", "whose two faces have opposite orientations",
               "Re-Orient all faces coherently");
}

/// A face of a vertex: around the vertex, neighbour \p to follows \p from.
struct FaceLink {
    int from, to;
    std::size_t face;
};
using Links = std::vector<std::vector<FaceLink>>;

Links links_of(const IndexedMesh<float>& mesh) {
    Links links(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        const Triangle& f = mesh.faces[i];
        for (std::size_t k = 0; k < 3; ++k)
            links[static_cast<std::size_t>(f[k])].push_back({f[(k + 1) % 3], f[(k + 2) % 3], i});
    }
    return links;
}

/// The neighbours of a vertex in order, as far as they follow each other, with the faces between them.
struct Fan {
    std::vector<int> neighbours;
    std::vector<std::size_t> faces;
};

Fan fan_of(const std::vector<FaceLink>& links) {
    const auto find = [&](int v, int FaceLink::*end) {
        return std::find_if(links.begin(), links.end(), [&](const FaceLink& l) { return l.*end == v; });
    };
    auto link = std::find_if(links.begin(), links.end(),
                             [&](const FaceLink& l) { return find(l.from, &FaceLink::to) == links.end(); });
    if (link == links.end()) link = links.begin();
    Fan fan{{link->from}, {}};
    while (link != links.end()) {
        fan.faces.push_back(link->face);
        if (link->to == fan.neighbours.front()) break;
        fan.neighbours.push_back(link->to);
        link = find(link->to, &FaceLink::from);
    }
    return fan;
}

void check_vertices(const IndexedMesh<float>& mesh, const Words& words) {
    if (mesh.faces.size() > 1 && 3 * mesh.faces.size() == mesh.positions.size())
        refuse(words, mesh.faces.size(), "faces", "of which no two share a vertex", "Merge Close Vertices");
    std::size_t pinched = 0;
    for (const std::vector<FaceLink>& links : links_of(mesh))
        pinched += fan_of(links).faces.size() < links.size() ? 1 : 0;
    if (pinched > 0)
        refuse(words, pinched, "vertices", "where parts of the surface only touch",
               "Repair non Manifold Vertices by splitting");
}

/// Gives half of the fan of vertex \p v to a new vertex, which becomes its neighbour. The surface stays, up
/// to the small step that the new vertex makes.
void split(GivenStart& mesh, int v, const Fan& fan) {
    const auto twin = static_cast<int>(mesh.positions.size());
    const std::size_t last = fan.neighbours.size() / 2;
    vcg::Point3f middle(0, 0, 0);
    for (std::size_t i = 0; i <= last; ++i)
        middle += mesh.positions[static_cast<std::size_t>(fan.neighbours[i])];
    const vcg::Point3f here = mesh.positions[static_cast<std::size_t>(v)];
    mesh.sources.push_back(mesh.sources[static_cast<std::size_t>(v)]);
    mesh.positions.push_back(here + (middle / static_cast<float>(last + 1) - here) * kTwinStep);
    for (std::size_t i = 0; i < last; ++i) {
        Triangle& face = mesh.faces[fan.faces[i]];
        std::replace(face.begin(), face.end(), v, twin);
    }
    mesh.faces.push_back({v, fan.neighbours.front(), twin});
    mesh.faces.push_back({twin, fan.neighbours[last], v});
}

/// Splits vertices until no valence is above Ring::kMaxValence. Each pass splits vertices that are not
/// neighbours.
void reduce_valences(GivenStart& mesh) {
    for (bool done = false; !done;) {
        done = true;
        const Links links = links_of(mesh);
        std::vector<char> touched(links.size(), 0);
        for (std::size_t v = 0; v < links.size(); ++v) {
            if (links[v].size() < Ring::kMaxValence) continue;
            const Fan fan = fan_of(links[v]);
            if (fan.neighbours.size() <= Ring::kMaxValence) continue;
            done = false;
            if (touched[v] != 0) continue;
            split(mesh, static_cast<int>(v), fan);
            for (const int u : fan.neighbours) touched[static_cast<std::size_t>(u)] = 1;
        }
    }
}

/// As MeshLab's layers may have them.
GivenStart without_unused_vertices(const IndexedMesh<double>& mesh, const Frame& frame) {
    std::vector<int> index(mesh.positions.size(), -1);
    GivenStart result;
    for (Triangle f : mesh.faces) {
        for (int& v : f) {
            int& place = index[static_cast<std::size_t>(v)];
            if (place < 0) {
                place = static_cast<int>(result.positions.size());
                result.positions.push_back(frame.inside(mesh.positions[static_cast<std::size_t>(v)]));
                result.sources.push_back(v);
            }
            v = place;
        }
        result.faces.push_back(f);
    }
    return result;
}

vcg::Box3f box_of(const std::vector<vcg::Point3f>& points) {
    vcg::Box3f box;
    for (const vcg::Point3f& p : points) box.Add(p);
    return box;
}

/// With a margin, because boxes may be flat: those of a plane and of points on it only touch, or not even
/// that.
bool lie_apart(vcg::Box3f a, const vcg::Box3f& b) {
    constexpr float kMargin = 0.05F;  // in diagonals of the target
    a.Offset(kMargin);
    return !a.Collide(b);
}

}  // namespace

GivenStart given_start(const IndexedMesh<double>& mesh, const TargetSpace& target, GivenAs role) {
    const Words& words = words_for(role);
    check_faces(mesh.faces, words);
    check_edges(mesh.faces, words);
    GivenStart start = without_unused_vertices(mesh, target.frame());
    check_vertices(start, words);
    if (lie_apart(box_of(start.positions), box_of(target.positions())))
        throw InputError(std::string(words.layer) +
                         " lies apart from the points: their bounding boxes do not meet. " + words.apart +
                         '.');
    reduce_valences(start);
    return start;
}

}  // namespace neuralmesh
