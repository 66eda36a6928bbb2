// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/bridgeless_growth.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>

#include "tests/unit/support/small_lattice.h"
#include "vcg_core/start/components.h"

namespace neuralmesh {
namespace {

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

}  // namespace
}  // namespace neuralmesh
