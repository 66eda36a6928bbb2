// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Construction, counts, numbering, order and validation of a network.
#include "tests/unit/support/network_starts.h"

namespace neuralmesh::network_test {

TEST(Network, HasTheCountsOfItsFaces) {
    for (const Start& start : starts()) {
        SCOPED_TRACE(start.name);
        const Network network = network_of(start.shape);
        EXPECT_EQ(canonical(network.faces()), canonical(start.shape.faces));
        EXPECT_EQ(network.vertex_count(), static_cast<int>(start.shape.positions.size()));
        EXPECT_EQ(network.euler_characteristic(), start.euler);
        EXPECT_EQ(topology_of(network), (Topology{start.components, start.genus, start.loops}));
        expect_sound(network, census(start.shape.faces));
    }
}

/// Ids in random order.
std::vector<VertexId> shuffled_ids(int count, Random& random) {
    std::vector<VertexId> ids(static_cast<std::size_t>(count));
    std::iota(ids.begin(), ids.end(), 0);
    for (std::size_t i = ids.size(); i > 1; --i)
        std::swap(ids[i - 1], ids[random.below(static_cast<std::uint32_t>(i))]);
    return ids;
}

TEST(Network, RenumberKeepsTheMesh) {
    Network network = network_of(shapes::torus_grid(30, 20));
    for (int v = 0; v < 50; ++v)
        if (network.alive(v) && network.can_collapse(v, network.ring(v)[0]))
            network.collapse(v, network.ring(v)[0]);
    ASSERT_LT(network.vertex_count(), network.slot_count());
    const Network before = network;
    Random random(5);
    std::vector<VertexId> order = shuffled_ids(before.slot_count(), random);
    order.erase(std::remove_if(order.begin(), order.end(), [&](VertexId v) { return !before.alive(v); }),
                order.end());
    const PerVertex<VertexId> moved = network.renumber(order);
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.slot_count(), before.vertex_count());
    ASSERT_EQ(moved.size(), before.slot_count());
    for (VertexId v = 0; v < before.slot_count(); ++v) {
        const VertexId now = moved[v];
        ASSERT_EQ(now >= 0, before.alive(v));
        if (now < 0) continue;
        EXPECT_EQ(order[static_cast<std::size_t>(now)], v);
        EXPECT_EQ(network.position(now), before.position(v));
        ASSERT_EQ(network.ring(now).valence, before.ring(v).valence);
        for (int i = 0; i < before.ring(v).valence; ++i)
            EXPECT_EQ(network.ring(now)[i], moved[before.ring(v)[i]]);
    }
}

TEST(Network, NewVerticesTakeTheFreeIdsNearTheirParents) {
    Network network = network_of(shapes::torus_grid(30, 20));
    std::vector<VertexId> order;
    for (const VertexId v : network.vertices()) {
        order.push_back(v);
        if (order.size() % 5 == 4) order.push_back(-1);
    }
    const auto faces = network.face_count();
    network.renumber(order);
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.vertex_count(), 600);
    EXPECT_EQ(network.face_count(), faces);
    EXPECT_EQ(network.slot_count(), 750);
    EXPECT_FALSE(network.alive(4));
    for (const VertexId v : {2, 333, 747})
        EXPECT_EQ(network.split(v, 0, 4, network.position(v)), v / 5 * 5 + 4);
    EXPECT_EQ(network.slot_count(), 750);
    EXPECT_EQ(network.validate(), "");
}

void expect_refused(const Shape& shape, const char* why) {
    EXPECT_THROW(network_of(shape), TopologyError) << why;
}

/// Of \p shape after \p change.
template <class Change>
void expect_refused_after(Shape shape, const char* why, const Change& change) {
    change(shape);
    expect_refused(shape, why);
}

