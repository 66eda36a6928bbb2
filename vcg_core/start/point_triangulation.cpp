// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/point_triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "vcg_core/base/indexed.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/cloud/nearest_points.h"
#include "vcg_core/mesh/non_manifold_vertices.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// More neighbours are not looked at: about as many points, a radius apart, are within three radii.
constexpr int kMostNeighbours = 32;
/// Circles through the corners of a triangle that are wider than so many radii lie in a gap.
constexpr float kWidestCircle = 1.5F;
/// A point belongs to another layer if its normal differs by more than that of the other side of an edge of
/// 45 degrees, or if it lies above the tangent plane rather than beside it: on the other side of such an
/// edge, as far from it, the sine is .92. With a right angle and .8, models cut open had cracks along their
/// edges.
constexpr float kLeastCosine = -0.7F, kMostAcross = 0.93F;
constexpr float kHalfTurn = 2;  // in the measure of angle()

struct Plane {
    Point3f x, y;
    explicit Plane(const Point3f& normal) {
        const int k = std::abs(normal[0]) < 0.6F ? 0 : 1;
        Point3f axis(0, 0, 0);
        axis[k] = 1;
        x = (axis - normal * normal[k]).Normalize();
        y = normal ^ x;
    }
};

struct Points {
    const std::vector<Point3f>& positions;
    const std::vector<Point3f>& normals;
    const std::vector<float>& radii;

    /// The direction from one point to another, in the tangent plane of the first: grows with the angle,
    /// by 2 for half a turn.
    float angle(int from, int to) const {
        const Plane plane(normals[at(from)]);
        const Point3f way = positions[at(to)] - positions[at(from)];
        const float x = way * plane.x, y = way * plane.y;
        const float part = y / std::max(std::abs(x) + std::abs(y), 1e-30F);
        if (x < 0) return 2 - part;
        return y < 0 ? 4 + part : part;
    }
};

/// A neighbour in the tangent plane, inverted on the unit circle: the neighbours of the star are the corners
/// of the convex hull.
struct Inverted {
    float x, y;
    int point;
};

float turn(const Inverted& a, const Inverted& b, const Inverted& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Counter-clockwise (Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979).
std::vector<Inverted> convex_hull(std::vector<Inverted> points) {
    std::sort(points.begin(), points.end(), [](const Inverted& a, const Inverted& b) {
        return std::tie(a.x, a.y, a.point) < std::tie(b.x, b.y, b.point);
    });
    std::vector<Inverted> hull;
    const auto add = [&](const Inverted& p, std::size_t least) {
        while (hull.size() >= least + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
        hull.push_back(p);
    };
    for (const Inverted& p : points) add(p, 0);
    const std::size_t lower = hull.size() - 1;
    for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
    hull.pop_back();
    return hull;
}

/// Half the product of the edges over twice the area.
float circle_radius(const Points& points, const Triangle& t) {
    const Point3f a = points.positions[at(t[1])] - points.positions[at(t[0])];
    const Point3f b = points.positions[at(t[2])] - points.positions[at(t[0])];
    return a.Norm() * b.Norm() * (a - b).Norm() / std::max(2 * (a ^ b).Norm(), 1e-20F);
}

/// A triangle of a star: its corners, smallest first, and whether that order is counter-clockwise.
struct Candidate {
    Triangle corners;
    bool counter_clockwise;
    int votes = 1;
    float circle = 0;
};

void add_star(const Points& points, const NearestPoints& index, NearestPoints::Place place,
              std::vector<Candidate>& found) {
    const int own = static_cast<int>(index.index(place));
    const Point3f& normal = points.normals[at(own)];
    const Plane plane(normal);
    std::vector<NearestPoints::Neighbour> near;
    index.nearest(place, kMostNeighbours, near);
    std::vector<Inverted> inverted{{0, 0, -1}};
    const float reach = kStarReach * points.radii[at(own)];
    for (const NearestPoints::Neighbour& n : near) {
        const int other = static_cast<int>(index.index(n.place));
        const Point3f way = points.positions[at(other)] - points.positions[at(own)];
        const float length = std::sqrt(n.squared_distance), across = way * normal;
        if (length > reach || !(length > 0) || std::abs(across) > kMostAcross * length ||
            points.normals[at(other)] * normal < kLeastCosine)
            continue;
        const float x = way * plane.x, y = way * plane.y;
        // Unfolded, the neighbour is as far as it is in space.
        const float scale = 1 / (std::sqrt(x * x + y * y) * length);
        inverted.push_back({x * scale, y * scale, other});
    }
    if (inverted.size() < 3) return;
    const std::vector<Inverted> hull = convex_hull(std::move(inverted));
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Inverted &a = hull[i], &b = hull[(i + 1) % hull.size()];
        if (a.point < 0 || b.point < 0) continue;
        Candidate candidate{{own, a.point, b.point}, true};
        candidate.circle = circle_radius(points, candidate.corners);
        const float radius =
            std::max({points.radii[at(own)], points.radii[at(a.point)], points.radii[at(b.point)]});
        if (candidate.circle > kWidestCircle * radius) continue;
        Triangle& c = candidate.corners;
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        candidate.counter_clockwise = c[1] < c[2];
        if (c[1] > c[2]) std::swap(c[1], c[2]);
        found.push_back(candidate);
    }
}

/// The candidates of all stars, each once, those with most votes first and then the smallest.
std::vector<Candidate> candidates(const Points& points, ThreadTeam& team) {
    constexpr int kAtATime = 64;
    const NearestPoints index(points.positions);
    std::vector<Candidate> all = parallel_collect<Candidate>(
        static_cast<int>(index.size()), kAtATime, team, [&](int i, std::vector<Candidate>& found) {
            add_star(points, index, static_cast<NearestPoints::Place>(i), found);
        });
    std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(a.corners, a.counter_clockwise) < std::tie(b.corners, b.counter_clockwise);
    });
    std::vector<Candidate> once;
    for (const Candidate& c : all) {
        if (!once.empty() && once.back().corners == c.corners &&
            once.back().counter_clockwise == c.counter_clockwise) {
            ++once.back().votes;
        } else {
            once.push_back(c);
        }
    }
    std::sort(once.begin(), once.end(), [](const Candidate& a, const Candidate& b) {
        return std::tie(b.votes, a.circle, a.corners, a.counter_clockwise) <
               std::tie(a.votes, b.circle, b.corners, b.counter_clockwise);
    });
    return once;
}

