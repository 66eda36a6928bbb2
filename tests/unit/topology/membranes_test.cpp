// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Membranes that are found on a handle as thin as a triangle.
#include "vcg_core/topology/membranes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>

#include "tests/unit/support/shapes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/topology/learned_topology.h"

namespace neuralmesh {
namespace {

using targets::network_in_frame;
using targets::target_of;

/// An arc of a torus of 340 degrees with plugs at its ends, which a thin tube joins: a ring of hoops of so
/// many vertices each. The last three hoops are those of the tube.
struct Arc {
    static constexpr int kHoops = 38, kFirstThin = 35;

    explicit Arc(int around) : around_(around) {
        for (int h = 0; h < kHoops; ++h)
            for (int i = 0; i < around; ++i) {
                const bool thin = h >= kFirstThin;
                const int degrees = thin ? 340 + 10 * (h - kFirstThin) : 10 * h;
                shape.positions.push_back(
                    shapes::torus_point(degrees / 360.0, double(i) / around, thin ? 0.08 : 0.4));
            }
        const auto id = [&](int h, int i) { return h % kHoops * around + i % around; };
        for (int h = 0; h < kHoops; ++h)
            for (int i = 0; i < around; ++i) {
                shape.faces.push_back({id(h, i), id(h + 1, i), id(h + 1, i + 1)});
                shape.faces.push_back({id(h, i), id(h + 1, i + 1), id(h, i + 1)});
            }
    }
    bool is_thin(int vertex) const { return vertex >= kFirstThin * around_; }
    bool is_in_middle(int vertex) const { return vertex / around_ == kFirstThin + 1; }

    /// Points of the faces, 1000 per unit of area. The tube has the given share of that, near the plugs.
    shapes::Cloud points(double of_tube) const {
        shapes::Cloud cloud;
        Random random(1);
        for (const std::array<int, 3>& f : shape.faces) {
            const auto corner = [&](std::size_t k) {
                return shape.positions[static_cast<std::size_t>(f[k])];
            };
            const vcg::Point3d a = corner(1) - corner(0), b = corner(2) - corner(0);
            const bool thin = is_thin(f[0]) && is_thin(f[1]) && is_thin(f[2]);
            double wanted = 500 * (a ^ b).Norm() * (thin ? of_tube : 1) + static_cast<double>(random.unit());
            while (wanted >= 1) {
                std::array<double, 3> weights{0, static_cast<double>(random.unit()),
                                              static_cast<double>(random.unit())};
                weights[0] = 1 - weights[1] - weights[2];
                if (weights[0] < 0) continue;
                double of_middle = 0;
                for (std::size_t k = 0; k < 3; ++k) of_middle += is_in_middle(f[k]) ? weights[k] : 0;
                if (thin && of_tube < 1 && of_middle > 0.5) continue;
                cloud.push_back(corner(0) + a * weights[1] + b * weights[2]);
                wanted -= 1;
            }
        }
        return cloud;
    }

    shapes::Shape shape;

private:
    int around_;
};

struct Found {
    Found(const Arc& arc, double of_tube)
        : target(target_of(arc.points(of_tube))), network(network_in_frame(target, arc.shape)) {
        Random random(1);
        ThreadTeam team(1);
        evidence = topology_evidence(network, target, random, team);
    }
    TargetSpace target;
    Network network;
    std::optional<TopologyEvidence> evidence;
};

TEST(Membranes, AreCertainIfTheyAreTubesHoweverThin) {
    const Found found(Arc(3), 0);
    ASSERT_EQ(found.evidence->membranes.size(), 1U);
    const Membrane& tube = found.evidence->membranes.front();
    float area = 0;
    for (const int f : tube.faces) area += found.evidence->support.area[f];
    const float edge = mean_edge_length(found.evidence->surface);
    EXPECT_LT(area, edge * edge) << "too small for a membrane with one rim";
    EXPECT_EQ(tube.rims.size(), 2U);
    EXPECT_TRUE(tube.certain);
}

}  // namespace
}  // namespace neuralmesh
