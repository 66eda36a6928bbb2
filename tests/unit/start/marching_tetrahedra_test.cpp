// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/marching_tetrahedra.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/unit/support/referee.h"
#include "tests/unit/support/small_lattice.h"
#include "vcg_core/mesh/network.h"
#include "vcg_core/start/components.h"

namespace neuralmesh {
namespace {

/// Random values, one in \p one_in of them negative; positive on the walls.
PerNode<float> random_values(const Lattice& lattice, std::uint64_t seed, std::uint32_t one_in) {
    Random random(seed);
    PerNode<float> values(lattice.size());
    for_each_node(lattice, [&](int x, int y, int z) {
        const bool wall =
            x == 0 || y == 0 || z == 0 || x == lattice.nx - 1 || y == lattice.ny - 1 || z == lattice.nz - 1;
        const float size = random.unit() + 0.001F;
        values[lattice.index(x, y, z)] = random.below(one_in) == 0 && !wall ? -size : size;
    });
    return values;
}

/// The boundary of a solid has twice its Euler characteristic, whatever its components, handles and cavities.
TEST(MarchingTetrahedra, SurfaceHasTwiceTheEulerCharacteristicOfTheSolid) {
    const Lattice lattice = small_lattice();
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        const PerNode<float> values = random_values(lattice, seed, 2 + seed % 10);
        NodeSet solid(lattice.size());
        for (NodeId i = 0; i < lattice.size(); ++i) solid[i] = values[i] < 0 ? 1 : 0;
        const IndexedMesh<float> mesh = marching_tetrahedra(lattice, values);
        const Network network(mesh.positions, mesh.faces);
        ASSERT_EQ(network.validate(), "");
        EXPECT_EQ(network.boundary_loop_count(), 0);
        EXPECT_EQ(network.euler_characteristic(), 2 * euler_characteristic(lattice, solid)) << seed;
        EXPECT_GT(referee::enclosed_volume(mesh), 0);
        for (const VertexId v : network.vertices()) {
            EXPECT_GE(network.ring(v).valence, 4);
            EXPECT_LE(network.ring(v).valence, 12);
        }
    }
}

TEST(MarchingTetrahedra, VerticesAreZerosOfTheInterpolation) {
    const Lattice lattice = small_lattice();
    // A linear function, so that the interpolated zeros are those of the function: a plane that cuts a cube
    // off.
    const auto plane = [](const vcg::Point3f& p) { return p[0] + 2 * p[1] - 3 * p[2] - 0.7F; };
    PerNode<float> values(lattice.size());
    for_each_node(lattice, [&](int x, int y, int z) {
        const bool inner = x >= 2 && x <= 8 && y >= 2 && y <= 8 && z >= 2 && z <= 8;
        const float value = plane(lattice.position(x, y, z));
        values[lattice.index(x, y, z)] = inner ? value : 100;
    });
    int on_plane = 0, exact = 0;
    for (const vcg::Point3f& p : marching_tetrahedra(lattice, values).positions) {
        const vcg::Point3f q = (p - lattice.corner) * (1 / lattice.step);
        bool inner = true;
        for (int k = 0; k < 3; ++k) inner = inner && q[k] > 2 && q[k] < 8;
        if (!inner) continue;
        ++on_plane;
        // A vertex may be moved by a tenth of an edge, along which the function changes by at most 3.
        EXPECT_LE(std::abs(plane(p)), 0.301F);
        exact += std::abs(plane(p)) < 1e-4F ? 1 : 0;
    }
    EXPECT_GT(on_plane, 50);
    EXPECT_GT(exact, on_plane / 2);
}

}  // namespace
}  // namespace neuralmesh
