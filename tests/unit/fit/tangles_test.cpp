// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Surfaces that cut or fold over themselves.
#include "tests/unit/support/crumpled.h"
#include "vcg_core/fit/fit.h"
#include "vcg_core/fit/move_limits.h"
#include "vcg_core/fit/redistribute.h"
#include "vcg_core/fit/sound_meshes.h"

namespace neuralmesh::tangles_test {

// Self-intersections are smoothed out before the fit, and the fit makes none.

/// The intersections that untangle() leaves.
std::vector<SelfIntersection> smoothed_out(Network& network, int threads) {
    ThreadTeam team(threads);
    return *untangle(network, team, unwatched());
}

TEST(IntersectionGuard, ObjectsToNewCrossingsIfMoreFacesCross) {
    const SelfIntersection a{0, 1, 2, 3, 4, 5};
    const SelfIntersection b{6, 7, 8, 9, 10, 11};
    IntersectionGuard strict;
    EXPECT_TRUE(strict.objections({}).empty());
    EXPECT_EQ(strict.objections({a}), std::vector<VertexId>(a.begin(), a.end()));
    IntersectionGuard guard({a});
    EXPECT_TRUE(guard.objections({b}).empty()) << "as many faces as before";
    EXPECT_EQ(guard.objections({a, b}), std::vector<VertexId>(a.begin(), a.end()));
    EXPECT_TRUE(guard.objections({}).empty());
}

TEST(Untangle, SmoothsOutACrumpledCap) {
    Network network = crumpled_sphere(0);
    const Network crumpled = crumpled_sphere(0.13);
    for (VertexId v = 0; v < network.slot_count(); ++v)
        if (network.position(v)[2] > 8) network.set_position(v, crumpled.position(v));
    const Network before = network;
    const std::set<Triangle> faces = cut_faces(network);
    ASSERT_FALSE(faces.empty());
    EXPECT_TRUE(smoothed_out(network, 1).empty());
    EXPECT_TRUE(cut_faces(network).empty());
    EXPECT_EQ(network.validate(), "");
    int moved = 0;
    for (VertexId u = 0; u < network.slot_count(); ++u)
        moved += network.position(u) == before.position(u) ? 0 : 1;
    EXPECT_GT(moved, 0);
    EXPECT_LT(moved, 200) << "vertices far from the cap do not move";
}

TEST(Untangle, MovesVerticesAsFarAsTheirOwnEdgesAreLong) {
    // The crumpled cap beside a ball of short edges, of which most edges are.
    const Network crumpled = crumpled_sphere(0.13);
    Shape shape = shapes::scaled(shapes::icosphere(3), 10);
    for (std::size_t v = 0; v < shape.positions.size(); ++v)
        if (shape.positions[v][2] > 8)
            shape.positions[v] = vcg::Point3d::Construct(crumpled.position(static_cast<VertexId>(v)));
    shapes::append(shape, shapes::scaled(shapes::icosphere(5), 0.5), {20, 0, 0});
    Network network = network_of(shape);
    ASSERT_FALSE(cut_faces(network).empty());
    EXPECT_TRUE(smoothed_out(network, 1).empty());
}

TEST(Untangle, SmoothsOutARimThatCutsItself) {
    Network network = network_of(shapes::grid(8, 8));
    // A boundary edge is drawn inwards, one end above the sheet and the other below.
    VertexId a = 0;
    while (network.ring(a).open == 0 || network.ring(a).valence < 4) ++a;
    const VertexId b = network.ring(a)[0];
    network.set_position(a, network.position(a) * 0.5F + vcg::Point3f(0, 0, 0.12F));
    network.set_position(b, network.position(b) * 0.5F - vcg::Point3f(0, 0, 0.12F));
    ASSERT_FALSE(cut_faces(network).empty());
    EXPECT_TRUE(smoothed_out(network, 1).empty());
    EXPECT_TRUE(cut_faces(network).empty());
}

TEST(Untangle, AddsNoCrossingsWhereSmoothingFails) {
    for (const double noise : {0.6, 1.5}) {
        Network network = crumpled_sphere(noise);
        const Network before = network;
        const std::size_t crossings_before = intersections(Surface(network), 1).size();
        EXPECT_LE(smoothed_out(network, 1).size(), crossings_before);
        Network again = before;
        smoothed_out(again, 3);
        for (VertexId v = 0; v < network.slot_count(); ++v) EXPECT_EQ(network.position(v), again.position(v));
    }
}

bool same_positions(const Network& a, const Network& b) {
    for (VertexId v = 0; v < a.slot_count(); ++v)
        if (a.position(v) != b.position(v)) return false;
    return true;
}

TEST(Untangle, GivesUpIfEveryFaceIsNearManyOthers) {
    // Corners anywhere in a ball: every face is near half of the others.
    Network network = crumpled_sphere(0);
    Random random(4);
    for (VertexId v = 0; v < network.slot_count(); ++v)
        network.set_position(v, vcg::Point3f::Construct(shapes::in_ball(random)));
    const Network before = network;
    EXPECT_EQ(*untangle(network, one_thread(), unwatched()), intersections(Surface(before), 1));
    EXPECT_TRUE(same_positions(network, before));
}

/// A plate 1 x 1 x \p thickness.
Cloud plate_cloud(int count, double thickness) {
    Cloud cloud = shapes::box_cloud(count);
    for (vcg::Point3d& p : cloud) p[2] *= thickness;
    return cloud;
}

// Faces much larger than the plate is thick: points of either side are next to faces of the other.
TEST(Fit, DoesNotMakeAPlateCutItself) {
    for (const double thickness : {0.02, 0.05, 0.1}) {
        const Cloud cloud = plate_cloud(20000, thickness);
        const TargetSpace target = target_of(cloud);
        Shape flattened = shapes::icosphere(2);
        for (vcg::Point3d& p : flattened.positions) p = {0.7 * p[0], 0.7 * p[1], 0.8 * thickness * p[2]};
        Network network = network_in_frame(target, flattened);
        ASSERT_TRUE(cut_faces(network).empty());
        const FitReport report = fit_to_points(network, target, {}, 1, 1, unwatched());
        EXPECT_TRUE(report.improved);
        EXPECT_TRUE(cut_faces(network).empty()) << thickness;
        EXPECT_EQ(network.validate(), "");
    }
}

TEST(Fit, LeavesNoMoreCrossingsThanThereWere) {
    const Cloud cloud = plate_cloud(20000, 0.03);
    const TargetSpace target = target_of(cloud);
    Network network = crumpled_sphere(0.12);
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        vcg::Point3f p = network.position(v) * 0.05F;
        p[2] *= 0.06F;
        network.set_position(v, p);
    }
    const std::size_t before = cut_faces(network).size();
    ASSERT_GT(before, 0U);
    fit_to_points(network, target, {}, 1, 1, unwatched());
    EXPECT_LE(cut_faces(network).size(), before);
    EXPECT_EQ(network.validate(), "");
}

