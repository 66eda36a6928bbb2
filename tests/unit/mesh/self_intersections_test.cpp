// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Self-intersections against vcglib's, and their update after changes against a new search.
#include "vcg_core/mesh/self_intersections.h"

#include <vcg/complex/algorithms/clean.h>
#include <vcg/complex/algorithms/update/bounding.h>
#include <vcg/complex/algorithms/update/normal.h>
#include <vcg/complex/complex.h>

#include "tests/unit/support/crumpled.h"

namespace neuralmesh::self_intersections_test {

class CutVertex;
class CutFace;
struct CutTypes : vcg::UsedTypes<vcg::Use<CutVertex>::AsVertexType, vcg::Use<CutFace>::AsFaceType> {};
class CutVertex : public vcg::Vertex<CutTypes, vcg::vertex::Coord3f, vcg::vertex::BitFlags> {};
class CutFace : public vcg::Face<CutTypes, vcg::face::VertexRef, vcg::face::Normal3f, vcg::face::Mark,
                                 vcg::face::BitFlags> {};
class CutMesh : public vcg::tri::TriMesh<std::vector<CutVertex>, std::vector<CutFace>> {};

std::vector<SelfIntersection> after(const Surface& surface, const Surface& before,
                                    const std::vector<SelfIntersection>& known, int threads) {
    ThreadTeam team(threads);
    return update_self_intersections(surface, before, known, team);
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

TEST(Crossings, FacesApartInATiltedPlaneHaveNone) {
    for (const double tilt : {0.01, 0.1, 0.3, 0.7}) {
        Shape sheet = shapes::grid(12, 12);
        for (vcg::Point3d& p : sheet.positions) p += vcg::Point3d(0.013, tilt * p[0] + 0.021, 0.3 * p[1]);
        EXPECT_TRUE(intersections(Surface(network_of(sheet)), 1).empty()) << tilt;
    }
}

TEST(Crossings, AreTheSameForAnyNumberOfThreads) {
    const Surface surface(crumpled_sphere(0.3));
    const std::vector<SelfIntersection> one = intersections(surface, 1);
    EXPECT_TRUE(std::is_sorted(one.begin(), one.end()));
    EXPECT_EQ(one, intersections(surface, 2));
    EXPECT_EQ(one, intersections(surface, 5));
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
    std::int64_t pairs = 0;
    const Surface surface(network);
    for (const SelfIntersection& c : self_intersections(surface, one_thread(), &pairs))
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
    const auto some = [&] { return any_slot(network, random); };
    for (int change = 0; change < 30; ++change) {
        const Surface before(network);
        const std::vector<SelfIntersection> known = intersections(before, 1);
        const VertexId v = some();
        if (network.alive(v)) network.set_position(v, network.position(v) * 0.9F);
        const Surface moved(network);
        EXPECT_EQ(after(moved, before, known, 2), intersections(moved, 1)) << change;
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
        const std::vector<SelfIntersection> all = intersections(surface, 1);
        EXPECT_FALSE(all.empty());
        EXPECT_EQ(after(surface, before, known, 1), all) << change;
        EXPECT_EQ(after(surface, before, known, 3), all) << change;
    }
}

}  // namespace neuralmesh::self_intersections_test
