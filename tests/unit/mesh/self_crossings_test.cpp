// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Surfaces that cut themselves: found as vcglib finds them, smoothed out, and never made by the fit.
#include "vcg_core/mesh/self_crossings.h"

#include <gtest/gtest.h>
#include <vcg/complex/algorithms/clean.h>
#include <vcg/complex/algorithms/update/bounding.h>
#include <vcg/complex/algorithms/update/normal.h>
#include <vcg/complex/complex.h>

#include <algorithm>
#include <set>

#include "tests/unit/support/shapes.h"
#include "vcg_core/fit/crossing_guard.h"
#include "vcg_core/fit/fit.h"
#include "vcg_core/fit/untangle.h"

namespace neuralmesh {
namespace {

using shapes::Shape;

class CutVertex;
class CutFace;
struct CutTypes : vcg::UsedTypes<vcg::Use<CutVertex>::AsVertexType, vcg::Use<CutFace>::AsFaceType> {};
class CutVertex : public vcg::Vertex<CutTypes, vcg::vertex::Coord3f, vcg::vertex::BitFlags> {};
class CutFace : public vcg::Face<CutTypes, vcg::face::VertexRef, vcg::face::Normal3f, vcg::face::Mark,
                                 vcg::face::BitFlags> {};
class CutMesh : public vcg::tri::TriMesh<std::vector<CutVertex>, std::vector<CutFace>> {};

std::vector<SelfCrossing> crossings(const Surface& surface, int threads) {
    ThreadTeam team(threads);
    return self_crossings(surface, team);
}

std::vector<SelfCrossing> after(const Surface& surface, const Surface& before,
                                const std::vector<SelfCrossing>& known, int threads) {
    ThreadTeam team(threads);
    return update_self_crossings(surface, before, known, team);
}

std::vector<SelfCrossing> smoothed_out(Network& network, int threads) {
    ThreadTeam team(threads);
    NoProgress progress;
    return *untangle(network, team, progress);
}

/// A sphere of radius 10, where vcglib's tolerances are small, crumpled by \p noise.
Network crumpled_sphere(double noise, std::uint64_t seed = 5) {
    const Shape sphere = shapes::icosphere(3);
    Random random(seed);
    std::vector<vcg::Point3f> positions;
    for (const vcg::Point3d& p : sphere.positions)
        positions.push_back(vcg::Point3f::Construct((p + shapes::in_ball(random) * noise) * 10.0));
    return Network(positions, std::vector<Triangle>(sphere.faces.begin(), sphere.faces.end()));
}

std::set<Triangle> cut_faces(const Network& network) {
    std::set<Triangle> faces;
    for (const SelfCrossing& c : crossings(Surface(network), 1)) {
        faces.insert({c[0], c[1], c[2]});
        faces.insert({c[3], c[4], c[5]});
    }
    return faces;
}

std::set<Triangle> cut_faces_by_vcglib(const Network& network) {
    CutMesh mesh;
    vcg::tri::Allocator<CutMesh>::AddVertices(mesh, static_cast<std::size_t>(network.slot_count()));
    for (VertexId v = 0; v < network.slot_count(); ++v)
        mesh.vert[static_cast<std::size_t>(v)].P() = network.position(v);
    const auto vertex = [&](VertexId v) { return &mesh.vert[static_cast<std::size_t>(v)]; };
    for (const Triangle& f : network.faces())
        vcg::tri::Allocator<CutMesh>::AddFace(mesh, vertex(f[0]), vertex(f[1]), vertex(f[2]));
    vcg::tri::UpdateBounding<CutMesh>::Box(mesh);
    std::vector<CutFace*> found;
    vcg::tri::Clean<CutMesh>::SelfIntersections(mesh, found);
    std::set<Triangle> faces;
    for (const CutFace* f : found) {
        Triangle t;
        for (int k = 0; k < 3; ++k)
            t[static_cast<std::size_t>(k)] = static_cast<VertexId>(f->cV(k) - mesh.vert.data());
        std::sort(t.begin(), t.end());
        faces.insert(t);
    }
    return faces;
}

TEST(Crossings, ARoundSphereHasNone) { EXPECT_TRUE(cut_faces(crumpled_sphere(0)).empty()); }

TEST(Crossings, AreThoseThatVcglibFinds) {
    for (const double noise : {0.1, 0.2, 0.4}) {
        const Network network = crumpled_sphere(noise);
        const std::set<Triangle> faces = cut_faces(network);
        EXPECT_FALSE(faces.empty());
        EXPECT_EQ(faces, cut_faces_by_vcglib(network)) << noise;
    }
}

TEST(Crossings, AreTheSameForAnyNumberOfThreads) {
    const Surface surface(crumpled_sphere(0.3));
    const std::vector<SelfCrossing> one = crossings(surface, 1);
    EXPECT_TRUE(std::is_sorted(one.begin(), one.end()));
    EXPECT_EQ(one, crossings(surface, 2));
    EXPECT_EQ(one, crossings(surface, 5));
}

TEST(Crossings, AreIndifferentToTheScale) {
    Network network = crumpled_sphere(0.1);
    const std::set<Triangle> faces = cut_faces(network);
    ASSERT_FALSE(faces.empty());
    // Down to edges of 1e-6, a tenth of the finest cells that the learning has. What is multiplied must not
    // become 0.
    for (int halvings = 1; halvings <= 20; ++halvings) {
        for (VertexId v = 0; v < network.slot_count(); ++v)
            network.set_position(v, network.position(v) * 0.5F);
        EXPECT_EQ(cut_faces(network), faces) << halvings;
    }
}

// As where more vertices are asked for than the cloud has places: all pairs would be near each other.
TEST(Crossings, FacesWithoutAreaHaveNoneAndCostNothing) {
    Network network = crumpled_sphere(0.1);
    for (VertexId v = 0; v < network.slot_count(); ++v)
        if (network.position(v)[2] > 0) network.set_position(v, {0, 0, 5});
    ThreadTeam team(1);
    std::int64_t pairs = 0;
    const Surface surface(network);
    for (const SelfCrossing& c : self_crossings(surface, team, &pairs))
        for (const std::size_t face : {0U, 3U}) {
            const Vector3& a = surface.positions[c[face]];
            const Vector3& b = surface.positions[c[face + 1]];
            EXPECT_NE((b - a).cross(surface.positions[c[face + 2]] - a), Vector3(0, 0, 0));
        }
    EXPECT_LT(pairs, 10 * network.face_count());
}

// Vertices move, edges are flipped, vertices go and others take their ids.
TEST(Crossings, AreKnownAfterAChangeFromThoseBefore) {
    Network network = crumpled_sphere(0.2);
    Random random(3);
    const auto some = [&] {
        return static_cast<VertexId>(random.below(static_cast<std::uint32_t>(network.slot_count())));
    };
    for (int change = 0; change < 30; ++change) {
        const Surface before(network);
        const std::vector<SelfCrossing> known = crossings(before, 1);
        const VertexId v = some();
        if (network.alive(v)) network.set_position(v, network.position(v) * 0.9F);
        for (int i = 0; i < 5; ++i) {
            const VertexId a = some();
            const VertexId b = network.ring(a).valence > 0 ? network.ring(a)[0] : some();
            if (network.can_flip(a, b)) network.flip(a, b);
            const VertexId gone = some();
            if (!network.alive(gone) || !network.can_collapse(gone, network.ring(gone)[0])) continue;
            network.collapse(gone, network.ring(gone)[0]);
            const VertexId split = some();
            if (network.alive(split) && network.can_split(split, 0, 3))
                network.split(split, 0, 3, network.position(split) * 1.02F);
        }
        ASSERT_EQ(network.validate(), "");
        const Surface surface(network);
        const std::vector<SelfCrossing> all = crossings(surface, 1);
        EXPECT_FALSE(all.empty());
        EXPECT_EQ(after(surface, before, known, 1), all) << change;
        EXPECT_EQ(after(surface, before, known, 3), all) << change;
    }
}

TEST(CrossingGuard, ObjectsToWhatIsNewBeyondWhatWasThere) {
    const SelfCrossing a{0, 1, 2, 3, 4, 5};
    const SelfCrossing b{6, 7, 8, 9, 10, 11};
    CrossingGuard strict;
    EXPECT_TRUE(strict.objections({}).empty());
    EXPECT_EQ(strict.objections({a}), std::vector<VertexId>(a.begin(), a.end()));
    CrossingGuard guard({a});
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
    EXPECT_LT(moved, 200) << "far from it nothing moves";
}

TEST(Untangle, LeavesAloneWhatItCannotMend) {
    for (const double noise : {0.6, 1.5}) {
        Network network = crumpled_sphere(noise);
        const Network before = network;
        const std::size_t before_it = crossings(Surface(network), 1).size();
        EXPECT_LE(smoothed_out(network, 1).size(), before_it);
        Network again = before;
        smoothed_out(again, 3);
        for (VertexId v = 0; v < network.slot_count(); ++v) EXPECT_EQ(network.position(v), again.position(v));
    }
}

/// Asks to stop at its \p last call.
class Patience : public Progress {
public:
    explicit Patience(int last) : last_(last) {}
    bool operator()(double fraction, const char*) override {
        EXPECT_GE(fraction, fraction_);
        EXPECT_LE(fraction, 1);
        fraction_ = fraction;
        return ++calls < last_;
    }
    int calls = 0;

private:
    int last_;
    double fraction_ = 0;
};

bool same_positions(const Network& a, const Network& b) {
    for (VertexId v = 0; v < a.slot_count(); ++v)
        if (a.position(v) != b.position(v)) return false;
    return true;
}

TEST(Untangle, StopsBeforeAnySearchWithTheMeshAsItWas) {
    const Network before = crumpled_sphere(0.6);
    ThreadTeam team(1);
    int last = 1;
    for (;; ++last) {
        Network network = before;
        Patience progress(last);
        if (untangle(network, team, progress)) break;
        EXPECT_EQ(progress.calls, last);
        EXPECT_TRUE(same_positions(network, before));
    }
    EXPECT_GT(last, 3);
}

TEST(Untangle, DoesNotTryWhereAllFacesLieInEachOther) {
    // Corners anywhere in a ball: every face is near half of the others.
    Network network = crumpled_sphere(0);
    Random random(4);
    for (VertexId v = 0; v < network.slot_count(); ++v)
        network.set_position(v, vcg::Point3f::Construct(shapes::in_ball(random)));
    const Network before = network;
    ThreadTeam team(1);
    Patience progress(99);
    EXPECT_EQ(*untangle(network, team, progress), crossings(Surface(before), 1));
    EXPECT_EQ(progress.calls, 1);
    EXPECT_TRUE(same_positions(network, before));
}

/// A plate 1 x 1 x \p thickness.
shapes::Cloud plate_cloud(int count, double thickness) {
    shapes::Cloud cloud = shapes::box_cloud(count);
    for (vcg::Point3d& p : cloud) p[2] *= thickness;
    return cloud;
}

// Faces much larger than the plate is thick: points of either side are next to faces of the other.
TEST(Fit, DoesNotMakeAPlateCutItself) {
    for (const double thickness : {0.02, 0.05, 0.1}) {
        const shapes::Cloud cloud = plate_cloud(20000, thickness);
        const TargetSpace target = TargetSpace::points(cloud.size(), [&](std::size_t i) { return cloud[i]; });
        const Shape sphere = shapes::icosphere(2);
        std::vector<vcg::Point3f> positions;
        for (const vcg::Point3d& p : sphere.positions)
            positions.push_back(target.frame().inside({0.7 * p[0], 0.7 * p[1], 0.8 * thickness * p[2]}));
        Network network(positions, std::vector<Triangle>(sphere.faces.begin(), sphere.faces.end()));
        ASSERT_TRUE(cut_faces(network).empty());
        NoProgress progress;
        const FitReport report = fit_to_points(network, target, {}, 1, 1, progress);
        EXPECT_TRUE(report.improved);
        EXPECT_TRUE(cut_faces(network).empty()) << thickness;
        EXPECT_EQ(network.validate(), "");
    }
}

TEST(Fit, LeavesNoMoreCrossingsThanThereWere) {
    const shapes::Cloud cloud = plate_cloud(20000, 0.03);
    const TargetSpace target = TargetSpace::points(cloud.size(), [&](std::size_t i) { return cloud[i]; });
    Network network = crumpled_sphere(0.12);
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        vcg::Point3f p = network.position(v) * 0.05F;
        p[2] *= 0.06F;
        network.set_position(v, p);
    }
    const std::size_t before = cut_faces(network).size();
    ASSERT_GT(before, 0U);
    NoProgress progress;
    fit_to_points(network, target, {}, 1, 1, progress);
    EXPECT_LE(cut_faces(network).size(), before);
    EXPECT_EQ(network.validate(), "");
}

}  // namespace
}  // namespace neuralmesh
