// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Faces without signals: what they win, which go together, and what patches gain.
#include "vcg_core/topology/membranes.h"
#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/topology/face_signals.h"
#include "vcg_core/topology/surroundings.h"

namespace neuralmesh::membranes_test {

/// The points of the unit sphere that are lower than \p top.
Cloud lower_sphere(int count, double top) {
    Cloud cloud = open_shapes::sphere_below(top, count);
    cloud.emplace_back(0, 0, 1);  // so that the frame is that of the whole sphere
    return cloud;
}

/// A network in the frame of a target, and the signals that its faces win, of \p most at the most.
struct Covered {
    Covered(TargetSpace given, const Shape& shape, std::size_t most)
        : target(std::move(given)), network(network_in_frame(target, shape)), surface(network) {
        Random random(1);
        support = face_signals(network, surface, fair_sample(target, most, random), one_thread());
    }

    TargetSpace target;
    Network network;
    Surface surface;
    FaceSignals support;
};

TEST(FairSample, HasEveryPointOfACloudOnceAtMost) {
    const TargetSpace target = target_of(shapes::sphere_cloud(1000));
    Random random(1);
    std::vector<Vector3> signals = fair_sample(target, 700, random);
    ASSERT_EQ(signals.size(), 700U);
    const auto before = [](const Vector3& a, const Vector3& b) {
        return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    std::sort(signals.begin(), signals.end(), before);
    EXPECT_TRUE(std::adjacent_find(signals.begin(), signals.end()) == signals.end());
    EXPECT_EQ(fair_sample(target, 1001, random).size(), 1000U);
    EXPECT_EQ(fair_sample(target_of(shapes::cube()), 1001, random).size(), 1001U) << "drawn from faces";
}

TEST(FaceSignals, GiveEverySignalToTheNearestFace) {
    const Covered ball(target_of(shapes::sphere_cloud(500, 0.05)), shapes::icosphere(2), 1000);
    const auto& [target, network, surface, support] = ball;
    int sum = 0;
    for (int f = 0; f < surface.face_count(); ++f) {
        EXPECT_EQ(support.of(f).size(), support.wins[f]);
        sum += support.wins[f];
        for (const FaceSignals::Assigned& s : support.of(f)) {
            EXPECT_EQ(s.squared_distance,
                      nearest_face(s.point, surface.positions, surface.faces).foot.squared_distance);
            EXPECT_EQ(s.squared_distance, foot_on_triangle(s.point, surface.corner(f, 0),
                                                           surface.corner(f, 1), surface.corner(f, 2))
                                              .squared_distance);
        }
    }
    EXPECT_EQ(sum, 500);
}

TEST(FaceSignals, ExpectAsManyAsThereAreWhereThePointsAreEven) {
    const Covered ball(target_of(shapes::sphere_cloud(50000)), shapes::icosphere(2), 100000);
    for (int f = 0; f < ball.surface.face_count(); ++f) {
        EXPECT_NEAR(ball.support.expected[f], 50000.0F * 1 / 320, 50);
        EXPECT_FALSE(ball.support.lacks_support(f));
    }
}

TEST(FaceSignals, AMembraneLacksSupportHoweverWideItIs) {
    const Covered ball(target_of(lower_sphere(20000, -0.2)), shapes::icosphere(3), 100000);
    const auto& [target, network, surface, support] = ball;
    int lacking = 0;
    for (int f = 0; f < surface.face_count(); ++f) {
        const float z = (surface.corner(f, 0) + surface.corner(f, 1) + surface.corner(f, 2))[2] / 3;
        const float unit = surface.corner(f, 0).norm();
        if (z < -0.3F * unit) {
            EXPECT_FALSE(support.lacks_support(f));
        }
        if (z > 0.1F * unit) lacking += support.lacks_support(f) ? 1 : 0;
    }
    // All but the face at the single point on top.
    EXPECT_GT(lacking, 500);
}

// Membranes by hand on a ball: which go together, and that they are taken apart.

/// A ball covered evenly, and the faces around its vertices as membranes.
struct Ball : Covered {
    Ball() : Covered(target_of(shapes::sphere_cloud(20000)), shapes::icosphere(3), 20000) {}
    Membrane around(VertexId v, float missing, bool certain = true) const {
        Membrane membrane;
        const auto faces = surface.faces_around(v);
        membrane.faces.assign(faces.begin(), faces.end());
        std::sort(membrane.faces.begin(), membrane.faces.end());
        EXPECT_TRUE(complete(surface, support, membrane));
        membrane.missing = missing;
        membrane.certain = certain;
        return membrane;
    }
    /// A vertex at so many edges from another, along its first neighbours.
    VertexId away(VertexId v, int edges) const {
        for (VertexId before = v; edges > 0; --edges) {
            VertexId next = network.ring(v)[0];
            float farthest = 0;
            for (const VertexId u : network.ring(v)) {
                const float far = (surface.positions[u] - surface.positions[before]).norm();
                if (far > farthest) farthest = far, next = u;
            }
            v = next;
        }
        return v;
    }
};

TEST(MembraneGroups, AreThreeAndMoreCertainOnesNearEachOther) {
    const Ball ball;
    const float edge = mean_edge_length(ball.surface);
    // 0, 4 and 8 edges from the first: each is near the next. The corner on the other side is near to none.
    std::vector<Membrane> membranes{ball.around(0, 5), ball.around(ball.away(0, 4), 9),
                                    ball.around(ball.away(0, 8), 7)};
    EXPECT_EQ(membrane_groups(ball.surface, membranes, edge, 5), (std::vector<std::vector<int>>{{1, 2, 0}}));
    EXPECT_TRUE(membrane_groups(ball.surface, membranes, edge, 2).empty());
    EXPECT_TRUE(membrane_groups(ball.surface, membranes, edge / 4, 5).empty());
    membranes[1].certain = false;
    EXPECT_TRUE(membrane_groups(ball.surface, membranes, edge, 5).empty());
}

TEST(MembraneGroups, AreTakenApartWhereTheyTouch) {
    const Ball ball;
    std::vector<Membrane> membranes{ball.around(0, 5), ball.around(ball.away(0, 2), 5)};
    const std::size_t before = membranes[1].faces.size();
    const std::vector<int> first = membranes[0].faces;
    ASSERT_TRUE(take_apart(ball.surface, ball.support, membranes));
    EXPECT_EQ(membranes[0].faces, first);
    EXPECT_LT(membranes[1].faces.size(), before);
    std::set<VertexId> seen;
    for (const Membrane& membrane : membranes)
        for (const Rim& rim : membrane.rims)
            for (const VertexId v : rim) EXPECT_TRUE(seen.insert(v).second);
    std::vector<Membrane> same{membranes[0], membranes[0]};
    EXPECT_FALSE(take_apart(ball.surface, ball.support, same));
}

// What patches gain, against the plain sum over all signals and all faces.

/// The cost of the whole surface of \p faces.
double plain_cost(const Surface& surface, const FaceSignals& support, const std::vector<Triangle>& faces,
                  float edge) {
    std::vector<float> wins(faces.size(), 0);
    double cost = 0;
    for (const FaceSignals::Assigned& s : support.signals) {
        const Hit hit = nearest_face(s.point, surface.positions, faces);
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
    const std::vector<Vector3> sample = fair_sample(target, 4000, random);
    const float edge = mean_edge_length(surface);
    for (const VertexId centre : {100, 300, 500}) {
        SCOPED_TRACE(centre);
        const std::vector<Vector3> signals = deep ? with_deep_ones(sample, network, centre) : sample;
        const FaceSignals support = face_signals(network, surface, signals, one_thread());
        Membrane membrane;  // the faces of two rings: the patch has more faces than one group of boxes
        for (const VertexId v : network.ring(centre))
            for (const int f : surface.faces_around(v)) membrane.faces.push_back(f);
        ASSERT_TRUE(complete(surface, support, membrane));
        PerFace<char> out(surface.face_count(), 0);
        std::vector<Triangle> patched;
        for (const int f : membrane.faces) out[f] = 1;
        const auto patch = closing_patches({membrane.rims.front()}, {network, surface, out});
        ASSERT_GT(patch.size(), 8U);
        for (int f = 0; f < surface.face_count(); ++f)
            if (out[f] == 0) patched.push_back(surface.faces[f]);
        patched.insert(patched.end(), patch.begin(), patch.end());
        std::vector<Triangle> whole;
        for (int f = 0; f < surface.face_count(); ++f) whole.push_back(surface.faces[f]);
        const Surroundings around(surface, FaceTree(surface, one_thread()), support, membrane.faces, edge);
        const double plain =
            plain_cost(surface, support, whole, edge) - plain_cost(surface, support, patched, edge);
        EXPECT_GT(std::abs(plain), 0.5);
        EXPECT_NEAR(around.gain(patch), plain, 1e-2);
    }
}

TEST(Surroundings, TellTheDifferenceThatAPatchMakes) { expect_the_plain_gain(false); }

TEST(Surroundings, CountSignalsThatAPatchWinsFromFacesSomeWayOff) { expect_the_plain_gain(true); }

}  // namespace neuralmesh::membranes_test
