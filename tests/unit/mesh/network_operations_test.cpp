// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Split, collapse, flip and exchange of faces against the same on plain lists of faces: all possible ones on
// small meshes, and long random sequences.
#include "tests/unit/support/network_starts.h"

namespace neuralmesh::network_operations_test {

/// True if \p faces are a manifold of the topology and the number of vertices given, with allowed valences.
bool acceptable(const std::vector<Triangle>& faces, const Census& topology, int vertices) {
    const Census now = census(faces);
    return now.breach.empty() && now.same_topology(topology) && now.vertices == vertices &&
           now.greatest_valence() <= Ring::kMaxValence;
}

/// How many operations of a test were carried out and how many refused.
struct Tally {
    int done = 0;
    int refused = 0;
};

/// Applies \p operation to a copy of \p before. If legal, the result must have the faces \p expected, else
/// the operation must throw and change nothing. \return the network after the operation
template <class Operation>
Network attempt(const Network& before, bool legal, const std::vector<Triangle>& expected, Tally& tally,
                const Operation& operation) {
    Network network = before;
    ++(legal ? tally.done : tally.refused);
    if (legal) {
        operation(network);
        EXPECT_EQ(canonical(network.faces()), expected);
        expect_sound(network, census(before.faces()));
    } else {
        EXPECT_THROW(operation(network), TopologyError);
        EXPECT_EQ(network.faces(), before.faces());
        EXPECT_EQ(network.validate(), "");
    }
    return network;
}

/// The faces after a split: \p u takes over part of the fan of \p v.
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

void try_split(const Network& before, VertexId v, int first, int count, Tally& tally) {
    const int k = before.ring(v).valence;
    SCOPED_TRACE(testing::Message() << "v " << v << " of valence " << k << ", first " << first << ", count "
                                    << count);
    const bool in_range = first >= 0 && first < k && count >= 1 && count <= k &&
                          (before.ring(v).open == 0 || first + count <= k);
    std::vector<Triangle> expected;
    if (in_range) expected = split_by_hand(before, v, first, count, before.slot_count());
    const bool legal = in_range && acceptable(expected, census(before.faces()), before.vertex_count() + 1);
    ASSERT_EQ(before.can_split(v, first, count), legal);
    const vcg::Point3f where(0.5F, 0.25F, 0.125F);
    Network network =
        attempt(before, legal, expected, tally, [&](Network& net) { net.split(v, first, count, where); });
    if (!legal) return;
    const VertexId u = before.slot_count();
    ASSERT_TRUE(network.alive(u));
    EXPECT_EQ(network.position(u), where);
    ASSERT_TRUE(network.can_collapse(u, v));
    network.collapse(u, v);
    EXPECT_EQ(canonical(network.faces()), canonical(before.faces()));
    expect_sound(network, census(before.faces()));
}

TEST(Network, EverySplitIsExactOrRefused) {
    Tally tally;
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        const Network network = network_of(start.shape);
        for (const VertexId v : network.vertices()) {
            const int k = network.ring(v).valence;
            for (int first = -1; first <= k; ++first)
                for (int count = -1; count <= k + 1; ++count) {
                    try_split(network, v, first, count, tally);
                    if (HasFatalFailure()) return;
                }
        }
    }
    EXPECT_GT(tally.done, 2000);
    EXPECT_GT(tally.refused, 1000);
}

void try_collapse(const Network& before, VertexId gone, VertexId kept, Tally& tally) {
    SCOPED_TRACE(testing::Message() << gone << " into " << kept);
    const std::vector<Triangle> expected = collapse_by_hand(before, gone, kept);
    const bool legal = gone != kept && before.adjacent(gone, kept) &&
                       (before.ring(gone).open == 0 || on_boundary_edge(before, gone, kept)) &&
                       acceptable(expected, census(before.faces()), before.vertex_count() - 1);
    ASSERT_EQ(before.can_collapse(gone, kept), legal);
    const Network network =
        attempt(before, legal, expected, tally, [&](Network& net) { net.collapse(gone, kept); });
    EXPECT_EQ(network.alive(gone), !legal);
    EXPECT_EQ(network.position(kept), before.position(kept));
}