// Folds of a surface that was seen from one side are smoothed out, and no step of the fit makes new ones.

const vcg::Point3f kAbove(0, 0, 1e6F);
constexpr int kSide = 21;
constexpr float kEdge = 1.0F / (kSide - 1);
constexpr VertexId kMiddle = kSide * kSide / 2;

/// A square whose middle vertex has passed its neighbour, and lies above it.
Network folded_square() {
    Network network = network_of(shapes::grid(kSide, kSide));
    network.set_position(kMiddle, network.position(kMiddle) + vcg::Point3f(1.6F * kEdge, 0, kEdge));
    return network;
}

int turned_away(const Surface& surface, const vcg::Point3f& viewer) {
    int count = 0;
    for (int f = 0; f < surface.face_count(); ++f)
        count += unit_normal(surface, f).dot(to_eigen(viewer) - surface.corner(f, 0)) < 0 ? 1 : 0;
    return count;
}

TEST(Unfold, TakesOutAFoldInTheImageOfTheViewer) {
    for (const vcg::Point3f& viewer : {kAbove, vcg::Point3f(0.3F, 0.2F, 2)}) {
        Network network = folded_square();
        const Network before = network;
        ASSERT_GT(turned_away(Surface(network), viewer), 0);
        network.set_viewer(viewer);
        unfold(network);
        EXPECT_EQ(turned_away(Surface(network), viewer), 0);
        for (const VertexId v : network.vertices()) {
            const vcg::Point3f way = network.position(v) - before.position(v);
            const vcg::Point3f sight = (viewer - before.position(v)).Normalize();
            EXPECT_LT(std::abs(way * sight), 0.2F * kEdge);
            const bool far = (before.position(v) - before.position(kMiddle)).Norm() > 4 * kEdge;
            EXPECT_TRUE(!far || way == vcg::Point3f(0, 0, 0));
        }
    }
}

TEST(Unfold, LeavesASurfaceThatNobodyHasSeenAlone) {
    Network network = folded_square();
    unfold(network);
    EXPECT_EQ(network.position(kMiddle), folded_square().position(kMiddle));
}

TEST(Unfold, KeepsAnOverhang) {
    // Half of a square turned over and laid on top of the other: a sheet folded in its middle.
    Network network = network_of(shapes::grid(kSide, kSide));
    for (const VertexId v : network.vertices()) {
        const vcg::Point3f p = network.position(v);
        if (p[0] > 0) network.set_position(v, {-p[0], p[1], 0.2F * std::min(p[0], 0.2F)});
    }
    const Network before = network;
    const int overhanging = turned_away(Surface(network), kAbove);
    network.set_viewer(kAbove);
    unfold(network);
    EXPECT_GT(turned_away(Surface(network), kAbove), overhanging * 8 / 10);
    for (const VertexId v : network.vertices())
        EXPECT_LT((network.position(v) - before.position(v)).Norm(), kEdge);
}

