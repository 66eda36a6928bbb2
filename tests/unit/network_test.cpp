// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The network against a referee that edits plain lists of faces: every single operation on small meshes, and
// random sequences of many.
#include "vcg_core/network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "referee.h"
#include "shapes.h"

namespace neuralmesh {
namespace {

using referee::canonical;
using referee::Census;
using referee::census;
using referee::enclosed_volume;
using referee::network_of;
using shapes::Shape;

Shape together(Shape a, const Shape& b, const vcg::Point3d& shift) {
    shapes::append(a, b, shift);
    return a;
}

struct Start {
    const char* name;
    Shape shape;
    int euler;
    int loops;
    int components;
    int genus;
};

std::vector<Start> starts() {
    return {
        {"tetrahedron", shapes::tetrahedron(), 2, 0, 1, 0},
        {"octahedron", shapes::bipyramid(4), 2, 0, 1, 0},
        {"cube", shapes::cube(), 2, 0, 1, 0},
        {"apexes of greatest valence", shapes::bipyramid(15), 2, 0, 1, 0},
        {"icosphere", shapes::icosphere(1), 2, 0, 1, 0},
        {"smallest grid torus", shapes::torus_grid(3, 3), 0, 0, 1, 1},
        {"torus", shapes::torus_grid(6, 4), 0, 0, 1, 1},
        {"triangle", shapes::fan(1), 1, 1, 1, 0},
        {"two triangles", shapes::fan(2), 1, 1, 1, 0},
        {"boundary vertex of greatest valence", shapes::fan(14), 1, 1, 1, 0},
        {"disk", shapes::grid(4, 5), 1, 1, 1, 0},
        {"tube of three corners", shapes::tube(3, 2), 0, 2, 1, 0},
        {"tube", shapes::tube(5, 3), 0, 2, 1, 0},
        {"torus and disk", together(shapes::torus_grid(3, 4), shapes::grid(3, 3), {3, 0, 0}), 1, 1, 2, 1},
    };
}

/// All of the network's own counts against the referee's.
void expect_sound(const Network& network, const Census& expected_topology) {
    ASSERT_EQ(network.validate(), "");
    const Census now = census(network.faces());
    ASSERT_EQ(now.breach, "");
    EXPECT_EQ(now.vertices, network.vertex_count());
    EXPECT_EQ(now.edges, network.edge_count());
    EXPECT_EQ(now.faces, network.face_count());
    EXPECT_EQ(now.components, network.component_count());
    EXPECT_EQ(now.loops, network.boundary_loop_count());
    EXPECT_TRUE(now.same_topology(expected_topology));
    EXPECT_LE(now.greatest_valence(), Ring::kMaxValence);
    for (const auto& entry : now.valence) EXPECT_EQ(entry.second, network.ring(entry.first).valence);
}

bool acceptable(const Census& now, const Census& before) {
    return now.breach.empty() && now.same_topology(before) && now.greatest_valence() <= Ring::kMaxValence;
}

/// The faces after a split, by the words of the contract: \p u takes over part of the fan of \p v.
std::vector<Triangle> split_by_hand(const Network& network, VertexId v, int first, int count, VertexId u) {
    const Ring& ring = network.ring(v);
    const int k = ring.valence;
    std::vector<Triangle> faces = canonical(network.faces());
    for (int i = first; i < first + count - 1; ++i) {
        const Triangle old = canonical({{v, ring[i % k], ring[(i + 1) % k]}}).front();
        *std::find(faces.begin(), faces.end(), old) = {u, ring[i % k], ring[(i + 1) % k]};
    }
    const VertexId begin = ring[first];
    const VertexId end = ring[(first + count - 1) % k];
    const bool from_boundary = ring.open != 0 && first == 0;
    const bool to_boundary = ring.open != 0 && !from_boundary && first + count == k;
    if (!from_boundary) faces.push_back({u, v, begin});
    if (!to_boundary) faces.push_back({u, end, v});
    return canonical(faces);
}

/// The faces after a half-edge collapse.
std::vector<Triangle> collapse_by_hand(const Network& network, VertexId gone, VertexId kept) {
    std::vector<Triangle> faces;
    for (Triangle f : network.faces()) {
        std::replace(f.begin(), f.end(), gone, kept);
        if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) faces.push_back(f);
    }
    return canonical(faces);
}

/// The faces after a flip of an inner edge; \p c follows b around a.
std::vector<Triangle> flip_by_hand(const Network& network, VertexId a, VertexId b, VertexId c, VertexId d) {
    std::vector<Triangle> faces = canonical(network.faces());
    *std::find(faces.begin(), faces.end(), canonical({{a, b, c}}).front()) = {c, a, d};
    *std::find(faces.begin(), faces.end(), canonical({{a, d, b}}).front()) = {d, b, c};
    return canonical(faces);
}

bool on_boundary_edge(const Network& network, VertexId a, VertexId b) {
    const Ring& ring = network.ring(a);
    return ring.open != 0 && (ring[0] == b || ring[ring.valence - 1] == b);
}

TEST(Network, CountsWhatItIsBuiltFrom) {
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        const Network network = network_of(start.shape);
        EXPECT_EQ(canonical(network.faces()), canonical(start.shape.faces));
        EXPECT_EQ(network.vertex_count(), static_cast<int>(start.shape.positions.size()));
        EXPECT_EQ(network.euler_characteristic(), start.euler);
        EXPECT_EQ(network.boundary_loop_count(), start.loops);
        EXPECT_EQ(network.component_count(), start.components);
        EXPECT_EQ(network.genus(), start.genus);
        expect_sound(network, census(start.shape.faces));
    }
}

