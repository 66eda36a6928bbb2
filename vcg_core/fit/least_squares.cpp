// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Normal equations in 3x3 blocks along the one-rings, and conjugate gradients on them.
#include "vcg_core/fit/least_squares.h"

#include <Eigen/LU>

#include <algorithm>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/fit/points_by_face.h"

namespace neuralmesh {

namespace {

/// Weight of the tangential part of a point's residual: makes the blocks regular and slows sliding.
constexpr float kTangential = 0.03F;
/// Pull of a vertex towards the middle of its ring within the tangent plane, in points per vertex.
constexpr float kCentring = 2e-3F;
/// Pull of a vertex to where it is, in points per vertex.
constexpr float kDamping = 2e-3F;
/// A vertex lacks support if the points around it, weighted with its hat function squared, are fewer than
/// this share of what the density of the points around allows for.
constexpr float kSupport = 0.7F;
/// Pull of such a vertex towards the middle of its ring, per point missing.
constexpr float kRetreat = 8.0F;
/// An edge counts as a crease from this many times the median gap.
constexpr float kCrease = 4.0F;
constexpr int kIterations = 40;
constexpr double kTolerance = 1e-2;

constexpr std::size_t kChunk = 256;

Symmetric3 outer(const Vector3& n) {
    return {n[0] * n[0], n[0] * n[1], n[0] * n[2], n[1] * n[1], n[1] * n[2], n[2] * n[2]};
}

double dot(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i].dot(b[i]));
    return sum;
}

}  // namespace

PointToPlaneSystem::FaceSums PointToPlaneSystem::sum_over(const Surface& surface, const PointsByFace& points,
                                                          int face) {
    FaceSums sums;
    sums.force.fill(Vector3::Zero());
    const Vector3& a = surface.corner(face, 0);
    const Vector3& b = surface.corner(face, 1);
    const Vector3& c = surface.corner(face, 2);
    const Vector3 normal = area_vector(a, b, c).normalized();
    for (int i = points.first[index(face)]; i < points.first[index(face) + 1]; ++i) {
        const PointsByFace::Tie& tie = points.ties[index(i)];
        const auto& w = tie.foot.weights;
        const Vector3 e = tie.point - w[0] * a - w[1] * b - w[2] * c;
        const bool inside = w[0] > 0 && w[1] > 0 && w[2] > 0;
        const float length = e.norm();
        const Vector3 n = inside || length < 1e-9F ? normal : Vector3(e / length);
        Symmetric3 direction;
        direction.add(outer(n), 1 - kTangential);
        direction.add_identity(kTangential);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = k == 2 ? 0 : k + 1;
            sums.pair[k].add(direction, tie.influence * w[k] * w[k]);
            sums.pair[3 + k].add(direction, tie.influence * w[k] * w[next]);
            sums.force[k] += tie.influence * w[k] * e;
        }
    }
    return sums;
}

PointToPlaneSystem::PointToPlaneSystem(const Network& network, const Surface& surface,
                                       const PointsByFace& points, ThreadTeam& team)
    : network_(network) {
    const auto slots = index(network.slot_count());
    unit_ = static_cast<float>(points.ties.size()) / static_cast<float>(network.vertex_count());
    row_.resize(slots + 1, 0);
    for (std::size_t v = 0; v < slots; ++v)
        row_[v + 1] = row_[v] + network.ring(static_cast<VertexId>(v)).valence;
    block_.resize(row_.back());
    diagonal_.resize(slots);
    force_.resize(slots, Vector3::Zero());

    measure_support(surface, points);
    std::vector<FaceSums> sums(surface.faces.size());
    for_chunks(sums.size(), kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) sums[f] = sum_over(surface, points, static_cast<int>(f));
    });
    for_chunks(slots, kChunk, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            if (!network.alive(static_cast<VertexId>(v))) continue;
            gather(sums, surface, static_cast<VertexId>(v));
            regularise(surface, static_cast<VertexId>(v));
        }
    });
    make_bending_terms(surface);
}

