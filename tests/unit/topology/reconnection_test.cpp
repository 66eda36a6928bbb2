// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Membranes that are found, and what takes their place: bridges are cut, tubes with plugs are joined.
#include "vcg_core/topology/learned_topology.h"

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/runs.h"
#include "vcg_core/mesh/boundary_loops.h"

namespace neuralmesh::reconnection_test {

/// A ring of vertices around a point.
struct Hoop {
    vcg::Point3d centre, across, up;  ///< the last two have the length of the radius
};

/// The surface through the hoops, of \p around vertices each, closed by patches at both ends.
Network swept(const TargetSpace& target, const std::vector<Hoop>& hoops, int around) {
    constexpr double kPi = 3.14159265358979;
    Shape shape;
    const auto at = [&](std::size_t hoop, int i) { return static_cast<int>(hoop) * around + i % around; };
    for (std::size_t h = 0; h < hoops.size(); ++h)
        for (int i = 0; i < around; ++i) {
            const double turn = 2 * kPi * i / around;
            shape.positions.push_back(hoops[h].centre + hoops[h].across * std::cos(turn) +
                                      hoops[h].up * std::sin(turn));
            if (h == 0) continue;
            shape.faces.push_back({at(h - 1, i), at(h, i), at(h, i + 1)});
            shape.faces.push_back({at(h - 1, i), at(h, i + 1), at(h - 1, i + 1)});
        }
    Network network = network_in_frame(target, shape);
    for (const Rim& rim : boundary_loops(network.slot_count(), network.faces())) {
        const Surface surface(network);
        const PerFace<char> none(surface.face_count(), 0);
        network.exchange_faces({}, closing_patches({rim}, {network, surface, none}));
    }
    return network;
}

/// Two unit spheres, 3 apart, with a bridge between them.
Network bridged(const TargetSpace& target) {
    std::vector<Hoop> hoops;
    const auto add = [&](double x, double radius) {
        hoops.push_back({{1.5 + x, 0, 0}, {0, radius, 0}, {0, 0, radius}});
    };
    for (double angle = 0.15; angle < 2.8; angle += 0.15) add(-1.5 - std::cos(angle), std::sin(angle));
    for (double x = -0.5; x < 0.55; x += 0.1) add(x, 0.35);
    for (double angle = 2.7; angle > 0.1; angle -= 0.15) add(1.5 + std::cos(angle), std::sin(angle));
    return swept(target, hoops, 12);
}

/// A torus with a gap of 20 degrees and a plug on either side of it.
Network plugged(const TargetSpace& target) {
    constexpr double kDegree = 3.14159265358979 / 180;
    std::vector<Hoop> hoops;
    const auto add = [&](double degrees, double radius) {
        const vcg::Point3d out(std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0);
        hoops.push_back({out, out * radius, {0, 0, radius}});
    };
    for (const double radius : {0.08, 0.16, 0.24, 0.32}) add(10, radius);
    for (int degrees = 10; degrees <= 350; degrees += 10) add(degrees, 0.4);
    for (const double radius : {0.32, 0.24, 0.16, 0.08}) add(350, radius);
    return swept(target, hoops, 12);
}

std::optional<TopologyEvidence> evidence(const Network& network, const TargetSpace& target) {
    Random random(1);
    return topology_evidence(network, target, random, one_thread());
}

/// Applies what topology_changes() finds until it finds no more. \return the number of changes
int learn(Network& network, const TargetSpace& target, const TopologyRules& rules = {}) {
    Random random(1);
    int changes = 0;
    for (int round = 0; round < 10; ++round) {
        const auto now = topology_evidence(network, target, random, one_thread());
        if (!now) return changes;
        const auto found = topology_changes(network, target, *now, rules, one_thread(), unwatched());
        if (found.empty()) return changes;
        for (const Reconnection& change : found) {
            if (!network.can_exchange_faces(change.gone, change.added)) continue;
            network.exchange_faces(change.gone, change.added);
            EXPECT_EQ(network.validate(), "");
            ++changes;
        }
    }
    ADD_FAILURE() << "It oscillates.";
    return changes;
}

TEST(Reconnection, ABridgeBetweenTwoSpheresIsCut) {
    const TargetSpace target = target_of(shapes::two_sphere_cloud(10000, 3));
    Network network = bridged(target);
    ASSERT_EQ(network.component_count(), 1);
    EXPECT_GT(learn(network, target), 0);
    EXPECT_EQ(topology_of(network), (Topology{2, 0, 0}));
    EXPECT_EQ(learn(network, target), 0);
}

TEST(Reconnection, ATubeWithTwoPlugsIsJoined) {
    const TargetSpace target = target_of(shapes::torus_cloud(20000));
    Network network = plugged(target);
    ASSERT_EQ(network.genus(), 0);
    EXPECT_GT(learn(network, target), 0);
    EXPECT_EQ(topology_of(network), kRing);
}

TEST(Reconnection, ObeysAStop) {
    const TargetSpace target = target_of(shapes::torus_cloud(20000));
    const Network network = plugged(target);
    const auto now = evidence(network, target);
    Watch stop(0);
    EXPECT_TRUE(topology_changes(network, target, *now, {}, one_thread(), stop).empty());
    EXPECT_EQ(stop.calls, 1);
    EXPECT_FALSE(topology_changes(network, target, *now, {}, one_thread(), unwatched()).empty());
}

// Clusters of points in a ball, like leaves: a crumpled mesh among them has membranes all around.
TEST(Reconnection, LeavesPointsThatFillSpaceAlone) {
    Cloud cloud;
    Random random(1);
    for (int leaf = 0; leaf < 2500; ++leaf) {
        const vcg::Point3d centre = shapes::in_ball(random);
        for (int i = 0; i < 16; ++i) cloud.push_back(centre + shapes::in_ball(random) * 0.03);
    }
    const TargetSpace target = target_of(cloud);
    Shape crumpled = shapes::icosphere(4);
    for (vcg::Point3d& p : crumpled.positions) p = p * (0.5 + 0.5 * shapes::unit(random));
    const Network network = network_in_frame(target, crumpled);
    const auto now = topology_evidence(network, target, random, one_thread());
    ASSERT_GT(now->membranes.size(), 100U);
    EXPECT_LT(topology_changes(network, target, *now, {}, one_thread(), unwatched()).size(),
              now->membranes.size() / 20);
}

// With 74 points per vertex.
TEST(Reconnection, HandlesFormOnACoarseMeshIfTheyMay) {
    const TargetSpace target = target_of(shapes::torus_cloud(40000));
    Network network = plugged(target);
    ASSERT_GT(40000, 40 * network.vertex_count());
    EXPECT_EQ(learn(network, target), 0);
    TopologyRules rules;
    rules.from_tetrahedron = true;
    EXPECT_GT(learn(network, target, rules), 0);
    EXPECT_EQ(network.genus(), 1);
}

/// The corners of a regular tetrahedron on the unit sphere.
const std::array<vcg::Point3d, 4>& four_ways() {
    static const double k = 1 / std::sqrt(3.0);
    static const std::array<vcg::Point3d, 4> ways{{{k, k, k}, {k, -k, -k}, {-k, k, -k}, {-k, -k, k}}};
    return ways;
}

/// A hollow sphere, its wall from \p inner to 1, with four round openings.
Cloud four_openings(int count, double inner) {
    const double rim = std::cos(0.7);  // the openings' half angle
    Cloud cloud;
    for (const vcg::Point3d& p : shapes::sphere_cloud(count)) {
        double nearest = -1;
        for (const vcg::Point3d& way : four_ways()) nearest = std::max(nearest, way * p);
        if (nearest > rim) continue;
        cloud.push_back(p);
        cloud.push_back(p * inner);
    }
    return cloud;
}

// Any two of the four joined leave a tube in which the other two are membranes still.
TEST(Reconnection, MembranesOverOneHollowGoTogether) {
    const TargetSpace target = target_of(four_openings(20000, 0.93));
    Network network = network_in_frame(target, shapes::icosphere(3));
    TopologyRules rules;
    rules.from_tetrahedron = true;
    EXPECT_GT(learn(network, target, rules), 0);
    EXPECT_EQ(topology_of(network), (Topology{1, 3, 0}));
}

/// A sphere that the points cover only below \p top; both from -1 to 1.
struct Cut {
    explicit Cut(double top)
        : target(target_of(open_shapes::sphere_below(top, 20000))),
          ball(network_in_frame(target, shapes::icosphere(3))) {}