TEST(Network, RingsRunCounterClockwise) {
    const Network network = network_of(shapes::icosphere(2));
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        const Ring& ring = network.ring(v);
        const vcg::Point3f p = network.position(v);
        for (int i = 0; i < ring.valence; ++i) {
            const vcg::Point3f n = (network.position(ring[i]) - p) ^ (network.position(ring.next(i)) - p);
            EXPECT_GT(n * p, 0);
            EXPECT_EQ(ring.previous(ring.find(ring.next(i))), ring[i]);
        }
    }
}

TEST(Network, OpenRingsRunFromBoundaryToBoundary) {
    const Network network = network_of(shapes::grid(4, 4));
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        const Ring& ring = network.ring(v);
        const vcg::Point3f p = network.position(v);
        const bool at_rim = std::max(std::abs(p[0]), std::abs(p[1])) > 0.49F;
        ASSERT_EQ(ring.open != 0, at_rim);
        if (!at_rim) continue;
        EXPECT_EQ(ring.face_count(), ring.valence - 1);
        EXPECT_EQ(network.ring(ring[0]).open, 1);
        EXPECT_EQ(network.ring(ring[ring.valence - 1]).open, 1);
    }
}

TEST(Network, EverySplitDoesWhatItSaysOrRefuses) {
    int done = 0;
    int refused = 0;
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        const Network before = network_of(start.shape);
        const Census topology = census(before.faces());
        for (VertexId v = 0; v < before.slot_count(); ++v) {
            const int k = before.ring(v).valence;
            for (int first = -1; first <= k; ++first) {
                for (int count = -1; count <= k + 1; ++count) {
                    SCOPED_TRACE(testing::Message() << "v " << v << " of valence " << k << ", first " << first
                                                    << ", count " << count);
                    const bool in_range = first >= 0 && first < k && count >= 1 && count <= k &&
                                          (before.ring(v).open == 0 || first + count <= k);
                    const std::vector<Triangle> expected =
                        in_range ? split_by_hand(before, v, first, count, before.slot_count())
                                 : std::vector<Triangle>();
                    const bool legal = in_range && acceptable(census(expected), topology) &&
                                       census(expected).vertices == before.vertex_count() + 1;
                    ASSERT_EQ(before.can_split(v, first, count), legal);
                    Network network = before;
                    if (!legal) {
                        ++refused;
                        EXPECT_THROW(network.split(v, first, count, {0, 0, 0}), TopologyError);
                        EXPECT_EQ(network.faces(), before.faces());
                        expect_sound(network, topology);
                        continue;
                    }
                    ++done;
                    const VertexId u = network.split(v, first, count, {0.5F, 0.25F, 0.125F});
                    EXPECT_EQ(u, before.slot_count());
                    EXPECT_EQ(network.position(u), vcg::Point3f(0.5F, 0.25F, 0.125F));
                    EXPECT_EQ(canonical(network.faces()), expected);
                    expect_sound(network, topology);
                    ASSERT_TRUE(network.can_collapse(u, v));
                    network.collapse(u, v);
                    EXPECT_EQ(canonical(network.faces()), canonical(before.faces()));
                    expect_sound(network, topology);
                    if (HasFatalFailure()) return;
                }
            }
        }
    }
    EXPECT_GT(done, 2000);
    EXPECT_GT(refused, 1000);
}