void PointToPlaneSystem::gather(const std::vector<FaceSums>& sums, const Surface& surface, VertexId v) {
    const Ring& ring = network_.ring(v);
    for (int i = surface.first_face[index(v)]; i < surface.first_face[index(v) + 1]; ++i) {
        const auto f = index(surface.face_of[index(i)]);
        const Triangle& face = surface.faces[f];
        const std::size_t k = face[0] == v ? 0 : face[1] == v ? 1 : 2;
        const std::size_t before = k == 0 ? 2 : k - 1;
        const VertexId next = face[k == 2 ? 0 : k + 1];
        const VertexId previous = face[before];
        diagonal_[index(v)].add(sums[f].pair[k], 1);
        block_[row_[index(v)] + index(ring.find(next))].add(sums[f].pair[3 + k], 1);
        block_[row_[index(v)] + index(ring.find(previous))].add(sums[f].pair[3 + before], 1);
        force_[index(v)] += sums[f].force[k];
    }
}

/// A spike or a web is surface without points. The hat function squared looks at the tip.
void PointToPlaneSystem::measure_support(const Surface& surface, const PointsByFace& points) {
    constexpr int kSpreads = 2;
    constexpr float kPseudoPoints = 1;
    const std::size_t slots = surface.at.size();
    std::vector<float> support(slots, 0);
    std::vector<float> area(slots, 0);
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        const Triangle& face = surface.faces[f];
        const float twice = area_vector(surface, static_cast<int>(f)).norm();
        for (std::size_t k = 0; k < 3; ++k) area[index(face[k])] += twice / 12;
        for (int i = points.first[f]; i < points.first[f + 1]; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const float w = points.ties[index(i)].foot.weights[k];
                support[index(face[k])] += w * w;
            }
    }
    // The density around: both sums over some rings.
    std::vector<float> points_around = support;
    std::vector<float> area_around = area;
    spread_over_rings(network_, points_around, kSpreads);
    spread_over_rings(network_, area_around, kSpreads);
    missing_.assign(slots, 0);
    for (std::size_t v = 0; v < slots; ++v) {
        if (!(area_around[v] > 0)) continue;
        const float expected = kSupport * area[v] * points_around[v] / area_around[v];
        missing_[v] = std::max(0.0F, expected - support[v] - kPseudoPoints);
    }
}

void PointToPlaneSystem::regularise(const Surface& surface, VertexId v) {
    const Ring& ring = network_.ring(v);
    diagonal_[index(v)].add_identity(kDamping * unit_);
    if (ring.open != 0) return;
    Vector3 middle = Vector3::Zero();
    Vector3 normal = Vector3::Zero();
    for (int i = 0; i < ring.valence; ++i) {
        middle += surface.at[index(ring[i])];
        normal += (surface.at[index(ring[i])] - surface.at[index(v)])
                      .cross(surface.at[index(ring.next(i))] - surface.at[index(v)]);
    }
    normal.normalize();
    const Vector3 away = middle / static_cast<float>(ring.valence) - surface.at[index(v)];
    const float retreat = kRetreat * missing_[index(v)];
    diagonal_[index(v)].add_identity(retreat);
    force_[index(v)] += retreat * away;
    diagonal_[index(v)].add_identity(kCentring * unit_);
    diagonal_[index(v)].add(outer(normal), -kCentring * unit_);
    force_[index(v)] += kCentring * unit_ * (away - away.dot(normal) * normal);
}

