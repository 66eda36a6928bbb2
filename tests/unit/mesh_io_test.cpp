// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A caller's mesh in single precision: error messages for coordinates that are not finite, and the origin
// that the result's coordinates are relative to.
#include "vcg_core/mesh_io.h"

#include "tests/unit/support/layer_mesh.h"

namespace neuralmesh::mesh_io_test {

using layer_mesh::fill;
using layer_mesh::Mesh;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

vcg::Matrix44f moved(float x, float y, float z) {
    vcg::Matrix44f matrix;
    matrix.SetTranslate(x, y, z);
    return matrix;
}

std::string complaint(const Mesh& mesh, const vcg::Matrix44f& matrix, const Settings& settings = {}) {
    return complaint_of([&] { target_space_of(mesh, matrix, settings); });
}

class OfFaces : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(MeshIo, OfFaces, testing::Bool());

TEST_P(OfFaces, CountsVerticesThatAreNotFiniteOnce) {
    Mesh mesh;
    fill(mesh, shapes::cube(), GetParam());
    EXPECT_EQ(complaint(mesh, moved(0, 0, 0)), "");
    mesh.vert[2].P()[1] = kNan;
    EXPECT_EQ(complaint(mesh, moved(0, 0, 0)).find("1 of the 8 vertices of the layer"), 0U);
    mesh.vert[5].P()[0] = -kInfinity;
    // The message names the vertices although the matrix is not finite either.
    EXPECT_EQ(complaint(mesh, moved(kNan, 0, 0)).find("2 of the 8 vertices of the layer"), 0U);
}

TEST_P(OfFaces, DistinguishesAMatrixThatIsNotFinite) {
    Mesh mesh;
    fill(mesh, shapes::cube(), GetParam());
    EXPECT_EQ(complaint(mesh, moved(0, kNan, 0)).find("The matrix of the layer"), 0U);
    EXPECT_EQ(complaint(mesh, moved(0, 0, kInfinity)).find("The matrix of the layer"), 0U);
}

TEST_P(OfFaces, ChecksOnlyWhatIsLearned) {
    Mesh mesh;
    fill(mesh, shapes::cube(), GetParam());
    vcg::tri::Allocator<Mesh>::AddVertex(mesh, vcg::Point3f(kNan, 0, 0));
    Settings settings;
    settings.selected_only = true;
    for (auto& v : mesh.vert) v.SetS();
    for (auto& f : mesh.face) f.SetS();
    mesh.vert.back().ClearS();
    EXPECT_EQ(complaint(mesh, moved(0, 0, 0), settings), "");
}

NeuralMesh cube_at(const vcg::Point3d& place) {
    NeuralMesh result;
    for (const vcg::Point3d& p : shapes::cube().positions) result.positions.push_back(p + place);
    result.counters.assign(result.positions.size(), 0);
    result.features.assign(result.positions.size(), 0);
    return result;
}

constexpr Coordinates kWorld{};

TEST(MeshIo, UsesTheLayersOriginIfRoundingWouldBeVisibleAndItHelps) {
    EXPECT_EQ(origin_of<Mesh>(cube_at({0, 0, 0}), moved(0, 0, 0)), kWorld);
    EXPECT_EQ(origin_of<Mesh>(cube_at({100, -50, 7}), moved(100, -50, 7)), kWorld);
    const Coordinates there{1e7, -1e7, 5e6};
    EXPECT_EQ(origin_of<Mesh>(cube_at({1e7, -1e7, 5e6}), moved(1e7F, -1e7F, 5e6F)), there);
    for (const float x : {0.0F, 1000.0F, -1e7F})
        EXPECT_EQ(origin_of<Mesh>(cube_at({1e7, 0, 0}), moved(x, 0, 0)), kWorld) << x;
}

TEST(MeshIo, KeepsTheGeometryRelativeToAnOrigin) {
    const vcg::Point3d place(1e7, -1e7, 5e6);
    const vcg::Point3d shift(0.123456, -0.654321, 0.5);
    const NeuralMesh result = cube_at(place + shift);
    Mesh out;
    write_mesh(result, Settings(), out, origin_of<Mesh>(result, moved(1e7F, -1e7F, 5e6F)));
    ASSERT_EQ(out.vert.size(), result.positions.size());
    for (std::size_t i = 0; i < out.vert.size(); ++i) {
        const vcg::Point3d exact = result.positions[i] - place;
        EXPECT_LT((vcg::Point3d::Construct(out.vert[i].cP()) - exact).Norm(), 1e-6);
    }
}

TEST_P(OfFaces, TakesTheColoursOfWhatIsLearned) {
    Mesh mesh;
    fill(mesh, shapes::cube(), GetParam());
    for (std::size_t i = 0; i < mesh.vert.size(); ++i)
        mesh.vert[i].C() = vcg::Color4b(static_cast<unsigned char>(i), 7, 9, 255);
    Settings settings;
    EXPECT_FALSE(target_space_of(mesh, moved(0, 0, 0), settings).has_colors());
    settings.selected_only = true;
    if (GetParam()) {
        for (std::size_t i = 2; i < mesh.face.size(); ++i) mesh.face[i].SetS();
    } else {
        for (std::size_t i = 1; i < mesh.vert.size(); ++i) mesh.vert[i].SetS();
    }
    const TargetSpace target = target_space_of(mesh, moved(0, 0, 0), settings, true);
    ASSERT_EQ(target.colors().size(), target.positions().size());
    for (std::size_t i = 0; i < target.colors().size(); ++i) {
        const Color& color = target.colors()[i];
        const vcg::Point3f here = target.frame().inside(vcg::Point3d::Construct(mesh.vert[color[0]].cP()));
        EXPECT_EQ(target.positions()[i], here) << i;
        EXPECT_EQ(color[1] + color[2], 16);
    }
}

/// The cube's corners with the directions from its centre as normals, of other lengths, but for two.
void fill_with_normals(Mesh& mesh) {
    fill(mesh, shapes::cube(), false);
    for (auto& vertex : mesh.vert) vertex.N() = vertex.P() * 7;
    mesh.vert[2].N() = {0, 0, 0};
    mesh.vert[3].N() = {kNan, 1, 0};
}

TEST(MeshIo, TakesTheNormalsOfPointsAlongWithTheLayersMatrix) {
    Mesh mesh;
    fill_with_normals(mesh);
    vcg::Matrix44f turned, mirrored, flattened;
    turned.SetRotateDeg(70, {1, 2, 3});
    mirrored.SetScale(-2, 2, 2);
    flattened.SetScale(1, 1, 0);
    const TargetSpace plain = target_space_of(mesh, moved(100, 0, 0), Settings());
    ASSERT_EQ(plain.normals().size(), 8U);
    EXPECT_TRUE(plain.normals()[2] == kNoNormal && plain.normals()[3] == kNoNormal);
    for (const vcg::Matrix44f& matrix : {moved(100, 0, 0), turned, mirrored}) {
        const TargetSpace target = target_space_of(mesh, matrix, Settings());
        for (std::size_t i : {0U, 1U, 4U, 7U})  // still away from the centre
            EXPECT_GT(unpacked(target.normals()[i]) * target.positions()[i],
                      0.98F * target.positions()[i].Norm())
                << i;
    }
    mesh.vert[0].N() = {0, 1, 1};  // a plane stretched along y becomes less steep there
    vcg::Matrix44f stretched;
    stretched.SetScale(1, 3, 1);
    const vcg::Point3f n = unpacked(target_space_of(mesh, stretched, Settings()).normals()[0]);
    EXPECT_NEAR(n[2] / n[1], 3, 0.1);
    EXPECT_NO_THROW(target_space_of(mesh, flattened, Settings()));
}

TEST(MeshIo, TakesNoNormalsThatAreZeroSwitchedOffOrOfFaces) {
    Mesh zero;
    fill(zero, shapes::cube(), false);
    for (auto& vertex : zero.vert) vertex.N() = {0, 0, 0};
    EXPECT_FALSE(target_space_of(zero, moved(0, 0, 0), Settings()).has_normals());
    Mesh mesh;
    fill_with_normals(mesh);
    Settings settings;
    EXPECT_TRUE(target_space_of(mesh, moved(0, 0, 0), settings).has_normals());
    settings.use_normals = false;
    EXPECT_FALSE(target_space_of(mesh, moved(0, 0, 0), settings).has_normals());
    Mesh faces;
    fill(faces, shapes::cube(), true);
    for (auto& vertex : faces.vert) vertex.N() = vertex.P();
    EXPECT_FALSE(target_space_of(faces, moved(0, 0, 0), Settings()).has_normals());
}

TEST(MeshIo, TakesTheNormalsOfWhatIsSelected) {
    Mesh mesh;
    fill_with_normals(mesh);
    for (std::size_t i = 3; i < 8; ++i) mesh.vert[i].SetS();
    Settings settings;
    settings.selected_only = true;
    const TargetSpace target = target_space_of(mesh, moved(0, 0, 0), settings);
    ASSERT_EQ(target.normals().size(), 5U);
    EXPECT_EQ(target.normals()[0], kNoNormal);
    EXPECT_NE(target.normals()[1], kNoNormal);
}

}  // namespace neuralmesh::mesh_io_test
