// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What patches gain, against the plain sum over all signals and all faces.
#include "vcg_core/topology/surroundings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "tests/unit/support/nearest_face.h"
#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/topology/membranes.h"

namespace neuralmesh {
namespace {

using targets::network_in_frame;
using targets::target_of;

/// The cost of the whole surface of \p faces.
double plain_cost(const Surface& surface, const FaceSignals& support, const std::vector<Triangle>& faces,
                  float edge) {
    std::vector<float> wins(faces.size(), 0);
    double cost = 0;
    for (const FaceSignals::Assigned& s : support.signals) {
        const Hit hit = referee::nearest_face(s.point, surface.positions, faces);
        ++wins[static_cast<std::size_t>(hit.face)];
        cost += std::min(1.0, static_cast<double>(hit.foot.squared_distance / (0.5F * edge * 0.5F * edge)));
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const float area = area_vector(faces[f], surface.positions).norm() / 2;
        cost += std::max(0.0, static_cast<double>(support.expected_on(faces[f], area) - wins[f]));
    }
    return cost;
}

/// The vertices so many edges away from \p centre.
std::vector<VertexId> ring_at(const Network& network, VertexId centre, int edges) {
    std::set<VertexId> seen{centre}, last{centre};
    for (int i = 0; i < edges; ++i) {
        std::set<VertexId> next;
        for (const VertexId v : last)
            for (const VertexId u : network.ring(v))
                if (seen.insert(u).second) next.insert(u);
        last = next;
    }
    return {last.begin(), last.end()};
}

/// None close to \p centre, and some deep inside the sphere, which are nearer to a patch of the two-ring than
/// to their faces, some way off.
std::vector<Vector3> with_deep_ones(std::vector<Vector3> signals, const Network& network, VertexId centre) {
    const Surface surface(network);
    Vector3 middle = Vector3::Zero();
    for (const VertexId v : network.vertices())
        middle += surface.positions[v] / static_cast<float>(network.vertex_count());
    const float bare = 2.5F * mean_edge_length(surface);
    const auto is_close = [&](const Vector3& p) { return (p - surface.positions[centre]).norm() < bare; };
    signals.erase(std::remove_if(signals.begin(), signals.end(), is_close), signals.end());
    for (const VertexId v : ring_at(network, centre, 5))
        signals.push_back(middle + 0.15F * (surface.positions[v] - middle));
    return signals;
}

void expect_the_plain_gain(bool deep) {
    const TargetSpace target = target_of(shapes::sphere_cloud(4000, 0.02));
    const Network network = network_in_frame(target, shapes::icosphere(3));
    const Surface surface(network);
    Random random(1);
    ThreadTeam team(1);
    const std::vector<Vector3> sample = fair_sample(target, 4000, random);
    const float edge = mean_edge_length(surface);
    for (const VertexId centre : {100, 300, 500}) {
        SCOPED_TRACE(centre);
        const std::vector<Vector3> signals = deep ? with_deep_ones(sample, network, centre) : sample;
        const FaceSignals support = face_signals(network, surface, signals, team);
        Membrane membrane;  // the faces of two rings: the patch has more faces than one group of boxes
        for (const VertexId v : network.ring(centre))
            for (const int f : surface.faces_around(v)) membrane.faces.push_back(f);
        ASSERT_TRUE(complete(surface, support, membrane));
        PerFace<char> out(surface.face_count(), 0);
        std::vector<Triangle> patched;
        for (const int f : membrane.faces) out[f] = 1;
        const auto patch =
            closing_patches({membrane.rims.front()}, surface.positions, {network, surface, out});
        ASSERT_GT(patch.size(), 8U);
        for (int f = 0; f < surface.face_count(); ++f)
            if (out[f] == 0) patched.push_back(surface.faces[f]);
        patched.insert(patched.end(), patch.begin(), patch.end());
        std::vector<Triangle> whole;
        for (int f = 0; f < surface.face_count(); ++f) whole.push_back(surface.faces[f]);
        const Surroundings around(surface, FaceTree(surface), support, membrane.faces, edge);
        const double plain =
            plain_cost(surface, support, whole, edge) - plain_cost(surface, support, patched, edge);
        EXPECT_GT(std::abs(plain), 0.5);
        EXPECT_NEAR(around.gain(patch), plain, 1e-2);
    }
}

TEST(Surroundings, TellTheDifferenceThatAPatchMakes) { expect_the_plain_gain(false); }

TEST(Surroundings, CountSignalsThatAPatchWinsFromFacesSomeWayOff) { expect_the_plain_gain(true); }

}  // namespace
}  // namespace neuralmesh