TEST(Network, EveryCollapseKeepsTheTopologyOrRefuses) {
    int done = 0;
    int refused = 0;
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        const Network before = network_of(start.shape);
        const Census topology = census(before.faces());
        for (VertexId gone = 0; gone < before.slot_count(); ++gone) {
            for (VertexId kept = 0; kept < before.slot_count(); ++kept) {
                SCOPED_TRACE(testing::Message() << gone << " into " << kept);
                bool legal = gone != kept && before.adjacent(gone, kept) &&
                             (before.ring(gone).open == 0 || on_boundary_edge(before, gone, kept));
                const std::vector<Triangle> expected = collapse_by_hand(before, gone, kept);
                legal = legal && acceptable(census(expected), topology) &&
                        census(expected).vertices == before.vertex_count() - 1;
                ASSERT_EQ(before.can_collapse(gone, kept), legal);
                Network network = before;
                if (!legal) {
                    ++refused;
                    EXPECT_THROW(network.collapse(gone, kept), TopologyError);
                    EXPECT_EQ(network.faces(), before.faces());
                    continue;
                }
                ++done;
                network.collapse(gone, kept);
                EXPECT_FALSE(network.alive(gone));
                EXPECT_EQ(network.position(kept), before.position(kept));
                EXPECT_EQ(canonical(network.faces()), expected);
                expect_sound(network, topology);
                if (HasFatalFailure()) return;
            }
        }
    }
    EXPECT_GT(done, 300);
    EXPECT_GT(refused, 1000);
}

TEST(Network, EveryFlipSwapsOneEdgeOrRefuses) {
    int done = 0;
    int refused = 0;
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        const Network before = network_of(start.shape);
        const Census topology = census(before.faces());
        for (VertexId a = 0; a < before.slot_count(); ++a) {
            for (VertexId b = 0; b < before.slot_count(); ++b) {
                SCOPED_TRACE(testing::Message() << "edge " << a << ", " << b);
                Network network = before;
                if (a == b || !before.adjacent(a, b) || on_boundary_edge(before, a, b)) {
                    ASSERT_FALSE(before.can_flip(a, b));
                    EXPECT_THROW(network.flip(a, b), TopologyError);
                    continue;
                }
                const int i = before.ring(a).find(b);
                const VertexId c = before.ring(a).next(i);
                const VertexId d = before.ring(a).previous(i);
                const std::vector<Triangle> expected = flip_by_hand(before, a, b, c, d);
                const bool legal = !before.adjacent(c, d) && acceptable(census(expected), topology);
                ASSERT_EQ(before.can_flip(a, b), legal);
                if (!legal) {
                    ++refused;
                    EXPECT_THROW(network.flip(a, b), TopologyError);
                    EXPECT_EQ(network.faces(), before.faces());
                    continue;
                }
                ++done;
                network.flip(a, b);
                EXPECT_EQ(canonical(network.faces()), expected);
                expect_sound(network, topology);
                ASSERT_TRUE(network.can_flip(c, d));
                network.flip(c, d);
                EXPECT_EQ(canonical(network.faces()), canonical(before.faces()));
                if (HasFatalFailure()) return;
            }
        }
    }
    EXPECT_GT(done, 300);
    EXPECT_GT(refused, 30);
}

TEST(Network, OperationsOnASphereKeepItOutwards) {
    const Network before = network_of(shapes::icosphere(2));
    const double volume = enclosed_volume(before);
    ASSERT_GT(volume, 0);
    for (VertexId v = 0; v < before.slot_count(); ++v) {
        for (int i = 0; i < before.ring(v).valence; ++i) {
            Network split = before;
            split.split(v, i, 3, (before.position(v) + before.position(before.ring(v).next(i))) / 2);
            EXPECT_NEAR(enclosed_volume(split), volume, 0.05 * volume);
            Network collapsed = before;
            collapsed.collapse(v, before.ring(v)[i]);
            EXPECT_NEAR(enclosed_volume(collapsed), volume, 0.05 * volume);
            Network flipped = before;
            flipped.flip(v, before.ring(v)[i]);
            EXPECT_NEAR(enclosed_volume(flipped), volume, 0.05 * volume);
        }
    }
}

