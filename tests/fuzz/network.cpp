// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Arbitrary sequences of splits, collapses and flips with arbitrary arguments: if can_...() is true, the
// operation preserves the manifold and its topology, else it throws and changes nothing.
#include "vcg_core/mesh/network.h"

#include "bytes.h"
#include "tests/unit/support/referee.h"

namespace {

using namespace neuralmesh;
using fuzz::Bytes;
using fuzz::expect;
using fuzz::fail;

constexpr int kMostVertices = 120;

Shape start_of(int choice) {
    switch (choice) {
        case 0: return shapes::tetrahedron();
        case 1: return shapes::bipyramid(3);
        case 2: return shapes::bipyramid(Ring::kMaxValence);
        case 3: return shapes::fan(1);
        case 4: return shapes::fan(Ring::kMaxValence - 1);
        case 5: return shapes::grid(4, 5);
        case 6: return shapes::tube(3, 3);
        case 7: return shapes::torus_grid(3, 3);
        case 8: return shapes::icosphere(1);
        default: break;
    }
    Shape two = shapes::cube();
    shapes::append(two, shapes::grid(3, 3), {3, 0, 0});
    return two;
}

/// Calls \p operation, which must succeed if and only if \p allowed.
template <class Operation>
void attempt(Network& network, bool allowed, const Operation& operation) {
    const auto before = network.faces();
    try {
        operation();
        expect(allowed, "an operation succeeded although can_...() was false");
    } catch (const TopologyError& error) {
        fuzz::expect_sentence(error.what());
        expect(!allowed, "an operation threw although can_...() was true");
        expect(network.faces() == before, "an operation that threw changed the network");
    }
}

void operate(Network& network, Bytes& bytes) {
    const int kind = bytes.below(8);
    // May be a free slot, for which every operation must throw.
    const VertexId v = bytes.below(network.slot_count());
    const Ring ring = network.ring(v);
    const int choice = bytes.byte();
    const VertexId neighbour = ring.valence > 0 ? ring[choice % ring.valence] : choice % network.slot_count();
    if (kind <= 2) {
        const int count = bytes.below(20) - 1;
        const int first = choice % 20 - 1;
        const bool allowed = network.can_split(v, first, count);
        if (network.vertex_count() < kMostVertices)
            attempt(network, allowed, [&] { network.split(v, first, count, {0.5F, 0.25F, 0.125F}); });
    } else if (kind <= 4) {
        attempt(network, network.can_collapse(v, neighbour), [&] { network.collapse(v, neighbour); });
    } else if (kind <= 5) {
        attempt(network, network.can_flip(v, neighbour), [&] { network.flip(v, neighbour); });
    } else if (kind == 6) {
        const VertexId stranger = choice % network.slot_count();
        attempt(network, network.can_collapse(v, stranger), [&] { network.collapse(v, stranger); });
    } else {
        network.compact();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    Network network = network_of(start_of(bytes.below(10)));
    const Census topology = census(network.faces());
    while (bytes.left() > 0) {
        operate(network, bytes);
        const std::string breach = network.validate();
        if (!breach.empty()) fail(breach);
    }
    const Census found = census(network.faces());
    if (!found.breach.empty()) fail("the faces are no manifold: " + found.breach);
    expect(found.same_topology(topology), "the topology has changed");
    expect(network.euler_characteristic() == topology.euler(), "the Euler characteristic is miscounted");
    expect(network.component_count() == topology.components, "the components are miscounted");
    expect(network.boundary_loop_count() == topology.loops, "the boundary loops are miscounted");
    return 0;
}
