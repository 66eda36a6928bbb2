// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/membranes.h"

#include <algorithm>
#include <map>
#include <utility>

#include "vcg_core/base/connected_groups.h"
#include "vcg_core/base/logarithm.h"

namespace neuralmesh {
namespace {

/// Area of the smallest membrane, in squared mean edges.
constexpr float kLeastArea = 0.2F;

/// Chains the edges between the membrane and the other faces, with those on the left. \return false if some
/// of these faces, or some of the membrane, hang on the others by a corner only
bool find_rims(const Surface& surface, Membrane& membrane) {
    const std::vector<int>& faces = membrane.faces;
    std::map<VertexId, VertexId> next;
    for (const int f : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const int beyond = face_beyond(surface, f, k);
            if (beyond < 0 || std::binary_search(faces.begin(), faces.end(), beyond)) continue;
            if (!next.emplace(surface.faces[f][(k + 1) % 3], surface.faces[f][k]).second) return false;
        }
    membrane.rims.clear();
    while (!next.empty()) {
        Rim& rim = membrane.rims.emplace_back();
        for (auto step = next.begin(); step != next.end(); step = next.find(rim.back())) {
            if (rim.empty()) rim.push_back(step->first);
            rim.push_back(step->second);
            next.erase(step);
        }
        rim.pop_back();  // back at the first
    }
    return true;
}

void measure(const Surface& surface, const FaceSignals& signals, Membrane& membrane) {
    membrane.missing = 0;
    membrane.area = Vector3::Zero();
    for (const int f : membrane.faces) {
        membrane.missing += signals.expected[f] - static_cast<float>(signals.wins[f]);
        membrane.area += area_vector(surface, f) / 2;
    }
}

/// The faces without support that are connected with \p start.
std::vector<int> region_of(const Surface& surface, const FaceSignals& signals, int start,
                           PerFace<char>& seen) {
    std::vector<int> region{start};
    seen[start] = 1;
    for (std::size_t i = 0; i < region.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const int next = face_beyond(surface, region[i], k);
            if (next < 0 || seen[next] != 0 || !signals.lacks_support(next)) continue;
            seen[next] = 1;
            region.push_back(next);
        }
    return region;
}

const Membrane& at(const std::vector<Membrane>& membranes, int i) {
    return membranes[static_cast<std::size_t>(i)];
}

/// Certain membranes that are near each other, or near to such that are.
std::vector<std::vector<int>> connected(const Surface& surface, const std::vector<Membrane>& membranes,
                                        float edge) {
    std::vector<int> free;
    for (int i = 0; i < static_cast<int>(membranes.size()); ++i)
        if (at(membranes, i).certain) free.push_back(i);
    return connected_groups(std::move(free), [&](int a, int b) {
        return near_each_other(surface, at(membranes, a), at(membranes, b), edge);
    });
}

}  // namespace

int face_beyond(const Surface& surface, int face, std::size_t edge) {
    const Triangle& f = surface.faces[face];
    return corner_of_edge(surface, f[(edge + 1) % 3], f[edge]).face;
}

bool near_each_other(const Surface& surface, const Membrane& a, const Membrane& b, float edge) {
    float least = kReach * edge;
    least *= least;
    for (const Rim& p : a.rims)
        for (const VertexId v : p)
            for (const Rim& q : b.rims)
                for (const VertexId w : q)
                    if ((surface.positions[v] - surface.positions[w]).squaredNorm() <= least) return true;
    return false;
}

bool face_each_other(const Surface& surface, const Membrane& a, const Membrane& b, float edge) {
    return a.area.dot(b.area) < 0 && near_each_other(surface, a, b, edge);
}

bool complete(const Surface& surface, const FaceSignals& signals, Membrane& membrane) {
    std::vector<int>& faces = membrane.faces;
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    if (!find_rims(surface, membrane)) return false;
    measure(surface, signals, membrane);
    return true;
}

double least_lack(const Surface& surface) {
    constexpr double kSure = 7;  // no accident of the sample, see FaceSignals::lack_of()
    return portable_log(static_cast<double>(surface.face_count())) + kSure;
}

std::vector<Membrane> find_membranes(const Surface& surface, const FaceSignals& signals) {
    const float edge = mean_edge_length(surface);
    const double least = least_lack(surface);
    PerFace<char> seen(surface.face_count(), 0);
    std::vector<Membrane> membranes;
    for (int f = 0; f < surface.face_count(); ++f) {
        if (seen[f] != 0 || !signals.lacks_support(f)) continue;
        Membrane membrane;
        membrane.faces = region_of(surface, signals, f, seen);
        float area = 0;
        for (const int g : membrane.faces) area += signals.area[g];
        const double lack = signals.lack_of(membrane.faces);
        if (area < kLeastArea * edge * edge || lack < least / 4 || !complete(surface, signals, membrane))
            continue;
        membrane.certain = lack >= least;
        membranes.push_back(std::move(membrane));
    }
    return membranes;
}

std::vector<std::vector<int>> membrane_groups(const Surface& surface, const std::vector<Membrane>& membranes,
                                              float edge, std::size_t most_rims) {
    std::vector<std::vector<int>> groups;
    for (std::vector<int>& group : connected(surface, membranes, edge)) {
        std::sort(group.begin(), group.end(), [&](int a, int b) {
            const float missing_a = at(membranes, a).missing, missing_b = at(membranes, b).missing;
            return missing_a != missing_b ? missing_a > missing_b : a < b;
        });
        std::size_t rims = 0, count = 0;
        while (count < group.size() && rims + at(membranes, group[count]).rims.size() <= most_rims)
            rims += at(membranes, group[count++]).rims.size();
        group.resize(count);
        if (count >= 3) groups.push_back(std::move(group));
    }
    return groups;
}

bool take_apart(const Surface& surface, const FaceSignals& signals, std::vector<Membrane>& membranes) {
    std::map<VertexId, std::size_t> first;  // membrane at each vertex of a rim
    for (std::size_t m = 0; m < membranes.size(); ++m) {
        for (const Rim& rim : membranes[m].rims)
            for (const VertexId v : rim) first.emplace(v, m);
        const auto shared = [&](int f) {
            const Triangle& face = surface.faces[f];
            return std::any_of(face.begin(), face.end(), [&](VertexId v) {
                const auto found = first.find(v);
                return found != first.end() && found->second != m;
            });
        };
        std::vector<int>& faces = membranes[m].faces;
        faces.erase(std::remove_if(faces.begin(), faces.end(), shared), faces.end());
        if (faces.empty() || !complete(surface, signals, membranes[m])) return false;
    }
    return true;
}

}  // namespace neuralmesh