void PointToPlaneSystem::make_bending_terms(const Surface& surface) {
    const auto& at = surface.at;
    std::vector<float> gaps;
    std::vector<Vector3> gap_of;
    for (VertexId a = 0; a < network_.slot_count(); ++a) {
        const Ring& ring = network_.ring(a);
        for (int i = 0; i < ring.valence; ++i) {
            const VertexId b = ring[i];
            if (b < a || (ring.open != 0 && (i == 0 || i + 1 == ring.valence))) continue;
            const VertexId c = ring.next(i);
            const VertexId d = ring.previous(i);
            const Vector3 edge = at[index(b)] - at[index(a)];
            const float squared = edge.squaredNorm();
            const Vector3 to_c = at[index(c)] - at[index(a)];
            const Vector3 to_d = at[index(d)] - at[index(a)];
            const float height_c = edge.cross(to_c).norm();
            const float height_d = edge.cross(to_d).norm();
            if (!(height_c + height_d > 0) || !(squared > 0)) continue;
            const float s = height_c / (height_c + height_d);
            // Beyond the edge the lever of its far end grows without bound.
            const float t = std::min(std::max(((1 - s) * to_c + s * to_d).dot(edge) / squared, -1.0F), 2.0F);
            gap_of.push_back((1 - s) * to_c + s * to_d - t * edge);
            gaps.push_back(gap_of.back().norm());
            bending_terms_.push_back({{a, b, c, d}, {t - 1, -t, 1 - s, s}, 1});
        }
    }
    bending_force_.assign(at.size(), Vector3::Zero());
    bending_diagonal_.assign(at.size(), 0);
    if (gaps.empty()) return;
    const float crease = std::max(kCrease * median(gaps), 1e-9F);
    for (std::size_t h = 0; h < bending_terms_.size(); ++h) {
        BendingTerm& hinge = bending_terms_[h];
        hinge.weight = unit_ / (1 + (gaps[h] / crease) * (gaps[h] / crease));
        for (std::size_t k = 0; k < 4; ++k) {
            const float c = hinge.coefficient[k];
            bending_force_[index(hinge.corner[k])] -= hinge.weight * c * gap_of[h];
            bending_diagonal_[index(hinge.corner[k])] += hinge.weight * c * c;
        }
    }
}

void PointToPlaneSystem::multiply(float lambda, const std::vector<Vector3>& u,
                                  std::vector<Vector3>& result) const {
    for (VertexId v = 0; v < network_.slot_count(); ++v) {
        const Ring& ring = network_.ring(v);
        Vector3 sum = diagonal_[index(v)] * u[index(v)];
        const Symmetric3* block = block_.data() + row_[index(v)];
        for (int i = 0; i < ring.valence; ++i) sum += block[i] * u[index(ring[i])];
        result[index(v)] = sum;
    }
    for (const BendingTerm& hinge : bending_terms_) {
        const auto& c = hinge.coefficient;
        Vector3 gap = c[0] * u[index(hinge.corner[0])] + c[1] * u[index(hinge.corner[1])] +
                      c[2] * u[index(hinge.corner[2])] + c[3] * u[index(hinge.corner[3])];
        gap *= lambda * hinge.weight;
        for (std::size_t k = 0; k < 4; ++k) result[index(hinge.corner[k])] += c[k] * gap;
    }
}

std::vector<Vector3> PointToPlaneSystem::solve(float lambda) const {
    const std::size_t n = diagonal_.size();
    std::vector<Vector3> u(n, Vector3::Zero());
    std::vector<Vector3> rest(n);
    std::vector<Symmetric3> inverse(n);
    for (std::size_t v = 0; v < n; ++v) {
        rest[v] = force_[v] + lambda * bending_force_[v];
        Symmetric3 d = diagonal_[v];
        d.add_identity(lambda * bending_diagonal_[v]);
        Eigen::Matrix3f m;
        m << d.xx, d.xy, d.xz, d.xy, d.yy, d.yz, d.xz, d.yz, d.zz;
        if (network_.alive(static_cast<VertexId>(v))) m = m.inverse().eval();
        inverse[v] = {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
    }
    std::vector<Vector3> step(n);
    std::vector<Vector3> image(n);
    std::vector<Vector3> scaled(n);
    for (std::size_t v = 0; v < n; ++v) step[v] = scaled[v] = inverse[v] * rest[v];
    double energy = dot(rest, scaled);
    const double enough = kTolerance * kTolerance * energy;
    for (int i = 0; i < kIterations && energy > enough && energy > 0; ++i) {
        multiply(lambda, step, image);
        const double curvature = dot(step, image);
        if (!(curvature > 0)) break;
        const auto alpha = static_cast<float>(energy / curvature);
        for (std::size_t v = 0; v < n; ++v) {
            u[v] += alpha * step[v];
            rest[v] -= alpha * image[v];
            scaled[v] = inverse[v] * rest[v];
        }
        const double now = dot(rest, scaled);
        const auto beta = static_cast<float>(now / energy);
        for (std::size_t v = 0; v < n; ++v) step[v] = scaled[v] + beta * step[v];
        energy = now;
    }
    return u;
}

}  // namespace neuralmesh