/// One random operation, legal or not; illegal ones must throw and change nothing that validate() can see.
void random_operation(Network& network, Random& random, int least, int most) {
    VertexId v = 0;
    do v = static_cast<VertexId>(random.below(static_cast<std::uint32_t>(network.slot_count())));
    while (!network.alive(v));
    const Ring ring = network.ring(v);
    const int i = static_cast<int>(random.below(ring.valence));
    const VertexId w = ring[i];
    const std::uint32_t dice = random.below(4);
    if (dice == 0 || network.vertex_count() <= least) {
        const int count = 1 + static_cast<int>(random.below(ring.valence));
        const vcg::Point3f where = (network.position(v) + network.position(w)) / 2;
        if (network.can_split(v, i, count)) network.split(v, i, count, where);
    } else if (dice == 1 || network.vertex_count() >= most) {
        if (network.can_collapse(v, w)) network.collapse(v, w);
    } else if (network.can_flip(v, w)) {
        network.flip(v, w);
    }
}

TEST(Network, StaysAManifoldOverTenThousandRandomOperations) {
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        for (const int most : {20, 150}) {
            Network network = network_of(start.shape);
            const Census topology = census(network.faces());
            Random random(static_cast<std::uint64_t>(most));
            for (int step = 0; step < 10000; ++step) {
                random_operation(network, random, 1, most);
                ASSERT_EQ(network.validate(), "") << "at step " << step;
                ASSERT_EQ(network.euler_characteristic(), start.euler) << "at step " << step;
                ASSERT_EQ(network.boundary_loop_count(), start.loops) << "at step " << step;
                ASSERT_EQ(network.component_count(), start.components) << "at step " << step;
                if (step % 200 == 0) expect_sound(network, topology);
                if (HasFatalFailure()) return;
            }
            EXPECT_EQ(network.genus(), start.genus);
        }
    }
}

TEST(Network, ANewVertexIsOfItsParentsRegion) {
    Network network = referee::network_of(shapes::torus_grid(6, 5));
    network.set_region(7, 3);
    EXPECT_EQ(network.ring(network.split(7, 0, 4, network.position(7))).region, 3);
    EXPECT_EQ(network.ring(network.split(8, 0, 4, network.position(8))).region, 0);
}

TEST(Network, UsesTheIdsOfRemovedVerticesAgain) {
    Network network = network_of(shapes::icosphere(1));
    const int slots = network.slot_count();
    network.collapse(7, network.ring(7)[0]);
    EXPECT_FALSE(network.alive(7));
    EXPECT_EQ(network.vertex_count(), slots - 1);
    EXPECT_EQ(network.split(20, 0, 3, {0, 0, 0}), 7);
    EXPECT_TRUE(network.alive(7));
    EXPECT_EQ(network.slot_count(), slots);
    EXPECT_EQ(network.split(20, 0, 3, {0, 0, 0}), slots);
}

TEST(Network, RenumberedAlongACurveIsTheSameMesh) {
    Network network = referee::network_of(shapes::torus_grid(30, 20));
    Random random(5);
    std::vector<VertexId> shuffled = network.along_curve();
    for (std::size_t i = shuffled.size(); i > 1; --i)
        std::swap(shuffled[i - 1], shuffled[random.below(static_cast<std::uint32_t>(i))]);
    network.renumber(shuffled);
    for (int i = 0; i < 50; ++i)  // and again free slots
        if (network.alive(i) && network.can_collapse(i, network.ring(i)[0]))
            network.collapse(i, network.ring(i)[0]);
    const Network before = network;
    const std::vector<VertexId> order = network.along_curve();
    ASSERT_EQ(static_cast<int>(order.size()), network.vertex_count());
    const std::vector<VertexId> moved = network.renumber(order);
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.slot_count(), before.vertex_count());
    double length_before = 0;
    double length = 0;
    for (VertexId v = 0; v < before.slot_count(); ++v) {
        const VertexId now = moved[static_cast<std::size_t>(v)];
        ASSERT_EQ(now >= 0, before.alive(v));
        if (now < 0) continue;
        EXPECT_EQ(order[static_cast<std::size_t>(now)], v);
        EXPECT_EQ(network.position(now), before.position(v));
        ASSERT_EQ(network.ring(now).valence, before.ring(v).valence);
        for (int i = 0; i < before.ring(v).valence; ++i)
            EXPECT_EQ(network.ring(now)[i], moved[static_cast<std::size_t>(before.ring(v)[i])]);
        if (v > 0 && before.alive(v - 1))
            length_before += static_cast<double>((before.position(v) - before.position(v - 1)).Norm());
        if (now > 0)
            length += static_cast<double>((network.position(now) - network.position(now - 1)).Norm());
    }
    EXPECT_LT(4 * length, length_before);
}

