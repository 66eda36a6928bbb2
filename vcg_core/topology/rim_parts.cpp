// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/rim_parts.h"

#include <algorithm>
#include <set>

namespace neuralmesh {
namespace {

/// All ways to add the rims from \p next to \p rims - 1 to \p parts.
void add_partitions(std::size_t next, std::size_t rims, RimParts& parts, std::vector<RimParts>& all) {
    if (next == rims) {
        all.push_back(parts);
        return;
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
        parts[p].push_back(next);
        add_partitions(next + 1, rims, parts, all);
        parts[p].pop_back();
    }
    parts.push_back({next});
    add_partitions(next + 1, rims, parts, all);
    parts.pop_back();
}

}  // namespace

std::vector<RimParts> partitions(std::size_t rims) {
    RimParts parts;
    std::vector<RimParts> all;
    add_partitions(0, rims, parts, all);
    return all;
}

bool connect_all(const RimParts& parts, std::vector<std::size_t> membrane_of) {
    for (const std::vector<std::size_t>& part : parts)
        for (const std::size_t rim : part) {
            const std::size_t from = membrane_of[rim], to = membrane_of[part.front()];
            std::replace(membrane_of.begin(), membrane_of.end(), from, to);
        }
    const auto is_first = [&](std::size_t membrane) { return membrane == membrane_of.front(); };
    return std::all_of(membrane_of.begin(), membrane_of.end(), is_first);
}

int euler_characteristic(const RimParts& parts) {
    int sum = 0;
    for (const std::vector<std::size_t>& part : parts) sum += 2 - static_cast<int>(part.size());
    return sum;
}

int euler_characteristic(const std::vector<Triangle>& faces, const std::vector<Rim>& rims) {
    std::set<VertexId> vertices;
    for (const Triangle& f : faces) vertices.insert(f.begin(), f.end());
    std::size_t sides = 3 * faces.size();  // an edge on a rim has one, the others have two
    for (const Rim& rim : rims) sides += rim.size();
    return static_cast<int>(vertices.size()) - static_cast<int>(sides / 2) + static_cast<int>(faces.size());
}

std::vector<Triangle> patches_of(const RimParts& parts, const std::vector<Rim>& rims,
                                 const PerVertex<Vector3>& positions, const Edges& edges) {
    std::vector<Triangle> all;
    for (const std::vector<std::size_t>& part : parts) {
        std::vector<Rim> joined;
        for (const std::size_t rim : part) joined.push_back(rims[rim]);
        const std::vector<Triangle> faces = joined.size() == 1 ? closing_patch(joined[0], positions, edges)
                                                               : joining_patch(joined, positions, edges);
        if (faces.empty()) return {};
        all.insert(all.end(), faces.begin(), faces.end());
    }
    return all;
}

}  // namespace neuralmesh
