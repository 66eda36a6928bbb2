// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/orientation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "vcg_core/mesh/boundary_loops.h"
#include "vcg_core/mesh/face_tree.h"
#include "vcg_core/start/viewpoint.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// The standard error of a share of so many votes is .0035, far less than what makes it clear.
constexpr std::size_t kMostVoters = 20000;
constexpr double kClear = 0.6;  ///< more than this share on one side, or less than the rest of it

/// Turns the faces over whose first vertex is one that \p turned accepts. \pre the network is compact
template <class Turned>
void turn(Network& network, const Turned& turned) {
    std::vector<Point3f> positions;
    for (VertexId v = 0; v < network.slot_count(); ++v) positions.push_back(network.position(v));
    std::vector<Triangle> faces = network.faces();
    for (Triangle& f : faces)
        if (turned(f[0])) std::swap(f[1], f[2]);
    network = Network(positions, faces);
}

}  // namespace

bool OrientationVote::is_clear() const {
    const double share = share_along();
    return along + against > 0 && (share > kClear || share < 1 - kClear);
}

double OrientationVote::share_along() const {
    return static_cast<double>(along) / static_cast<double>(std::max<long long>(1, along + against));
}

std::vector<OrientationVote> orientation_votes(const Network& network, const TargetSpace& target) {
    std::vector<OrientationVote> votes(static_cast<std::size_t>(network.component_count()));
    const PerVertex<int> component = network.components();
    for (const VertexId v : network.vertices())
        if (network.ring(v).open != 0) votes[static_cast<std::size_t>(component[v])].open = true;
    if (!target.has_normals()) return votes;
    const Surface surface(network);
    const std::size_t count = target.positions().size(), step = count / kMostVoters + 1;
    std::vector<Vector3> voters;
    for (std::size_t i = step / 2; i < count; i += step) voters.push_back(to_eigen(target.positions()[i]));
    ThreadTeam alone(1);
    const std::vector<Hit> hits = FaceTree(surface, alone).nearest(voters, alone);
    for (std::size_t k = 0; k < hits.size(); ++k) {
        const Point3f n = unpacked(target.normals()[step / 2 + k * step]);
        const int face = hits[k].face;
        const float above = unit_normal(surface, face).dot(Vector3(n[0], n[1], n[2]));
        if (!(std::abs(above) > kGrazing)) continue;
        OrientationVote& vote = votes[static_cast<std::size_t>(component[surface.faces[face][0]])];
        ++(above > 0 ? vote.along : vote.against);
    }
    return votes;
}

double share_turned_away(const Network& network, const Point3f& viewer) {
    double away = 0, all = 0;
    for (const Triangle& f : network.faces()) {
        const Point3f& p = network.position(f[0]);
        const Point3f area = area_vector(p, network.position(f[1]), network.position(f[2]));
        all += static_cast<double>(area.Norm());
        if (area * (viewer - p) < 0) away += static_cast<double>(area.Norm());
    }
    return away / all;
}

void orient_convex_side_outward(Network& network) {
    const PerVertex<int> component = network.components();
    const std::vector<Triangle> faces = network.faces();
    PerVertex<double> volume(component.size() + 1, 0);
    const auto add = [&](const Point3f& a, const Point3f& b, const Point3f& c, VertexId of) {
        const auto p = vcg::Point3d::Construct(a), q = vcg::Point3d::Construct(b),
                   r = vcg::Point3d::Construct(c);
        volume[component[of]] += p * (q ^ r);
    };
    for (const Triangle& f : faces)
        add(network.position(f[0]), network.position(f[1]), network.position(f[2]), f[0]);
    for (const auto& loop : boundary_loops(network.slot_count(), faces)) {
        Point3f centre(0, 0, 0);
        for (const VertexId v : loop) centre += network.position(v) / static_cast<float>(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i)
            add(centre, network.position(loop[(i + 1) % loop.size()]), network.position(loop[i]), loop[i]);
    }
    turn(network, [&](VertexId v) { return volume[component[v]] < 0; });
}

int orient_by_normals(Network& network, const TargetSpace& target) {
    const PerVertex<int> component = network.components();
    const std::vector<OrientationVote> votes = orientation_votes(network, target);
    std::vector<char> over(votes.size(), 0);
    int clear = 0;
    bool any_over = false;
    for (std::size_t i = 0; i < votes.size(); ++i) {
        if (!votes[i].open || !votes[i].is_clear()) continue;
        ++clear;
        over[i] = votes[i].against > votes[i].along ? 1 : 0;
        any_over = any_over || over[i] != 0;
    }
    if (any_over)
        turn(network, [&](VertexId v) { return over[static_cast<std::size_t>(component[v])] != 0; });
    return clear;
}

}  // namespace neuralmesh
