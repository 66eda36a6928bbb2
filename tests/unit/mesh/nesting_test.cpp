// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Bodies within hollows of bodies: depth and orientation of their surfaces.
#include "vcg_core/mesh/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Octahedra, each given by its centre and its radius; those with a negative radius are inside out.
struct Octahedron {
    Point3f centre;
    float radius;
};

Network octahedra(const std::vector<Octahedron>& all) {
    std::vector<Point3f> positions;
    std::vector<Triangle> faces;
    for (const Octahedron& each : all) {
        const int first = static_cast<int>(positions.size());
        for (int k = 0; k < 6; ++k) {
            Point3f p(0, 0, 0);
            p[k / 2] = k % 2 == 0 ? each.radius : -each.radius;
            positions.push_back(each.centre + p);
        }
        for (const int x : {0, 1})
            for (const int y : {2, 3})
                for (const int z : {4, 5}) {
                    const bool even = (x + y + z) % 2 == 0;
                    faces.push_back({first + x, first + (even ? y : z), first + (even ? z : y)});
                }
    }
    return {positions, faces};
}

double volume_of(const Network& network, int of) {
    const PerVertex<int> component = network.components();
    double volume = 0;
    for (const Triangle& f : network.faces()) {
        if (component[f[0]] != of) continue;
        const auto p = [&](std::size_t k) { return vcg::Point3d::Construct(network.position(f[k])); };
        volume += p(0) * (p(1) ^ p(2)) / 6;
    }
    return volume;
}

/// Whether each component is within an odd number of others, by how it is oriented.
std::vector<bool> hollows_of(Network network) {
    network.orient_outward();
    EXPECT_EQ(network.validate(), "");
    std::vector<bool> hollows;
    for (int i = 0; i < network.component_count(); ++i) hollows.push_back(volume_of(network, i) < 0);
    return hollows;
}

TEST(Nesting, IsFoundWhereRaysMeetEdgesAndVertices) {
    // The ray along x from a vertex of the inner octahedron meets the vertex, and from others the edges, of
    // the outer one.
    const Point3f o(0, 0, 0);
    for (const Point3f& at : {Point3f(-0.1F, 0, 0), Point3f(-0.1F, 0.2F, 0), Point3f(-0.1F, 0, -0.2F)})
        EXPECT_EQ(hollows_of(octahedra({{o, 1}, {at, 0.1F}})), (std::vector<bool>{false, true})) << at[1];
    EXPECT_EQ(hollows_of(octahedra({{o, 1}, {Point3f(-3, 0, 0), 0.1F}})), (std::vector<bool>{false, false}));
}

TEST(Nesting, IsThatOfMostOfAComponent) {
    // The first vertex of the inner surface sticks out of the outer one.
    const Point3f o(0, 0, 0);
    Network network = octahedra({{o, 2}, {o, 1}});
    network.set_position(6, Point3f(2.5F, 0, 0));
    EXPECT_EQ(hollows_of(network), (std::vector<bool>{false, true}));
}

TEST(Nesting, NothingIsWithinAnOpenSurface) {
    const Point3f o(0, 0, 0);
    Network network = octahedra({{o, 4}, {o, 1}});
    // A face of the outer one behind the inner one, from where no ray comes: rays still meet the others.
    const std::vector<Triangle> faces = network.faces();
    const auto behind = std::find_if(faces.begin(), faces.end(), [](const Triangle& f) {
        return std::find(f.begin(), f.end(), 1) != f.end();
    });
    network.exchange_faces({*behind}, {});
    EXPECT_FALSE(hollows_of(network)[1]);
}

TEST(Nesting, OrientsHollowsInward) {
    const Point3f o(0, 0, 0);
    for (const float sign : {1.0F, -1.0F})
        EXPECT_EQ(hollows_of(octahedra({{o, 4 * sign}, {o, 2 * sign}, {o, sign}, {Point3f(9, 0, 0), sign}})),
                  (std::vector<bool>{false, true, false, false}));
}

}  // namespace
}  // namespace neuralmesh
