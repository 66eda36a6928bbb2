// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/normal_orientation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
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

/// Union-find in which every point knows whether its normal is opposite to that of its root.
class Sides {
public:
    explicit Sides(std::size_t count) : parent_(count), flipped_(count, 0) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    struct Root {
        int point;
        bool flipped;
    };
    Root root(int i) {
        int top = i;
        char flips = 0;
        while (parent_[at(top)] != top) {
            flips = static_cast<char>(flips ^ flipped_[at(top)]);
            top = parent_[at(top)];
        }
        for (int k = i; parent_[at(k)] != k;) {  // paths become short
            const int next = parent_[at(k)];
            const char own = flipped_[at(k)];
            parent_[at(k)] = top;
            flipped_[at(k)] = flips;
            flips = static_cast<char>(flips ^ own);
            k = next;
        }
        return {top, i != top && flipped_[at(i)] != 0};
    }
    void join(const Root& a, const Root& b, bool opposite) {
        const int low = std::min(a.point, b.point), high = std::max(a.point, b.point);
        parent_[at(high)] = low;
        flipped_[at(high)] = (a.flipped != b.flipped) != opposite ? 1 : 0;
    }

private:
    std::vector<int> parent_;
    std::vector<char> flipped_;
};

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
    Sides sides(at(count + 1));
    for (const Link& link : links) {
        const Sides::Root a = sides.root(link.a), b = sides.root(link.b);
        if (a.point != b.point) {
            sides.join(a, b, link.opposite);
        } else if ((a.flipped != b.flipped) != link.opposite && link.weight < kSureWeight && link.b < count) {
            result.contradictions.push_back((positions[at(link.a)] + positions[at(link.b)]) / 2);
        }
    }
    const Sides::Root viewer = sides.root(count);
    for (int i = 0; i < count; ++i) {
        const Sides::Root root = sides.root(i);
        const bool over = root.point == viewer.point && viewer.flipped;
        if (root.flipped != over) normals[at(i)] = -normals[at(i)];
    }
    return result;
}

}  // namespace neuralmesh
