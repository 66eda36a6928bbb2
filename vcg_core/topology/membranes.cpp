// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/membranes.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/logarithm.h"

namespace neuralmesh {
namespace {

/// Area of the smallest membrane, in squared mean edges.
constexpr float kLeastArea = 0.2F;
/// A membrane of more faces is a part of the surface where the density is misjudged.
constexpr std::size_t kMostFaces = 2000;

class Members {
public:
    Members(const Surface& surface, const std::vector<int>& faces)
        : surface_(surface), in_(faces.begin(), faces.end()) {}
    bool has(int face) const { return in_.count(face) != 0; }
    void add(int face) { in_.insert(face); }
    std::vector<int> faces() const { return {in_.begin(), in_.end()}; }

    /// The other faces around \p v, in fans of faces that share edges.
    std::vector<std::vector<int>> other_fans(VertexId v) const;
    /// The other faces that are connected with \p start, if these are at most \p most; else none, and some of
    /// them are added to \p mainland. None either if one of them is there already.
    std::vector<int> island(int start, std::size_t most, std::set<int>& mainland) const;

private:
    const Surface& surface_;
    std::set<int> in_;
};

std::vector<std::vector<int>> Members::other_fans(VertexId v) const {
    std::vector<int> rest;
    for (const int f : surface_.faces_around(v))
        if (!has(f)) rest.push_back(f);
    return connected_groups(std::move(rest), [&](int f, int g) {
        return face_beyond(surface_, f, 0) == g || face_beyond(surface_, f, 1) == g ||
               face_beyond(surface_, f, 2) == g;
    });
}

std::vector<int> Members::island(int start, std::size_t most, std::set<int>& mainland) const {
    std::vector<int> found{start};
    std::set<int> seen{start};
    bool large = mainland.count(start) != 0;
    for (std::size_t i = 0; i < found.size() && !large; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const int next = face_beyond(surface_, found[i], k);
            if (next < 0 || has(next) || !seen.insert(next).second) continue;
            found.push_back(next);
            large = large || found.size() > most || mainland.count(next) != 0;
        }
    if (!large) return found;
    mainland.insert(found.begin(), found.end());
    return {};
}

/// Adds fans that hang on the membrane by a corner: all but that with the most signals.
bool add_pinched(const Surface& surface, const FaceSignals& signals, Members& members) {
    std::set<VertexId> corners;
    for (const int f : members.faces()) corners.insert(surface.faces[f].begin(), surface.faces[f].end());
    bool added = false;
    for (const VertexId v : corners) {
        std::vector<std::vector<int>> fans = members.other_fans(v);
        if (fans.size() < 2) continue;
        const auto wins = [&](const std::vector<int>& fan) {
            int sum = 0;
            for (const int f : fan) sum += signals.wins[f];
            return sum;
        };
        std::sort(fans.begin(), fans.end(), [&](const auto& a, const auto& b) {
            return wins(a) != wins(b) ? wins(a) > wins(b) : a < b;
        });
        for (std::size_t i = 1; i < fans.size(); ++i)
            for (const int f : fans[i]) members.add(f);
        added = true;
    }
    return added;
}

bool add_islands(const Surface& surface, Members& members) {
    bool added = false;
    std::set<int> mainland;
    const std::vector<int> before = members.faces();
    for (const int f : before)
        for (std::size_t k = 0; k < 3; ++k) {
            const int next = face_beyond(surface, f, k);
            if (next < 0 || members.has(next)) continue;
            for (const int g : members.island(next, before.size(), mainland)) {
                members.add(g);
                added = true;
            }
        }
    return added;
}

/// Chains the edges between the membrane and the other faces, with those on the left.
std::vector<Rim> rims_of(const Surface& surface, const Members& members) {
    std::map<VertexId, VertexId> next;
    for (const int f : members.faces())
        for (std::size_t k = 0; k < 3; ++k) {
            const int beyond = face_beyond(surface, f, k);
            if (beyond >= 0 && !members.has(beyond))
                next[surface.faces[f][(k + 1) % 3]] = surface.faces[f][k];
        }
    std::vector<Rim> rims;
    while (!next.empty()) {
        rims.emplace_back();
        for (auto step = next.begin(); step != next.end(); step = next.find(rims.back().back())) {
            if (rims.back().empty()) rims.back().push_back(step->first);
            rims.back().push_back(step->second);
            next.erase(step);
        }
        rims.back().pop_back();  // back at the first
    }
    return rims;
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
    Members members(surface, membrane.faces);
    while (add_islands(surface, members) || add_pinched(surface, signals, members))
        if (members.faces().size() > kMostFaces) return false;
    membrane.faces = members.faces();
    membrane.rims = rims_of(surface, members);
    membrane.missing = 0;
    membrane.area = Vector3::Zero();
    for (const int f : membrane.faces) {
        membrane.missing += signals.expected[f] - static_cast<float>(signals.wins[f]);
        membrane.area += area_vector(surface, f) / 2;
    }
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
    std::vector<int> certain;
    for (int i = 0; i < static_cast<int>(membranes.size()); ++i)
        if (at(membranes, i).certain) certain.push_back(i);
    const auto near = [&](int a, int b) {
        return near_each_other(surface, at(membranes, a), at(membranes, b), edge);
    };
    std::vector<std::vector<int>> groups;
    for (std::vector<int>& group : connected_groups(std::move(certain), near)) {
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
