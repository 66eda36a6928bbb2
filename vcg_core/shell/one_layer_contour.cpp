// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/one_layer_contour.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "vcg_core/mesh/ring.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

constexpr int kMargin = 3;
/// The surface reaches as far as this from the centre of a plane, in its spacings.
constexpr float kReach = 0.95F;
/// A plane holds as far as this from its centre, in its spacings, and as high above and below, in lattice
/// steps. Both are more than the surface needs, so that there is a value at all corners of the lattice cells
/// that it passes through, beyond sharp edges, too.
constexpr float kWidth = 2.2F;
constexpr float kHeight = 2.0F;
/// The largest remoteness.
constexpr float kMostRemote = 1 + kWidth * kWidth / (kReach * kReach);
/// Planes whose normals differ by more than about a right angle are those of another layer, or of the other
/// side of a crease: they are not blended.
constexpr float kLeastCosine = -0.2F;
/// ... and below this they are opposite.
constexpr float kContradiction = -0.3F;
constexpr int kNoPlane = -1;

/// The distance to a plane, and how far the place is from its centre: 0 there, kMostRemote at most.
struct Relation {
    float above;
    float remoteness;
};

/// The box of nodes around a plane; for each axis the first of them, and the way from the plane's centre to
/// each.
struct NodesNear {
    std::array<int, 3> low{};
    std::array<std::vector<float>, 3> ways;

    /// \param height how high the plane holds above and below
    void find(const Lattice& lattice, const TangentPlane& plane, float width, float height) {
        const std::array<int, 3> count{lattice.nx, lattice.ny, lattice.nz};
        for (int k = 0; k < 3; ++k) {
            const auto i = static_cast<std::size_t>(k);
            // The disc in which the plane holds is this wide along the axis.
            const float n = plane.normal[k];
            const float extent = width * std::sqrt(std::max(0.0F, 1 - n * n)) + height * std::abs(n);
            const float at = plane.centre[k] - lattice.corner[k];
            low[i] = std::max(0, static_cast<int>(std::ceil((at - extent) / lattice.step)));
            const int high =
                std::min(count[i] - 1, static_cast<int>(std::floor((at + extent) / lattice.step)));
            ways[i].clear();
            for (int node = low[i]; node <= high; ++node)
                ways[i].push_back(lattice.corner[k] + static_cast<float>(node) * lattice.step -
                                  plane.centre[k]);
        }
    }
};

/// What the planes say of every node.
struct Field {
    Lattice lattice;
    const std::vector<TangentPlane>& planes;
    PerNode<float> remoteness;
    PerNode<int> nearest;  ///< plane, by remoteness
    PerNode<float> weights;
    PerNode<float> values;
    NodesNear nodes_near;  ///< of the plane that was looked at last

    Field(const Box3f& box, const TangentPlanes& of)
        : lattice(box, of.step, kMargin),
          planes(of.planes),
          remoteness(lattice.size(), std::numeric_limits<float>::max()),
          nearest(lattice.size(), kNoPlane) {}

    const TangentPlane& plane(int i) const { return planes[static_cast<std::size_t>(i)]; }
    float height() const { return kHeight * lattice.step; }
    /// Calls visit(node, relation) for the nodes where the plane holds.
    template <class Visit>
    void for_nodes_near(const TangentPlane& plane, const Visit& visit);
    void find_nearest();
    void blend();
    float above(int i, NodeId node) const;
    bool continuous(NodeId a, NodeId b) const;
};

template <class Visit>
void Field::for_nodes_near(const TangentPlane& plane, const Visit& visit) {
    const float width = kWidth * plane.spacing, reach = kReach * plane.spacing;
    nodes_near.find(lattice, plane, width, height());
    // Copies: for all that the compiler knows, visit() could change what these are computed from.
    const float squared_width = width * width, squared_reach = reach * reach;
    const float most_above = height(), squared_height = most_above * most_above;
    const Point3f normal = plane.normal;
    const float* const ways_x = nodes_near.ways[0].data();
    const auto count_x = static_cast<int>(nodes_near.ways[0].size());
    NodeId first_row = lattice.index(nodes_near.low[0], nodes_near.low[1], nodes_near.low[2]);
    for (const float z : nodes_near.ways[2]) {
        NodeId row = first_row;
        for (const float y : nodes_near.ways[1]) {
            for (int i = 0; i < count_x; ++i) {
                const float x = ways_x[i];
                const float above = x * normal[0] + y * normal[1] + z * normal[2];
                const float aside = x * x + y * y + z * z - above * above;
                if (std::abs(above) > most_above || aside > squared_width) continue;
                visit(row + i, Relation{above, aside / squared_reach + above * above / squared_height});
            }
            row += lattice.nx;
        }
        first_row += lattice.nx * lattice.ny;
    }
}

void Field::find_nearest() {
    for (std::size_t i = 0; i < planes.size(); ++i)
        for_nodes_near(planes[i], [&](NodeId node, const Relation& relation) {
            if (relation.remoteness >= remoteness[node]) return;
            remoteness[node] = relation.remoteness;
            nearest[node] = static_cast<int>(i);
        });
}

void Field::blend() {
    values.assign(lattice.size(), 0);
    weights.assign(lattice.size(), 0);
    for (const TangentPlane& each : planes)
        for_nodes_near(each, [&](NodeId node, const Relation& relation) {
            if (each.normal * plane(nearest[node]).normal < kLeastCosine) return;
            float weight = 1 - relation.remoteness / kMostRemote;
            for (int i = 0; i < 3; ++i) weight *= weight;
            values[node] += weight * relation.above;
            weights[node] += weight;
        });
    for (NodeId i = 0; i < values.size(); ++i) {
        if (weights[i] > 0) values[i] /= weights[i];
        if (nearest[i] == kNoPlane) values[i] = 1;
        if (values[i] == 0) values[i] = 1e-6F * lattice.step;
    }
}