void try_flip(const Network& before, VertexId a, VertexId b, Tally& tally) {
    SCOPED_TRACE(testing::Message() << "edge " << a << ", " << b);
    const auto flip = [&](Network& net) { net.flip(a, b); };
    if (a == b || !before.adjacent(a, b) || on_boundary_edge(before, a, b)) {
        ASSERT_FALSE(before.can_flip(a, b));
        attempt(before, false, {}, tally, flip);
        return;
    }
    const int i = before.ring(a).find(b);
    const VertexId c = before.ring(a).next(i);
    const VertexId d = before.ring(a).previous(i);
    const std::vector<Triangle> expected = flip_by_hand(before, a, b, c, d);
    const bool legal =
        !before.adjacent(c, d) && acceptable(expected, census(before.faces()), before.vertex_count());
    ASSERT_EQ(before.can_flip(a, b), legal);
    Network network = attempt(before, legal, expected, tally, flip);
    if (!legal) return;
    ASSERT_TRUE(network.can_flip(c, d));
    network.flip(c, d);
    EXPECT_EQ(canonical(network.faces()), canonical(before.faces()));
}

/// Calls \p operation for every pair of vertices of every start.
template <class Operation>
Tally try_all_pairs(const Operation& operation) {
    Tally tally;
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        const Network network = network_of(start.shape);
        for (const VertexId a : network.vertices())
            for (const VertexId b : network.vertices()) {
                operation(network, a, b, tally);
                if (testing::Test::HasFatalFailure()) return tally;
            }
    }
    return tally;
}

TEST(Network, EveryCollapseIsExactOrRefused) {
    const Tally tally = try_all_pairs(try_collapse);
    EXPECT_GT(tally.done, 300);
    EXPECT_GT(tally.refused, 1000);
}

TEST(Network, EveryFlipIsExactOrRefused) {
    const Tally tally = try_all_pairs(try_flip);
    EXPECT_GT(tally.done, 300);
    EXPECT_GT(tally.refused, 1000);
}

TEST(Network, OperationsOnAFreeIdAreRefused) {
    Network network = network_of(shapes::icosphere(1));
    constexpr VertexId kGone = 0;
    network.collapse(kGone, network.ring(kGone)[0]);
    Tally tally;
    for (const int count : {0, 1, 3}) try_split(network, kGone, 0, count, tally);
    for (const VertexId v : network.vertices())
        for (const auto& [a, b] : {std::pair(kGone, v), std::pair(v, kGone)}) {
            try_flip(network, a, b, tally);
            EXPECT_FALSE(network.can_collapse(a, b));
            EXPECT_THROW(network.collapse(a, b), TopologyError);
        }
    EXPECT_EQ(tally.done, 0);
    EXPECT_EQ(network.validate(), "");
}

/// Tries the operation at every vertex of the starts. \p by_hand changes the faces and returns whether the
/// vertices allow that; \p can and \p operation are the network's.
template <class ByHand>
void try_all_vertices(const ByHand& by_hand, bool (Network::*can)(VertexId) const,
                      void (Network::*operation)(VertexId)) {
    Tally tally;
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        const Network before = network_of(start.shape);
        for (const VertexId v : before.vertices()) {
            std::vector<Triangle> expected = canonical(before.faces());
            const bool legal = by_hand(before, v, expected) &&
                               acceptable(expected, census(before.faces()), before.vertex_count());
            ASSERT_EQ((before.*can)(v), legal) << v;
            attempt(before, legal, canonical(expected), tally, [&](Network& net) { (net.*operation)(v); });
        }
    }
    EXPECT_GT(tally.done, 20);
    EXPECT_GT(tally.refused, 20);
}

// A notch is filled by one face: the boundary gets one edge less, the topology stays.
TEST(Network, EveryFilledNotchIsExactOrRefused) {
    const auto by_hand = [](const Network& network, VertexId v, std::vector<Triangle>& faces) {
        const Ring& ring = network.ring(v);
        if (ring.open != 0) faces.push_back({v, ring[ring.valence - 1], ring[0]});
        return ring.open != 0 && ring.valence > 2;
    };
    try_all_vertices(by_hand, &Network::can_fill_notch, &Network::fill_notch);
}

// An opened face makes its inner corner a boundary vertex: the boundary gets one edge more, the topology
// stays.
TEST(Network, EveryOpenedFaceIsExactOrRefused) {
    const auto by_hand = [](const Network& network, VertexId v, std::vector<Triangle>& faces) {
        const Ring& ring = network.ring(v);
        const Triangle gone = canonical({{v, ring[0], ring[1]}}).front();
        faces.erase(std::remove(faces.begin(), faces.end(), gone), faces.end());
        return ring.open != 0 && network.ring(ring[1]).open == 0;
    };
    try_all_vertices(by_hand, &Network::can_open_face, &Network::open_face);
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
                if (step % 500 == 499) network.compact();
                ASSERT_EQ(network.validate(), "") << "at step " << step;
                ASSERT_EQ(network.euler_characteristic(), start.euler) << step;
                ASSERT_EQ(topology_of(network), (Topology{start.components, start.genus, start.loops}))
                    << step;
                if (step % 200 == 0) expect_sound(network, topology);
                if (HasFatalFailure()) return;
            }
        }
    }
}