TEST(Network, RefusesNonManifolds) {
    const Shape whole = shapes::tetrahedron();
    expect_refused_after(whole, "one face turned over",
                         [](Shape& s) { std::swap(s.faces[0][0], s.faces[0][1]); });
    expect_refused_after(whole, "a face twice", [](Shape& s) { s.faces.push_back(s.faces[0]); });
    expect_refused_after(shapes::grid(3, 3), "three faces at an edge", [](Shape& s) {
        s.positions.emplace_back(0.0, 0.0, 1.0);
        s.faces.push_back({0, 4, 9});
    });
    expect_refused_after(whole, "a vertex without faces",
                         [](Shape& s) { s.positions.emplace_back(3.0, 0.0, 0.0); });
    for (const VertexId v : {4, -1})
        expect_refused_after(whole, "a vertex that does not exist", [v](Shape& s) { s.faces[0][0] = v; });
    expect_refused_after(whole, "a face with a corner twice",
                         [](Shape& s) { s.faces[0][1] = s.faces[0][0]; });
    expect_refused(shapes::bipyramid(16), "a closed valence of 16");
    expect_refused(shapes::fan(15), "an open valence of 16");
    expect_refused(shapes::fan(40), "an open valence of 41");
    expect_refused({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}, "a closed valence of 2");
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        expect_refused_after(whole, "a position that is not finite",
                             [bad](Shape& s) { s.positions[2][1] = bad; });
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

/// Interleaves 21 bits of each coordinate, one by one.
std::uint64_t slow_morton_code(const vcg::Point3f& p) {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
        const float clamped = std::clamp(p[k], -1.0F, 0.999F);
        const auto steps = static_cast<std::uint64_t>((clamped + 1) * 0x1p20F);
        for (int bit = 0; bit < 21; ++bit) code |= (steps >> bit & 1) << (3 * bit + k);
    }
    return code;
}

/// A torus with free slots; its coordinates reach 1.4.
Network torus_with_free_slots() {
    Network network = network_of(shapes::torus_grid(30, 20));
    Random random(5);
    for (int step = 0; step < 3000; ++step) random_operation(network, random, 400, 700);
    for (int step = 0; step < 300; ++step) random_operation(network, random, 1, 1);
    return network;
}

TEST(VertexOrder, MortonOrderSortsByInterleavedCoordinates) {
    const Network network = torus_with_free_slots();
    ASSERT_LT(network.vertex_count(), network.slot_count());
    std::vector<std::pair<std::uint64_t, VertexId>> codes;
    for (const VertexId v : network.vertices()) codes.emplace_back(slow_morton_code(network.position(v)), v);
    std::sort(codes.begin(), codes.end());
    std::vector<VertexId> expected;
    for (const auto& [code, v] : codes) expected.push_back(v);
    EXPECT_EQ(morton_order(network), expected);
}

TEST(VertexOrder, InterleaveFreeSpreadsFreeIdsEvenly) {
    for (const int size : {0, 1, 7, 100})
        for (int count = 0; count <= size; ++count) {
            SCOPED_TRACE(testing::Message() << count << " between " << size);
            std::vector<VertexId> ids(static_cast<std::size_t>(size));
            for (int i = 0; i < size; ++i) ids[static_cast<std::size_t>(i)] = size - i;
            const std::vector<VertexId> order = interleave_free(ids, count);
            int used = 0;
            int free = 0;
            for (const VertexId v : order) {
                if (v >= 0) {
                    ASSERT_EQ(v, size - used++);
                } else {
                    ++free;
                }
                // After k of n ids there are count x k / n free ones, but for rounding.
                ASSERT_LE(free * size, count * used);
                ASSERT_GE((free + 1) * size, count * (used - 1));
            }
            EXPECT_EQ(used, size);
            EXPECT_EQ(free, count);
        }
}

TEST(FreeIds, TakeReturnsEachIdOnce) {
    FreeIds ids;
    std::set<int> expected;
    Random random(2);
    for (int round = 0; round < 20000; ++round) {
        const auto id = static_cast<int>(random.below(3000));
        if (random.below(2) == 0) {
            if (expected.insert(id).second) ids.add(id);
        } else if (!expected.empty()) {
            const int taken = ids.take(id);
            ASSERT_EQ(expected.count(taken), 1U);
            // Nearest in its word of 64, if that has one.
            const auto from = expected.lower_bound(id / 64 * 64);
            const auto to = expected.lower_bound(id / 64 * 64 + 64);
            for (auto it = from; it != to; ++it) ASSERT_LE(std::abs(taken - id), std::abs(*it - id));
            expected.erase(taken);
        }
        ASSERT_EQ(ids.count(), static_cast<int>(expected.size()));
    }
}

}  // namespace neuralmesh::network_test