float Field::above(int i, NodeId node) const {
    return (lattice.position(node) - plane(i).centre) * plane(i).normal;
}

/// Whether one of the two nodes' planes also sees them on different sides, if they are. Else the sign changes
/// because the planes contradict each other, not because the surface passes between the nodes.
bool Field::continuous(NodeId a, NodeId b) const {
    if ((values[a] < 0) == (values[b] < 0)) return true;
    if (plane(nearest[a]).normal * plane(nearest[b]).normal > kContradiction) return true;
    return (above(nearest[a], b) < 0) == (values[b] < 0) || (above(nearest[b], a) < 0) == (values[a] < 0);
}

/// Drops the faces with a vertex out of reach of all planes around the one it lies on.
void trim(Contour& contour, const TangentPlanes& planes) {
    std::vector<char> within(contour.plane.size());
    for (std::size_t v = 0; v < within.size(); ++v) {
        const auto reaches = [&](int i) {
            const TangentPlane& plane = planes.planes[static_cast<std::size_t>(i)];
            const float reach = kReach * plane.spacing;
            return (contour.mesh.positions[v] - plane.centre).SquaredNorm() <= reach * reach;
        };
        const int own = contour.plane[v];
        const auto& around = planes.around[static_cast<std::size_t>(own)];
        within[v] = reaches(own) || std::any_of(around.begin(), around.end(),
                                                [&](int i) { return i >= 0 && reaches(i); })
                        ? 1
                        : 0;
    }
    std::vector<Triangle>& faces = contour.mesh.faces;
    faces.erase(std::remove_if(faces.begin(), faces.end(),
                               [&](const Triangle& f) {
                                   return std::any_of(f.begin(), f.end(), [&](VertexId v) {
                                       return within[static_cast<std::size_t>(v)] == 0;
                                   });
                               }),
                faces.end());
}

/// The corners of the faces around each vertex, by vertex.
struct Corners {
    std::vector<int> first, corner;
};

Corners corners_of(const IndexedMesh<float>& mesh) {
    Corners result;
    result.first.assign(mesh.positions.size() + 1, 0);
    for (const Triangle& f : mesh.faces)
        for (const VertexId v : f) ++result.first[static_cast<std::size_t>(v) + 1];
    for (std::size_t v = 1; v < result.first.size(); ++v) result.first[v] += result.first[v - 1];
    result.corner.resize(3 * mesh.faces.size());
    std::vector<int> next(result.first.begin(), result.first.end() - 1);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            result.corner[static_cast<std::size_t>(next[static_cast<std::size_t>(mesh.faces[f][k])]++)] =
                static_cast<int>(3 * f + k);
    return result;
}

/// The corners at one vertex, grouped by fans: faces that share edges at the vertex. Each fan begins with its
/// first corner in the order of \p corners.
std::vector<std::vector<int>> fans_of(const IndexedMesh<float>& mesh, std::vector<int> corners) {
    const auto neighbour = [&mesh](int corner, std::size_t ahead) {
        const auto c = static_cast<std::size_t>(corner);
        return mesh.faces[c / 3][(c % 3 + ahead) % 3];
    };
    const auto share_an_edge = [&neighbour](int a, int b) {
        return neighbour(a, 1) == neighbour(b, 2) || neighbour(a, 2) == neighbour(b, 1);
    };
    std::vector<std::vector<int>> fans;
    while (!corners.empty()) {
        std::vector<int> fan{corners.front()};
        corners.erase(corners.begin());
        for (std::size_t k = 0; k < fan.size(); ++k) {
            const int member = fan[k];
            const auto rest = std::stable_partition(corners.begin(), corners.end(),
                                                    [&](int other) { return !share_an_edge(member, other); });
            fan.insert(fan.end(), rest, corners.end());
            corners.erase(rest, corners.end());
        }
        fans.push_back(std::move(fan));
    }
    return fans;
}

/// Gives every fan of faces around a vertex, but for the first, a vertex of its own.
void split_pinched_vertices(Contour& contour) {
    IndexedMesh<float>& mesh = contour.mesh;
    const Corners corners = corners_of(mesh);
    for (std::size_t v = 0; v + 1 < corners.first.size(); ++v) {
        const auto begin = corners.corner.begin();
        const std::vector<std::vector<int>> fans =
            fans_of(mesh, {begin + corners.first[v], begin + corners.first[v + 1]});
        for (std::size_t fan = 1; fan < fans.size(); ++fan) {
            const auto copy = static_cast<VertexId>(mesh.positions.size());
            const Point3f position = mesh.positions[v];
            mesh.positions.push_back(position);
            contour.plane.push_back(contour.plane[v]);
            for (const int corner : fans[fan]) {
                const auto c = static_cast<std::size_t>(corner);
                mesh.faces[c / 3][c % 3] = copy;
            }
        }
    }
}

}  // namespace

Contour one_layer_contour(const Box3f& box, const TangentPlanes& planes) {
    Field field(box, planes);
    field.find_nearest();
    field.blend();
    Contour contour;
    std::vector<NodeId> nodes;
    contour.mesh = marching_tetrahedra(
        field.lattice, field.values,
        [&](const std::array<NodeId, 4>& corners) {
            for (const NodeId corner : corners)
                if (field.nearest[corner] == kNoPlane) return false;
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = i + 1; j < 4; ++j)
                    if (!field.continuous(corners[i], corners[j])) return false;
            return true;
        },
        nodes);
    for (const NodeId node : nodes) contour.plane.push_back(field.nearest[node]);
    trim(contour, planes);
    split_pinched_vertices(contour);
    return contour;
}

}  // namespace neuralmesh