// The exchange of faces against the same on plain lists of faces.

std::vector<Triangle> exchanged(std::vector<Triangle> faces, const std::vector<Triangle>& gone,
                                const std::vector<Triangle>& added) {
    faces = canonical(faces);
    for (const Triangle& f : canonical(gone)) faces.erase(std::find(faces.begin(), faces.end(), f));
    faces.insert(faces.end(), added.begin(), added.end());
    return canonical(faces);
}

bool acceptable(const std::vector<Triangle>& faces) {
    if (faces.empty()) return true;
    const Census now = census(faces);
    return now.breach.empty() && now.greatest_valence() <= Ring::kMaxValence;
}

/// Exchanges the faces if the network can, and compares with the lists. \return whether it could
bool exchange(Network& network, const std::vector<Triangle>& gone, const std::vector<Triangle>& added) {
    const std::vector<Triangle> before = canonical(network.faces());
    const std::vector<Triangle> after = exchanged(before, gone, added);
    const bool can = network.can_exchange_faces(gone, added);
    EXPECT_EQ(can, acceptable(after));
    if (can) {
        network.exchange_faces(gone, added);
    } else {
        EXPECT_THROW(network.exchange_faces(gone, added), TopologyError);
    }
    EXPECT_EQ(canonical(network.faces()), can ? after : before);
    EXPECT_EQ(network.validate(), "");
    return can;
}

VertexId any_vertex(const Network& network, Random& random) {
    std::vector<VertexId> all;
    for (const VertexId v : network.vertices()) all.push_back(v);
    return all[random.below(static_cast<std::uint32_t>(all.size()))];
}

TEST(ExchangeFaces, AgreesWithListsOfFaces) {
    int done = 0, refused = 0;
    for (const auto& start : starts()) {
        SCOPED_TRACE(start.name);
        Random random(5);
        for (int run = 0; run < 200; ++run) {
            Network network = network_of(start.shape);
            for (int step = 0; step < 4 && network.vertex_count() > 3; ++step) {
                const std::vector<Triangle> faces = network.faces();
                std::vector<Triangle> gone, added;
                const auto first = random.below(static_cast<std::uint32_t>(faces.size()));
                const auto count = 1 + random.below(3);
                for (std::uint32_t i = 0; i < count && first + i < faces.size(); ++i)
                    gone.push_back(faces[first + i]);
                if (random.below(2) == 0) {
                    const Triangle f{any_vertex(network, random), any_vertex(network, random),
                                     any_vertex(network, random)};
                    if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0]) added.push_back(f);
                }
                ++(exchange(network, gone, added) ? done : refused);
            }
        }
    }
    EXPECT_GT(done, 1000);
    EXPECT_GT(refused, 1000);
}

TEST(ExchangeFaces, RemovesVerticesWithoutFacesAndReusesTheirIds) {
    Network network = network_of(shapes::icosphere(1));
    const int vertices = network.vertex_count();
    const Ring ring = network.ring(0);
    std::vector<Triangle> star;
    for (int i = 0; i < ring.valence; ++i) star.push_back({0, ring[i], ring.next(i)});
    ASSERT_TRUE(exchange(network, star, {}));
    EXPECT_FALSE(network.alive(0));
    EXPECT_EQ(network.vertex_count(), vertices - 1);
    EXPECT_EQ(network.boundary_loop_count(), 1);
    const VertexId v = ring[0];
    EXPECT_EQ(network.split(v, 0, 2, {0, 0, 0}), 0);
    EXPECT_EQ(network.validate(), "");
}

TEST(ExchangeFaces, RefusesFacesThatDoNotExistAndVerticesThatDoNot) {
    const Network network = network_of(shapes::icosphere(1));
    const Triangle face = network.faces().front();
    EXPECT_FALSE(network.can_exchange_faces({face, face}, {}));
    EXPECT_FALSE(network.can_exchange_faces({{face[0], face[2], face[1]}}, {}));
    EXPECT_FALSE(network.can_exchange_faces({face}, {{face[0], face[1], network.slot_count()}}));
    EXPECT_FALSE(network.can_exchange_faces({face}, {{face[0], face[1], -1}}));
    EXPECT_TRUE(network.can_exchange_faces({face}, {face}));
}

}  // namespace neuralmesh::network_operations_test
