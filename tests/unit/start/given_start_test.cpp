// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A start mesh of the user's: what is refused, with which remedy, and what stays.
#include "vcg_core/start/given_start.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/support/open_shapes.h"
#include "tests/unit/support/soundness.h"

namespace neuralmesh {
namespace {

using shapes::Shape;

const TargetSpace& ball() {
    static const TargetSpace target = targets::target_of(shapes::sphere_cloud(4000));
    return target;
}

std::string complaint(const Shape& shape) {
    try {
        given_start(shape, ball());
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).back(), '.');
        return error.what();
    }
    return {};
}

void expect_remedy(const Shape& shape, const std::string& breach, const std::string& filter) {
    const std::string sentence = complaint(shape);
    EXPECT_NE(sentence.find(breach), std::string::npos) << sentence;
    EXPECT_NE(sentence.find("filter '" + filter), std::string::npos) << sentence;
}

TEST(GivenStart, NamesTheFirstBreachAndTheRemedy) {
    EXPECT_EQ(complaint(shapes::icosphere(1)), "");
    EXPECT_NE(complaint({shapes::icosphere(1).positions, {}}).find("has no faces"), std::string::npos);

    Shape shape = shapes::icosphere(1);
    shape.faces.push_back({3, 3, 4});
    expect_remedy(shape, "faces with a corner twice (1)", "Remove Zero Area Faces");

    shape.faces.back() = {shape.faces[5][1], shape.faces[5][0], shape.faces[5][2]};
    shape.faces.push_back(shape.faces[7]);
    expect_remedy(shape, "faces that repeat others (2)", "Remove Duplicate Faces");

    shape = shapes::icosphere(1);
    shape.positions.emplace_back(0, 0, 1.5);
    shape.faces.push_back({shape.faces[0][0], shape.faces[0][1], 42});
    expect_remedy(shape, "edges with more than two faces (1)", "Repair non Manifold Edges");

    shape = shapes::icosphere(1);
    std::swap(shape.faces[0][0], shape.faces[0][1]);
    expect_remedy(shape, "edges whose two faces have opposite orientations (3)",
                  "Re-Orient all faces coherently");

    shape = shapes::tetrahedron();
    shape.positions.insert(shape.positions.end(), {{2, 0, 0}, {2, 1, 0}, {2, 0, 1}});
    shape.faces.insert(shape.faces.end(), {{0, 4, 5}, {0, 5, 6}, {0, 6, 4}, {4, 6, 5}});
    expect_remedy(shape, "vertices where parts of the surface only touch (1)",
                  "Repair non Manifold Vertices by splitting");
}

/// Two fans of one face each are open, which must not hide that they only touch.
TEST(GivenStart, FindsVerticesWhereOpenPartsTouch) {
    Shape shape{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
    expect_remedy(shape, "vertices where parts of the surface only touch (1)",
                  "Repair non Manifold Vertices by splitting");
}

/// As an STL file is read: every face has vertices of its own.
TEST(GivenStart, FindsVerticesThatAreNotMerged) {
    const Shape sphere = shapes::icosphere(1);
    Shape soup;
    for (const auto& face : sphere.faces) {
        for (const int v : face) soup.positions.push_back(sphere.positions[static_cast<std::size_t>(v)]);
        const int n = static_cast<int>(soup.positions.size());
        soup.faces.push_back({n - 3, n - 2, n - 1});
    }
    expect_remedy(soup, "of which no two share a vertex", "Merge Close Vertices");
}

TEST(GivenStart, RefusesAMeshApartFromThePoints) {
    Shape far = shapes::icosphere(1);
    for (vcg::Point3d& p : far.positions) p += vcg::Point3d(5, 0, 0);
    EXPECT_NE(complaint(far).find("lies apart from the points"), std::string::npos);
}

/// The boxes of a plane and of points on it are flat.
TEST(GivenStart, TakesAPlaneOfPointsInItsPlane) {
    const TargetSpace plane = targets::target_of(shapes::plane_cloud(1000));
    EXPECT_EQ(given_start(shapes::grid(5, 5), plane).positions.size(), 25U);
}

/// Two poles of a hundred neighbours, and the middle of an open fan of sixty faces.
TEST(GivenStart, SplitsVerticesWithTooManyNeighbours) {
    for (const Shape& shape : {shapes::bipyramid(100), shapes::fan(60)}) {
        const auto before = referee::census(shape.faces);
        const IndexedMesh<float> start = given_start(shape, ball());
        const auto after = referee::census(start.faces);
        EXPECT_EQ(after.breach, "");
        EXPECT_LE(after.greatest_valence(), Ring::kMaxValence);
        EXPECT_EQ(after.euler(), before.euler());
        EXPECT_EQ(after.loops, before.loops);
        EXPECT_LT(after.vertices, 2 * before.vertices);
        EXPECT_EQ(Network(start.positions, start.faces).validate(), "");
    }
}

}  // namespace
}  // namespace neuralmesh
