// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The widths of walls and gaps along the shell of shapes on a lattice, whose widths are known.
#include "vcg_core/start/local_width.h"

#include "tests/unit/support/prelude.h"
#include "vcg_core/start/closed_mesh.h"

namespace neuralmesh::local_width_test {

constexpr float kStep = 0.02F;
constexpr float kFarthest = 0.5F;

using Inside = std::function<bool(const vcg::Point3f&)>;

struct Body {
    Lattice lattice;
    NodeSet nodes;
    Network shell;
};

Body body_of(const Inside& inside) {
    const vcg::Box3f box(vcg::Point3f(-0.6F, -0.6F, -0.6F), vcg::Point3f(0.6F, 0.6F, 0.6F));
    Body solid{Lattice(box, kStep, 4), {}, {}};
    solid.nodes.assign(solid.lattice.size(), 0);
    PerNode<float> values(solid.lattice.size(), 1.0F);
    for (NodeId i = 0; i < solid.lattice.size(); ++i)
        if (inside(solid.lattice.position(i))) {
            solid.nodes[i] = 1;
            values[i] = -1;
        }
    const IndexedMesh<float> mesh = marching_tetrahedra(solid.lattice, values);
    solid.shell = Network(mesh.positions, mesh.faces);
    return solid;
}

/// The widths at the vertices of the shell at which \p counts is true.
std::vector<float> widths_where(const Body& solid, float radius, const Inside& counts) {
    const LocalWidths widths(solid.shell, solid.lattice, solid.nodes, radius, kFarthest);
    std::vector<float> chosen;
    for (const VertexId v : solid.shell.vertices())
        if (counts(solid.shell.position(v))) chosen.push_back(widths.width(v, kFarthest));
    return chosen;
}

bool in_the_middle(const vcg::Point3f& p) { return std::abs(p[0]) < 0.3F && std::abs(p[1]) < 0.3F; }

TEST(LocalWidth, OfAWallIsItsThicknessBetweenThePoints) {
    const Body plate = body_of([](const vcg::Point3f& p) {
        return std::abs(p[0]) < 0.5F && std::abs(p[1]) < 0.5F && std::abs(p[2]) < 0.09F;
    });
    const float radius = 0.03F;
    const std::vector<float> widths = widths_where(plate, radius, in_the_middle);
    ASSERT_FALSE(widths.empty());
    for (const float width : widths) EXPECT_NEAR(width, 0.18F - 2 * radius, kStep);
}

TEST(LocalWidth, OfAGapIsItsWidthBetweenThePoints) {
    const Body blocks = body_of([](const vcg::Point3f& p) {
        return std::abs(p[0]) < 0.5F && std::abs(p[1]) < 0.5F && std::abs(p[2]) > 0.07F &&
               std::abs(p[2]) < 0.55F;
    });
    const float radius = 0.03F;
    const std::vector<float> widths = widths_where(
        blocks, radius, [](const vcg::Point3f& p) { return in_the_middle(p) && std::abs(p[2]) < 0.1F; });
    ASSERT_FALSE(widths.empty());
    for (const float width : widths) EXPECT_NEAR(width, 0.14F + 2 * radius, 1.5F * kStep);
}

TEST(LocalWidth, IsTheBoundWhereNothingIsNear) {
    const Body ball = body_of([](const vcg::Point3f& p) { return p.Norm() < 0.5F; });
    const std::vector<float> widths =
        widths_where(ball, 1.2F * kStep, [](const vcg::Point3f&) { return true; });
    for (const float width : widths) EXPECT_FLOAT_EQ(width, kFarthest);
}

TEST(LocalWidth, IsNeverLessThanTheLatticeTells) {
    const Body foil = body_of([](const vcg::Point3f& p) {
        return std::abs(p[0]) < 0.5F && std::abs(p[1]) < 0.5F && std::abs(p[2]) < 0.03F;
    });
    for (const float width : widths_where(foil, 0.025F, in_the_middle)) EXPECT_FLOAT_EQ(width, 1.5F * kStep);
    for (const float width : widths_where(foil, 0.04F, in_the_middle)) EXPECT_FLOAT_EQ(width, 0.04F);
}

struct PlateSides {
    std::vector<float> outer, facing;

    void expect_near(float outside, float between, float tolerance) const {
        for (const float length : outer) EXPECT_NEAR(length, outside, tolerance);
        for (const float length : facing) EXPECT_NEAR(length, between, tolerance);
    }
};

/// The thickenings at the two sides of the lower of two plates of \p thickness that are \p gap apart.
PlateSides thickenings_of_plates(float thickness, float gap, float radius, float thick) {
    constexpr float kBottom = -0.4F;
    const Body plates = body_of([&](const vcg::Point3f& p) {
        const float z = p[2] - kBottom;
        const bool in_plate = (z > 0 && z < thickness) || (z > thickness + gap && z < 2 * thickness + gap);
        return std::abs(p[0]) < 0.5F && std::abs(p[1]) < 0.5F && in_plate;
    });
    const LocalWidths widths(plates.shell, plates.lattice, plates.nodes, radius,
                             LocalWidths::farthest_for(thick, radius));
    PlateSides sides;
    for (const VertexId v : plates.shell.vertices()) {
        const vcg::Point3f& p = plates.shell.position(v);
        const float z = p[2] - kBottom;
        if (!in_the_middle(p) || z > thickness + gap / 2) continue;
        (z < thickness / 2 ? sides.outer : sides.facing).push_back(widths.thickening(v, thick));
    }
    EXPECT_FALSE(sides.outer.empty() || sides.facing.empty());
    return sides;
}

TEST(Thickenings, FillAQuarterOfTheRoomUpToHalfTheRadius) {
    // The wall between the points is .06 thick.
    thickenings_of_plates(0.18F, 0.3F, 0.06F, 0.16F).expect_near(0.025F, 0.025F, kStep / 2);
    thickenings_of_plates(0.18F, 0.3F, 0.06F, 0.5F).expect_near(0.03F, 0.03F, 0);
}

TEST(Thickenings, AreZeroAtThickWalls) {
    thickenings_of_plates(0.3F, 0.3F, 0.04F, 0.15F).expect_near(0, 0, 0);
}

TEST(Thickenings, TakeWallsTooThinForTheLatticeForTheThinnestThatItTells) {
    const float room = 0.1F - 1.5F * kStep;
    thickenings_of_plates(0.1F, 0.4F, 0.06F, 0.1F).expect_near(room / 4, room / 4, 7e-9F);
}

TEST(Thickenings, AreZeroBeforeGapsNarrowerThanTheWall) {
    const PlateSides plate = thickenings_of_plates(0.3F, 0.1F, 0.04F, 0.5F);
    for (const float length : plate.outer) EXPECT_GT(length, 0);
    for (const float length : plate.facing) EXPECT_EQ(length, 0);
}

}  // namespace neuralmesh::local_width_test