/// The surface while it is put together. Around every point it knows the wedges of its faces.
class Assembly {
public:
    explicit Assembly(const Points& points) : points_(points), wedges_(points.positions.size()) {}

    void add(const Candidate& candidate) {
        Triangle t = candidate.corners;
        if (!candidate.counter_clockwise) std::swap(t[1], t[2]);
        std::array<Wedge, 3> wedges{};
        for (std::size_t k = 0; k < 3; ++k) {
            const int v = t[k], first = t[(k + 1) % 3], last = t[(k + 2) % 3];
            wedges[k] = {first, last, points_.angle(v, first), points_.angle(v, last)};
            if (!fits(v, wedges[k])) return;
        }
        for (std::size_t k = 0; k < 3; ++k) wedges_[at(t[k])].push_back(wedges[k]);
        faces_.push_back(t);
    }

    const std::vector<Triangle>& faces() const { return faces_; }

private:
    /// Of a face at one of its corners: the two others, counter-clockwise, and their directions.
    struct Wedge {
        int first, last;
        float from, to;
        bool contains(float direction) const { return angle(from, direction) < angle(from, to); }
        static float angle(float from, float to) {
            const float a = to - from;
            return a < 0 ? a + 2 * kHalfTurn : a;
        }
    };

    bool fits(int v, const Wedge& wedge) const {
        if (Wedge::angle(wedge.from, wedge.to) >= kHalfTurn) return false;
        for (const Wedge& other : wedges_[at(v)]) {
            if (other.first == wedge.first || other.last == wedge.last) return false;
            if (other.first != wedge.last && wedge.contains(other.from)) return false;
            if (other.last != wedge.first && other.contains(wedge.from)) return false;
        }
        return true;
    }

    const Points& points_;
    std::vector<std::vector<Wedge>> wedges_;
    std::vector<Triangle> faces_;
};

}  // namespace

IndexedMesh<float> triangulation(const std::vector<Point3f>& positions, const std::vector<Point3f>& normals,
                                 const std::vector<float>& radii, ThreadTeam& team,
                                 std::vector<int>& source) {
    const Points points{positions, normals, radii};
    Assembly assembly(points);
    for (const Candidate& candidate : candidates(points, team)) assembly.add(candidate);
    IndexedMesh<float> mesh;
    mesh.positions = positions;
    mesh.faces = assembly.faces();
    source.resize(positions.size());
    for (std::size_t i = 0; i < source.size(); ++i) source[i] = static_cast<int>(i);
    split_non_manifold_vertices(mesh, source);
    drop_unused_vertices(mesh, source);
    return mesh;
}

}  // namespace neuralmesh
