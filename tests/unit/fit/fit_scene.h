// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Networks with points around them: the input of the steps of the fit.
#pragma once

#include <iterator>

#include "tests/unit/support/prelude.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/fit/redistribute.h"

namespace neuralmesh {

/// Points spread evenly over every face of \p surface, as many on each, at \p height(random) above it.
template <class Height>
PointsByFace points_on(const Surface& surface, int per_face, const Height& height, std::uint64_t seed = 4) {
    Random random(seed);
    TrackedPoints points;
    std::vector<Hit> hits;
    for (int f = 0; f < surface.face_count(); ++f)
        for (int i = 0; i < per_face; ++i) {
            float s = random.unit();
            float t = random.unit();
            if (s + t > 1) {
                s = 1 - s;
                t = 1 - t;
            }
            const float h = static_cast<float>(height(random));
            hits.push_back({f, {h * h, {1 - s - t, s, t}}});
            points.points.push_back((1 - s - t) * surface.corner(f, 0) + s * surface.corner(f, 1) +
                                    t * surface.corner(f, 2) + h * unit_normal(surface, f));
        }
    return PointsByFace(surface, points, hits);
}

inline TrackedPoints tracked_points(const Cloud& cloud) {
    TrackedPoints points;
    for (const vcg::Point3d& p : cloud) points.points.push_back(to_eigen(vcg::Point3f::Construct(p)));
    return points;
}

/// A network, and the points of a cloud with their nearest faces.
struct FitScene {
    FitScene(Network given, const Cloud& cloud)
        : network(std::move(given)), surface(network), tracked(tracked_points(cloud)) {
        points =
            group_by_face(surface, tracked, nearest_by_tree(surface, tracked, one_thread()), one_thread());
    }

    Network network;
    Surface surface;
    TrackedPoints tracked;
    PointsByFace points{surface, {}, {}};
};

inline std::vector<Collapse> collapses_of(const FitScene& scene) {
    return find_collapses(scene.network, scene.surface, scene.points, one_thread());
}

/// Sum of the squared distances of \p points from the nearest of \p faces.
inline double squared_distances(const std::vector<Vector3>& points, const std::vector<Triangle>& faces,
                                const Network& network) {
    double sum = 0;
    for (const Vector3& p : points) {
        float least = std::numeric_limits<float>::max();
        for (const Triangle& f : faces)
            least = std::min(
                least, foot_on_triangle(p, to_eigen(network.position(f[0])), to_eigen(network.position(f[1])),
                                        to_eigen(network.position(f[2])))
                           .squared_distance);
        sum += static_cast<double>(least);
    }
    return sum;
}

/// The faces of \p after that \p before does not have.
inline std::vector<Triangle> new_faces(const Network& before, const Network& after) {
    const auto sorted = [](const Network& network) {
        std::vector<Triangle> faces = network.faces();
        std::sort(faces.begin(), faces.end());
        return faces;
    };
    const std::vector<Triangle> old = sorted(before);
    const std::vector<Triangle> now = sorted(after);
    std::vector<Triangle> result;
    std::set_difference(now.begin(), now.end(), old.begin(), old.end(), std::back_inserter(result));
    return result;
}

/// The points of the given faces.
inline std::vector<Vector3> points_of(const PointsByFace& points, const std::vector<int>& faces) {
    std::vector<Vector3> result;
    for (int f : faces)
        for (const PointsByFace::Assignment& a : points.of(f)) result.push_back(a.point);
    return result;
}

}  // namespace neuralmesh