    std::vector<std::vector<Triangle>> to_open(float opens_from) const {
        TopologyRules rules;
        rules.opens_from = opens_from;
        return membranes_to_open(*evidence(ball, target), rules);
    }

    TargetSpace target;
    Network ball;
};

TEST(MembranesToOpen, AreThoseThatCoverAWideOpening) {
    const Cut cut(0.7);
    const auto found = cut.to_open(0.3F);  // the opening has .42 diagonals
    ASSERT_EQ(found.size(), 1U);
    Network open = cut.ball;
    ASSERT_TRUE(open.can_exchange_faces(found.front(), {}));
    open.exchange_faces(found.front(), {});
    EXPECT_EQ(topology_of(open), kDisc);
    EXPECT_TRUE(cut.to_open(0.6F).empty());
    EXPECT_TRUE(Cut(2).to_open(0).empty());
}

TEST(MembranesToOpen, AreNotThoseThatFaceAnother) {
    const TargetSpace target = target_of(shapes::torus_cloud(20000));
    TopologyRules rules;
    rules.opens_from = 0;
    EXPECT_TRUE(membranes_to_open(*evidence(plugged(target), target), rules).empty());
}

TEST(Reconnection, RightMeshesStay) {
    const TargetSpace sphere = target_of(shapes::sphere_cloud(20000, 0.01));
    Network ball = network_in_frame(sphere, shapes::icosphere(3));
    EXPECT_EQ(learn(ball, sphere), 0);
    const TargetSpace torus = target_of(shapes::torus_cloud(20000, 0.01));
    Network ring = network_in_frame(torus, shapes::torus_grid(40, 16));
    EXPECT_EQ(learn(ring, torus), 0);
}

TEST(Reconnection, LeavesMeshesWithBoundaryAndSparseCloudsAlone) {
    const TargetSpace target = target_of(shapes::two_sphere_cloud(10000, 3));
    Network open = bridged(target);
    open.exchange_faces({open.faces().front()}, {});
    EXPECT_EQ(learn(open, target), 0);
    const TargetSpace sparse = target_of(shapes::two_sphere_cloud(300, 3));
    Network network = bridged(sparse);
    EXPECT_EQ(learn(network, sparse), 0);
}

TEST(Membranes, AreCompletedSoThatTheRestIsAManifold) {
    const TargetSpace target = target_of(shapes::two_sphere_cloud(5000, 3));
    const Network network = bridged(target);
    const Surface surface(network);
    Random random(3);
    const FaceSignals support =
        face_signals(network, surface, fair_sample(target, 10000, random), one_thread());
    int completed = 0;
    for (int run = 0; run < 200; ++run) {
        Membrane membrane;
        std::set<int> faces;
        const auto count = static_cast<std::uint32_t>(surface.face_count());
        for (int i = 0; i < 1 + run / 10; ++i) {
            const auto around = surface.faces_around(
                surface.faces[static_cast<int>(random.below(i < 2 ? 40 : count / 8))][0]);
            faces.insert(around.begin(), around.end());
        }
        membrane.faces.assign(faces.begin(), faces.end());
        if (!complete(surface, support, membrane)) continue;
        ++completed;
        std::vector<Triangle> gone;
        for (const int f : membrane.faces) gone.push_back(surface.faces[f]);
        ASSERT_TRUE(network.can_exchange_faces(gone, {}));
        Network rest = network;
        rest.exchange_faces(gone, {});
        ASSERT_EQ(rest.validate(), "");
        EXPECT_EQ(rest.boundary_loop_count(), static_cast<int>(membrane.rims.size()));
        for (const Rim& rim : membrane.rims)
            for (std::size_t i = 0; i < rim.size(); ++i)
                EXPECT_EQ(rest.ring(rim[i])[0], rim[(i + 1) % rim.size()]);
    }
    EXPECT_GT(completed, 100);
}

TEST(TopologyStages, ArePassedOnceEachAndEndWithTheGoal) {
    std::vector<int> passed;
    TopologyStages stages(400, 5000);
    for (int vertices = 400; vertices <= 5000; ++vertices)
        if (stages.pass(vertices)) passed.push_back(vertices);
    EXPECT_EQ(passed, (std::vector<int>{600, 1200, 2400, 5000}));
    for (int vertices = 4000; vertices <= 6000; ++vertices) EXPECT_FALSE(stages.pass(vertices));
    TopologyStages small(4, 100);
    EXPECT_FALSE(small.pass(99));
    EXPECT_TRUE(small.pass(100));
    EXPECT_FALSE(small.pass(100));
    TopologyStages none(5000, 5000);
    EXPECT_FALSE(none.pass(5000));
}

TEST(TopologyStages, EndWhereThePointsAreTooFew) {
    const TargetSpace target = target_of(shapes::two_sphere_cloud(5000, 3));
    EXPECT_EQ(most_examined(target), 10000 / 100 * 96 / 6);
    EXPECT_TRUE(evidence(bridged(target), target));
    const TargetSpace few = target_of(shapes::two_sphere_cloud(1000, 3));
    const Network network = bridged(few);
    ASSERT_GT(network.vertex_count(), most_examined(few));
    EXPECT_FALSE(evidence(network, few));
}

}  // namespace neuralmesh::reconnection_test
