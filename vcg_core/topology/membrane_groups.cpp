// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/membrane_groups.h"

#include <algorithm>
#include <map>
#include <utility>

#include "vcg_core/base/connected_groups.h"

namespace neuralmesh {
namespace {

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
