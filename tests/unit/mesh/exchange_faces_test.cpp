// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The exchange of faces against the same on plain lists of faces.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/unit/support/network_starts.h"
#include "tests/unit/support/referee.h"
#include "tests/unit/support/shapes.h"
#include "vcg_core/base/random.h"

namespace neuralmesh {
namespace {

using referee::canonical;
using referee::census;
using referee::network_of;

std::vector<Triangle> exchanged(std::vector<Triangle> faces, const std::vector<Triangle>& gone,
                                const std::vector<Triangle>& added) {
    faces = canonical(faces);
    for (const Triangle& f : canonical(gone)) faces.erase(std::find(faces.begin(), faces.end(), f));
    faces.insert(faces.end(), added.begin(), added.end());
    return canonical(faces);
}

bool acceptable(const std::vector<Triangle>& faces) {
    if (faces.empty()) return true;
    const referee::Census now = census(faces);
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
    for (const auto& start : network_starts::starts()) {
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

}  // namespace
}  // namespace neuralmesh
