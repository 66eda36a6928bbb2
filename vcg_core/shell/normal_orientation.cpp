// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/normal_orientation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

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

}  // namespace

std::vector<Point3f> orient_normals(const std::vector<Point3f>& positions,
                                    const std::vector<std::pair<int, int>>& neighbours,
                                    std::vector<Point3f>& normals) {
    std::vector<Link> links;
    links.reserve(neighbours.size());
    for (const auto& [a, b] : neighbours)
        links.push_back(link_of(positions, normals, std::min(a, b), std::max(a, b)));
    std::sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
        return std::tie(x.weight, x.a, x.b) < std::tie(y.weight, y.a, y.b);
    });
    std::vector<Point3f> contradictions;
    Sides sides(normals.size());
    for (const Link& link : links) {
        const Sides::Root a = sides.root(link.a), b = sides.root(link.b);
        if (a.point != b.point) {
            sides.join(a, b, link.opposite);
        } else if ((a.flipped != b.flipped) != link.opposite && link.weight < kSureWeight) {
            contradictions.push_back((positions[at(link.a)] + positions[at(link.b)]) / 2);
        }
    }
    for (std::size_t i = 0; i < normals.size(); ++i)
        if (sides.root(static_cast<int>(i)).flipped) normals[i] = -normals[i];
    return contradictions;
}

}  // namespace neuralmesh
