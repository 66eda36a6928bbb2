// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/normal_orientation.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/indexed.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Planes that differ by less than this continue each other without doubt.
constexpr float kSureWeight = 0.1F;

/// Two points side by side and whether their normals agree.
struct Link {
    float weight;
    int a, b;
    bool opposite;
};

/// Where a surface turns evenly from \p a to \p b, the normal of b is that of a, reflected on the plane half
/// way between them. So planes around a crease, and those on the two sides of a wall, agree where they
/// should. (Koenig and Gumhold, "Consistent Propagation of Normal Orientations in Point Clouds", 2009.)
/// Ways along the surface get the lowest weights, those across a wall the highest.
Link link_of(const std::vector<Point3f>& positions, const std::vector<Point3f>& normals, int a, int b) {
    const Point3f way = positions[at(b)] - positions[at(a)];
    const float squared = std::max(way.SquaredNorm(), 1e-20F);
    const float from = normals[at(a)] * way, to = normals[at(b)] * way;
    const float agreement = (normals[at(a)] - way * (2 * from / squared)) * normals[at(b)];
    const float across = std::max(from * from, to * to) / squared;
    return {1 - std::abs(agreement) + across, a, b, agreement < 0};
}

std::vector<int> parts_of(const std::vector<Link>& links, int count) {
    DisjointSets sets(count);
    for (const Link& link : links)
        if (link.weight < kSureWeight) sets.join(link.a, link.b);
    std::vector<int> parts;
    for (int i = 0; i < count; ++i) parts.push_back(sets.find(i));
    return parts;
}

}  // namespace

Orientation orient_normals(const std::vector<Point3f>& positions,
                           const std::vector<std::pair<int, int>>& neighbours,
                           const std::vector<Point3f>& sights, std::vector<Point3f>& normals) {
    const int count = static_cast<int>(normals.size());
    std::vector<Link> links;
    links.reserve(neighbours.size());
    for (const auto& [a, b] : neighbours)
        links.push_back(link_of(positions, normals, std::min(a, b), std::max(a, b)));
    Orientation result;
    result.parts = parts_of(links, count);
    for (int i = 0; i < static_cast<int>(sights.size()); ++i) {
        const float front = sights[at(i)] * normals[at(i)];
        if (front != 0) links.push_back({1 - std::abs(front), i, count, front < 0});
    }
    std::sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
        return std::tie(x.weight, x.a, x.b) < std::tie(y.weight, y.a, y.b);
    });
    // Sets of normals that agree; those of the points from count + 1 on are the opposite ones.
    DisjointSets sides(2 * (count + 1));
    const auto opposite = [count](int i) { return i + count + 1; };
    for (const Link& link : links) {
        const int b = link.opposite ? opposite(link.b) : link.b, not_b = link.opposite ? link.b : opposite(b);
        if (sides.find(link.a) != sides.find(not_b)) {
            sides.join(link.a, b);
            sides.join(opposite(link.a), not_b);
        } else if (link.weight < kSureWeight && link.b < count) {
            result.contradictions.push_back((positions[at(link.a)] + positions[at(link.b)]) / 2);
        }
    }
    const int front = sides.find(count), back = sides.find(opposite(count));
    for (int i = 0; i < count; ++i) {
        // Of a part that no viewer is linked to, the first normal stays.
        const int own = sides.find(i), other = sides.find(opposite(i));
        if (own == back || (own != front && other < own)) normals[at(i)] = -normals[at(i)];
    }
    return result;
}

}  // namespace neuralmesh