TEST(Network, CompactRenumbersAndChangesNothingElse) {
    Network network = network_of(shapes::torus_grid(8, 6));
    Random random(5);
    for (int step = 0; step < 2000; ++step) random_operation(network, random, 10, 60);
    for (int step = 0; step < 500; ++step) random_operation(network, random, 1, 1);
    ASSERT_LT(network.vertex_count(), network.slot_count());
    const Network before = network;
    const std::vector<VertexId> moved = network.compact();

    ASSERT_EQ(moved.size(), static_cast<std::size_t>(before.slot_count()));
    EXPECT_EQ(network.slot_count(), before.vertex_count());
    expect_sound(network, census(before.faces()));
    VertexId next = 0;
    for (VertexId v = 0; v < before.slot_count(); ++v) {
        const VertexId now = moved[static_cast<std::size_t>(v)];
        ASSERT_EQ(now, before.alive(v) ? next : -1);
        if (now < 0) continue;
        ++next;
        EXPECT_EQ(network.position(now), before.position(v));
    }
    std::vector<Triangle> expected = before.faces();
    for (Triangle& f : expected)
        for (VertexId& v : f) v = moved[static_cast<std::size_t>(v)];
    EXPECT_EQ(network.faces(), expected);
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.can_split(v, 0, 2)) continue;
        EXPECT_EQ(network.split(v, 0, 2, {0, 0, 0}), before.vertex_count());
        break;
    }
    EXPECT_EQ(network.validate(), "");
}

TEST(Network, ListsEachFaceOnceFromItsSmallestVertex) {
    const std::vector<Triangle> faces = network_of(shapes::icosphere(1)).faces();
    ASSERT_EQ(faces.size(), 80U);
    for (std::size_t i = 0; i < faces.size(); ++i) {
        EXPECT_LT(faces[i][0], std::min(faces[i][1], faces[i][2]));
        EXPECT_LE(faces[i == 0 ? 0 : i - 1][0], faces[i][0]);
    }
    EXPECT_EQ(canonical(faces).size(), std::set<Triangle>(faces.begin(), faces.end()).size());
}

void expect_refused(Shape shape, const char* why) { EXPECT_THROW(network_of(shape), TopologyError) << why; }

TEST(Network, RefusesWhatIsNoOrientedManifold) {
    Shape s = shapes::tetrahedron();
    std::swap(s.faces[0][0], s.faces[0][1]);
    expect_refused(s, "one face turned over");

    s = shapes::tetrahedron();
    s.faces.push_back(s.faces[0]);
    expect_refused(s, "a face twice");

    s = shapes::grid(3, 3);
    s.positions.emplace_back(0.0, 0.0, 1.0);
    s.faces.push_back({0, 4, 9});
    expect_refused(s, "three faces at an edge");

    s = shapes::tetrahedron();
    s.positions.emplace_back(3.0, 0.0, 0.0);
    expect_refused(s, "a vertex without faces");

    s = shapes::tetrahedron();
    s.faces[0][0] = 4;
    expect_refused(s, "a face naming a vertex that does not exist");
    s.faces[0][0] = -1;
    expect_refused(s, "a face naming a negative vertex");

    s = shapes::tetrahedron();
    s.faces[0][1] = s.faces[0][0];
    expect_refused(s, "a face with a corner twice");

    expect_refused(shapes::bipyramid(16), "a closed valence of 16");
    expect_refused(shapes::fan(15), "an open valence of 16");
    expect_refused(shapes::fan(40), "an open valence of 41");
    expect_refused({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}, "a closed valence of 2");

    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        s = shapes::tetrahedron();
        s.positions[2][1] = bad;
        expect_refused(s, "a position that is not finite");
    }
}

TEST(Network, RefusesTwoFansThatMeetInOneVertex) {
    for (const Shape& part : {shapes::tetrahedron(), shapes::fan(3)}) {
        Shape s = together(part, part, {5, 0, 0});
        const auto twin = static_cast<VertexId>(part.positions.size());
        for (Triangle& f : s.faces)
            for (VertexId& v : f) {
                if (v == twin) v = 0;
                if (v > twin) --v;
            }
        s.positions.erase(s.positions.begin() + twin);
        expect_refused(s, "a pinched vertex");
    }
}

TEST(Network, ValidateNamesAPositionThatIsNotFinite) {
    Network network = network_of(shapes::cube());
    network.set_position(5, {0, std::numeric_limits<float>::quiet_NaN(), 0});
    EXPECT_NE(network.validate().find("vertex 5"), std::string::npos);
}

TEST(Network, AnEmptyNetworkIsSound) {
    const Network network;
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.vertex_count(), 0);
    EXPECT_EQ(network.euler_characteristic(), 0);
    EXPECT_TRUE(network.faces().empty());
}

}  // namespace
}  // namespace neuralmesh
