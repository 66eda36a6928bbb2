// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/closed_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "vcg_core/start/bridgeless_growth.h"
#include "vcg_core/start/marching_tetrahedra.h"

namespace neuralmesh {
namespace {

// In lattice steps. In sealed spaces, grown solids and specks the distance to the points has the wrong sign.
// Such nodes get the sign of the solid and this distance.
constexpr float kMinDistance = 0.2F;

/// Signed distances in lattice steps from the surface of \p solid, negative inside.
PerNode<float> signed_distances(const Region& region, const NodeSet& solid, int level) {
    const float radius = std::sqrt(static_cast<float>(level) + 0.5F);  // between this level and the next
    PerNode<float> values(solid.size());
    for (NodeId i = 0; i < values.size(); ++i) {
        const float d = std::sqrt(static_cast<float>(region.distances[i])) - radius;
        values[i] = solid[i] != 0 ? std::min(d, -kMinDistance) : std::max(d, kMinDistance);
    }
    return values;
}

/// Every \p stride-th node along each axis, surrounded by nodes outside.
struct StridedValues {
    Lattice lattice;
    PerNode<float> values;
};

StridedValues with_stride(const Lattice& lattice, const PerNode<float>& values, int stride) {
    const auto nodes = [&](int n) { return (n + 2 + stride - 1) / stride + 1; };
    StridedValues strided{lattice, {}};
    Lattice& coarse = strided.lattice;
    coarse.nx = nodes(lattice.nx);
    coarse.ny = nodes(lattice.ny);
    coarse.nz = nodes(lattice.nz);
    coarse.step = lattice.step * static_cast<float>(stride);
    coarse.corner = lattice.position(-1, -1, -1);
    strided.values.assign(coarse.size(), 1.0F);
    for_each_node(coarse, [&](int x, int y, int z) {
        const int fx = x * stride - 1, fy = y * stride - 1, fz = z * stride - 1;
        if (lattice.contains(fx, fy, fz))
            strided.values[coarse.index(x, y, z)] = values[lattice.index(fx, fy, fz)];
    });
    return strided;
}

Network surface_of(const Region& region, const PerNode<float>& distances, int stride) {
    const StridedValues strided = with_stride(region.lattice, distances, stride);
    const IndexedMesh<float> mesh = marching_tetrahedra(strided.lattice, strided.values);
    return mesh.faces.empty() ? Network() : Network(mesh.positions, mesh.faces);
}

/// The Euler characteristic comes first: it need not be counted.
bool has_topology(const TopologyVote& vote, const Network& closed) {
    return closed.euler_characteristic() == 2 * (vote.components - vote.genus) &&
           closed.component_count() == vote.components;
}

ClosedMesh mesh_of(NodeSet solid, int level, const Region& region, const TopologyVote& vote) {
    ClosedMesh closed{Network(), std::move(solid), level};
    const PerNode<float> distances = signed_distances(region, closed.solid, level);
    for (const int stride : {3, 2, 1}) {
        closed.network = surface_of(region, distances, stride);
        if (has_topology(vote, closed.network)) break;
    }
    return closed;
}

}  // namespace

ClosedMesh closed_mesh(const Region& region, const TopologyVote& vote) {
    // Level 0 is grown to almost three times its radius, which makes bores so narrow that learning closes
    // them: three of four runs of anchor, 500 vertices from 200,000 points, lost one.
    if (vote.level == 0 && vote.genus > 0) {
        ClosedMesh closed = mesh_of(plain_solid(region, 0), 0, region, vote);
        if (has_topology(vote, closed.network)) return closed;
    }
    return mesh_of(grown_solid(region, vote.level), grown_level(vote.level), region, vote);
}

}  // namespace neuralmesh