TEST(Unfold, IsNotUndoneByMoves) {
    Random random(1);
    Network network = network_of(shapes::grid(kSide, kSide));
    for (const VertexId v : network.vertices()) {  // steep, where little turns a face away
        const vcg::Point3f p = network.position(v);
        network.set_position(v, {0.05F * p[0], p[1], p[0]});
    }
    for (const bool seen : {false, true}) {
        if (seen) network.set_viewer(kAbove);
        const Surface surface(network);
        PerVertex<Vector3> moves(network.slot_count(), Vector3::Zero());
        for (Vector3& move : moves)
            move = 0.1F * kEdge * to_eigen(vcg::Point3f::Construct(shapes::in_ball(random)));
        Surface moved = surface;
        moved.positions = MoveLimits(network, surface, one_thread()).bounded(moves);
        ASSERT_EQ(turned_away(surface, kAbove), 0);
        EXPECT_EQ(turned_away(moved, kAbove) == 0, seen);
    }
}

// Surfaces with boundary that cut themselves lose the faces that do, and no more than must be.

/// A level sheet and, as further vertices, \p standing turned upright, \p depth below the sheet at its lower
/// end.
Network standing_on_sheet(const Shape& standing, double depth) {
    Shape shape = shapes::grid(12, 12);
    const int offset = static_cast<int>(shape.positions.size());
    for (const vcg::Point3d& p : standing.positions)
        shape.positions.emplace_back(0.013 + 0.6 * p[0], 0.021 + 0.1 * p[0], 0.5 + p[1] - depth);
    for (const Triangle& f : standing.faces)
        shape.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
    return network_of(shape);
}

std::vector<SelfIntersection> removed_from(Network& network, int threads = 1) {
    ThreadTeam team(threads);
    std::vector<SelfIntersection> left = intersections(Surface(network), threads);
    const int faces = network.face_count();
    const int removed = remove_cut_faces(network, left, team);
    EXPECT_EQ(removed, faces - network.face_count());
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(left, intersections(Surface(network), 1)) << "the plain search of the whole surface";
    return left;
}

TEST(CutFaces, ABoundaryThatPiercesASheetDrawsBack) {
    Network network = standing_on_sheet(shapes::grid(8, 8), 0.05);
    ASSERT_FALSE(intersections(Surface(network), 1).empty());
    EXPECT_TRUE(removed_from(network).empty());
    EXPECT_EQ(topology_of(network), (Topology{2, 0, 2}));
    const int sheet_faces = 2 * 11 * 11, row = 2 * 7;
    EXPECT_GE(network.face_count(), sheet_faces + 6 * row) << "only the lowest row of the standing part goes";
    for (VertexId v = 0; v < 144; ++v) EXPECT_TRUE(network.alive(v)) << "the sheet stays";
}

TEST(CutFaces, AStrandIsBroken) {
    Network network = standing_on_sheet(shapes::grid(2, 12), 0.5);
    EXPECT_TRUE(removed_from(network).empty());
    EXPECT_EQ(topology_of(network), (Topology{3, 0, 3}));
    for (VertexId v = 0; v < 144; ++v) EXPECT_TRUE(network.alive(v)) << "the sheet stays";
}

TEST(CutFaces, AFoldInsideIsCollapsedAndKeepsTheTopology) {
    Network network = network_of(shapes::grid(9, 9), 0.005);
    const VertexId middle = 40;
    network.set_position(middle, network.position(middle) + vcg::Point3f(0.3F, 0.02F, 0));
    ASSERT_FALSE(intersections(Surface(network), 1).empty());
    EXPECT_TRUE(removed_from(network).empty());
    EXPECT_EQ(topology_of(network), kDisc);
    EXPECT_GT(network.vertex_count(), 81 - 10);
}

TEST(CutFaces, ATangleLosesATenthOfItsFacesAtMost) {
    for (const double noise : {0.3, 1.0}) {
        Network network = network_of(shapes::grid(15, 15), noise);
        const int faces = network.face_count();
        EXPECT_FALSE(removed_from(network).empty());
        EXPECT_GE(network.face_count(), faces - faces / 10 - 12);
    }
}

TEST(SoundStart, KeepsTheNumberOfVertices) {
    for (const double depth : {0.05, 0.12}) {
        Network network = standing_on_sheet(shapes::grid(8, 8), depth);
        const Network before = network;
        const std::vector<SelfIntersection> left = *make_sound(network, one_thread(), unwatched());
        EXPECT_EQ(left, intersections(Surface(network), 1));
        EXPECT_TRUE(intersections(Surface(network), 1).empty());
        EXPECT_EQ(network.validate(), "");
        EXPECT_EQ(network.vertex_count(), before.vertex_count());
        EXPECT_EQ(network.component_count(), 2);
    }
}

TEST(SoundStart, OfAClosedSurfaceLosesNoFace) {
    Network network = crumpled_sphere(1.5);
    const std::vector<Triangle> faces = network.faces();
    EXPECT_FALSE(make_sound(network, one_thread(), unwatched())->empty());
    EXPECT_EQ(network.faces(), faces);
}

}  // namespace neuralmesh::tangles_test
