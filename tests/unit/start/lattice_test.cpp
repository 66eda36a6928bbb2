// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Lattices: nodes, links, components, solids without bridges, and their surfaces.
#include "tests/unit/support/referee.h"
#include "tests/unit/support/small_lattice.h"
#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/start/closed_mesh.h"
#include "vcg_core/start/lattice_survey.h"

namespace neuralmesh::lattice_test {

TEST(Lattice, NodeOfAPointIsTheNearestOne) {
    const Lattice lattice = small_lattice();
    Random random(4);
    int outside = 0;
    for (int i = 0; i < 1000; ++i) {
        const float x = 16 * random.unit() - 3, y = 16 * random.unit() - 3, z = 16 * random.unit() - 3;
        const vcg::Point3f p(x, y, z);
        NodeId nearest = 0;
        for (NodeId j = 0; j < lattice.size(); ++j)
            if ((lattice.position(j) - p).SquaredNorm() < (lattice.position(nearest) - p).SquaredNorm())
                nearest = j;
        const vcg::Point3f away = lattice.position(nearest) - p;
        const float farthest = std::max({std::abs(away[0]), std::abs(away[1]), std::abs(away[2])});
        EXPECT_EQ(lattice.node_of(p), farthest > 0.5F * lattice.step ? lattice.size() : nearest);
        outside += farthest > 0.5F * lattice.step ? 1 : 0;
    }
    EXPECT_GT(outside, 100);
    EXPECT_LT(outside, 900);
    EXPECT_EQ(lattice.node_of({1e30F, 0, 0}), lattice.size());
    EXPECT_EQ(lattice.node_of({0, -1e30F, 0}), lattice.size());
}

TEST(Lattice, AdjacencyIsThatOfTheFreudenthalSubdivision) {
    const Lattice lattice = small_lattice();
    const Neighbours neighbours(lattice);
    for (NodeId i = 0; i < lattice.size(); ++i) {
        std::multiset<NodeId> expected, found;
        const auto a = lattice.coordinates(i);
        for_each_node(lattice, [&](int x, int y, int z) {
            const std::array<int, 3> d = {x - a[0], y - a[1], z - a[2]};
            const auto [low, high] = std::minmax_element(d.begin(), d.end());
            const bool ahead = *low == 0 && *high == 1, behind = *low == -1 && *high == 0;
            const bool diagonal = *low == *high && std::abs(*low) == 1;
            if (ahead || behind || diagonal) expected.insert(lattice.index(x, y, z));
        });
        neighbours.for_each_at(i, neighbours.places(i), [&](NodeId j, int k) {
            found.insert(j);
            const auto b = lattice.coordinates(j);
            const auto& offset = kNeighbourOffsets[static_cast<std::size_t>(k)];
            EXPECT_EQ(offset, (std::array<int, 3>{b[0] - a[0], b[1] - a[1], b[2] - a[2]}));
        });
        ASSERT_EQ(found, expected) << i;
    }
}

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
        EXPECT_GT(enclosed_volume(mesh), 0);
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

constexpr int kMaxRadius = 12;

/// The nodes with inside(x, y, z) in a cube of 31 nodes per side around (0, 0, 0), grown to \p level.
class Growth {
public:
    template <class Inside>
    Growth(int level, const Inside& inside) : lattice_(box(), 1, 2), solid_(lattice_.size(), 0) {
        PerNode<std::uint32_t> occupied(lattice_.size(), 0);
        for_each_node(lattice_, [&](int x, int y, int z) {
            if (!inside(x - 17, y - 17, z - 17)) return;
            occupied[lattice_.index(x, y, z)] = 1;
            solid_[lattice_.index(x, y, z)] = 1;
        });
        before_ = euler_characteristic(lattice_, solid_);
        distances_ = squared_distances(lattice_, occupied, kMaxRadius);
        grow_without_bridges(lattice_, distances_, level, solid_);
    }
    int before() const { return before_; }
    int after() const { return euler_characteristic(lattice_, solid_); }
    bool solid(int x, int y, int z) const { return solid_[lattice_.index(x + 17, y + 17, z + 17)] != 0; }
    bool within_level(int level) const {
        for (NodeId i = 0; i < solid_.size(); ++i)
            if (solid_[i] != 0 && distances_[i] > level) return false;
        return true;
    }

private:
    static vcg::Box3f box() {
        vcg::Box3f result;
        result.Add(vcg::Point3f(-15, -15, -15));
        result.Add(vcg::Point3f(15, 15, 15));
        return result;
    }
    Lattice lattice_;
    NodeSet solid_;
    PerNode<SquaredRadius> distances_;
    int before_ = 0;
};

/// A plate with a square hole of half width \p hole.
auto plate(int hole) {
    return [hole](int x, int y, int z) {
        return std::abs(x) <= 10 && std::abs(y) <= 10 && std::abs(z) <= 1 &&
               !(std::abs(x) <= hole && std::abs(y) <= hole);
    };
}

TEST(BridgelessGrowth, FillsHolesUpToItsRadius) {
    const Growth narrow(9, plate(2)), wide(9, plate(5));
    EXPECT_EQ(narrow.before(), 0);  // one component, one handle
    EXPECT_EQ(narrow.after(), 1);
    EXPECT_TRUE(narrow.solid(0, 0, 0));
    EXPECT_EQ(wide.after(), 0);
    EXPECT_FALSE(wide.solid(0, 0, 0));
    EXPECT_TRUE(narrow.within_level(9));
}

TEST(BridgelessGrowth, DoesNotJoinParts) {
    const Growth growth(16, [](int x, int y, int z) {
        return std::abs(x) <= 8 && std::abs(y) <= 8 && (std::abs(z - 4) <= 2 || std::abs(z + 4) <= 2);
    });
    EXPECT_EQ(growth.before(), 2);
    EXPECT_EQ(growth.after(), 2);
    EXPECT_TRUE(growth.solid(0, 0, 1));
    EXPECT_TRUE(growth.solid(0, 0, -1));
    EXPECT_FALSE(growth.solid(0, 0, 0) && growth.solid(0, 0, 1) && growth.solid(0, 0, -1));
}

TEST(BridgelessGrowth, MakesNoHandleWhereEndsMeet) {
    // A C whose ends are 4 steps apart.
    const Growth growth(16, [](int x, int y, int z) {
        const int squared = x * x + y * y;
        return squared >= 36 && squared <= 100 && std::abs(z) <= 2 && !(x > 0 && std::abs(y) <= 1);
    });
    EXPECT_EQ(growth.before(), 1);
    EXPECT_EQ(growth.after(), 1);
}

TEST(BridgelessGrowth, LeavesNoCavities) {
    // A hollow ball with a hole: growth fills the hollow from all sides and leaves nodes out where the fronts
    // meet. They are cut off from outside.
    const Growth growth(64, [](int x, int y, int z) {
        const int squared = x * x + y * y + z * z;
        return squared >= 36 && squared <= 64 && !(std::abs(x) <= 1 && std::abs(y) <= 1 && z > 0);
    });
    EXPECT_EQ(growth.before(), 1);
    EXPECT_EQ(growth.after(), 1);
    EXPECT_TRUE(growth.solid(0, 0, 0));
}

TEST(BridgelessGrowth, ConnectedSetsAreThoseOfOneComponent) {
    const Lattice lattice = small_lattice();
    const NodeId middle = lattice.index(5, 6, 7);
    const Neighbours neighbours(lattice);
    int differ = 0;
    for (NeighbourSet set = 0; set < NeighbourSet{1} << kNeighbourCount; ++set) {
        NodeSet members(lattice.size(), 0);
        neighbours.for_each_at(middle, neighbours.places(middle),
                               [&](NodeId j, int k) { members[j] = set >> k & 1U; });
        int components = 0;
        for_each_component(lattice, members, 1, [&](const auto&) { ++components; });
        differ += is_connected(set) != (components == 1) ? 1 : 0;
    }
    EXPECT_EQ(differ, 0);
}

// Components by runs against the union of all adjacent nodes.

TEST(Components, AreTheSetsThatAdjacentNodesJoin) {
    const Lattice lattice = small_lattice();
    const Neighbours neighbours(lattice);
    for (const std::uint32_t one_in : {2U, 3U, 6U}) {
        NodeSet nodes;
        for (const std::uint32_t count : random_counts(lattice, one_in, one_in))
            nodes.push_back(count > 0 ? 1 : 0);
        for (const bool value : {false, true}) {
            DisjointSets sets(lattice.size());
            for (NodeId i = 0; i < lattice.size(); ++i)
                neighbours.for_each_at(i, neighbours.places(i), [&](NodeId j, int) {
                    if (nodes[i] == value && nodes[j] == value) sets.join(i, j);
                });
            PerNode<NodeId> found(lattice.size(), -1);
            NodeId last = -1;
            for_each_component(lattice, nodes, value, [&](const auto& runs) {
                EXPECT_GT(runs[0].begin, last);
                last = runs[0].begin;
                for (const auto& run : runs) std::fill(run.begin_in(found), run.end_in(found), last);
            });
            for (NodeId i = 0; i < lattice.size(); ++i)
                ASSERT_EQ(found[i], nodes[i] == value ? sets.find(i) : -1) << i;
        }
    }
}

}  // namespace neuralmesh::lattice_test
