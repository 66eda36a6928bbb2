// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Gathering and smoothing of a winner's surroundings, in loops that vectorise.
#include "patch.h"

#include <algorithm>
#include <cmath>

namespace neuralmesh {

namespace {

using Vectors = Patch::Vectors;
using Still = Patch::Still;

/// Keeps a face or star without area from dividing zero by zero.
constexpr float kTiny = 1e-36F;

[[gnu::always_inline]] inline void close_cycle(Vectors& v, int valence) {
    v.x[0] = v.x[valence];
    v.y[0] = v.y[valence];
    v.z[0] = v.z[valence];
    v.x[valence + 1] = v.x[1];
    v.y[valence + 1] = v.y[1];
    v.z[valence + 1] = v.z[1];
}

/// One sweep for ring vertices 0 .. kWidth - 1, from \p at into \p now.
template <int kWidth>
[[gnu::always_inline]] inline void sweep(const Still& still, const Vectors& at, Vectors& now) {
    for (int i = 0; i < kWidth; ++i) {
        const float ax = at.x[i], ay = at.y[i], az = at.z[i];              // r_(i-1)
        const float vx = at.x[i + 1], vy = at.y[i + 1], vz = at.z[i + 1];  // r_i
        const float bx = at.x[i + 2], by = at.y[i + 2], bz = at.z[i + 2];  // r_(i+1)
        // N = w x a + a x o_1 + (o_1 x o_2 + ..) + o_m x b + b x w: twice the star's area vector,
        // which does not depend on r_i itself.
        const float nx = still.area.x[i] + (ay * still.first.z[i] - az * still.first.y[i]) +
                         (still.last.y[i] * bz - still.last.z[i] * by);
        const float ny = still.area.y[i] + (az * still.first.x[i] - ax * still.first.z[i]) +
                         (still.last.z[i] * bx - still.last.x[i] * bz);
        const float nz = still.area.z[i] + (ax * still.first.y[i] - ay * still.first.x[i]) +
                         (still.last.x[i] * by - still.last.y[i] * bx);
        const float lx = (still.sum.x[i] + (ax + bx)) * still.inverse_valence[i] - vx;
        const float ly = (still.sum.y[i] + (ay + by)) * still.inverse_valence[i] - vy;
        const float lz = (still.sum.z[i] + (az + bz)) * still.inverse_valence[i] - vz;
        const float along = (lx * nx + ly * ny + lz * nz) / (nx * nx + ny * ny + nz * nz + kTiny);
        now.x[i + 1] = vx + still.rate[i] * (lx - along * nx);
        now.y[i + 1] = vy + still.rate[i] * (ly - along * ny);
        now.z[i + 1] = vz + still.rate[i] * (lz - along * nz);
    }
}

template <int kWidth>
[[gnu::always_inline]] inline void sweeps(const Still& still, Vectors& at, int valence, int count) {
    Vectors other;
    Vectors* from = &at;
    Vectors* to = &other;
    for (int s = 0; s < count; ++s) {
        sweep<kWidth>(still, *from, *to);
        close_cycle(*to, valence);
        std::swap(from, to);
    }
    if (from != &at) at = *from;
}

NEURALMESH_MULTIVERSIONED void sweeps_of_8(const Still& still, Vectors& at, int valence, int count) {
    sweeps<8>(still, at, valence, count);
}

NEURALMESH_MULTIVERSIONED void sweeps_of_16(const Still& still, Vectors& at, int valence, int count) {
    sweeps<16>(still, at, valence, count);
}

/// Unit normals of the faces (w, r_i, r_(i+1)).
template <int kWidth>
[[gnu::always_inline]] inline void face_normals(const Vectors& at, const vcg::Point3f& w, Vectors& normals) {
    const float wx = w[0], wy = w[1], wz = w[2];
    for (int i = 0; i < kWidth; ++i) {
        const float ax = at.x[i + 1] - wx, ay = at.y[i + 1] - wy, az = at.z[i + 1] - wz;
        const float bx = at.x[i + 2] - wx, by = at.y[i + 2] - wy, bz = at.z[i + 2] - wz;
        const float nx = ay * bz - az * by;
        const float ny = az * bx - ax * bz;
        const float nz = ax * by - ay * bx;
        const float inverse = 1 / std::sqrt(nx * nx + ny * ny + nz * nz + kTiny);
        normals.x[i] = nx * inverse;
        normals.y[i] = ny * inverse;
        normals.z[i] = nz * inverse;
    }
}

NEURALMESH_MULTIVERSIONED void face_normals_of_8(const Vectors& at, const vcg::Point3f& w, Vectors& normals) {
    face_normals<8>(at, w, normals);
}

NEURALMESH_MULTIVERSIONED void face_normals_of_16(const Vectors& at, const vcg::Point3f& w, Vectors& normals) {
    face_normals<16>(at, w, normals);
}

}  // namespace

void Patch::gather(const Network& network, VertexId winner) {
    const Ring& ring = network.ring(winner);
    const Slot* slots = network.slots();
    winner_ = winner;
    valence_ = ring.valence;
    faces_ = ring.face_count();
    ring_ = ring.neighbours.data();
    origin_ = slots[winner].point();
    winner_at_ = {0, 0, 0};
    const Four origin = load_xyz(&slots[winner]);
    for (int i = 0; i < valence_; ++i) points_[i] = load_xyz(&slots[ring[i]]) - origin;
    for (int i = 0; i < valence_; ++i) gather_star(network, i);
    for (int i = valence_; i < kLanes; ++i) moves_[i] = 0;
    for (int i = 0; i < valence_; i += 4) {
        transpose(points_ + i, at_.x + 1 + i, at_.y + 1 + i, at_.z + 1 + i);
        transpose(sums_ + i, still_.sum.x + i, still_.sum.y + i, still_.sum.z + i);
        transpose(areas_ + i, still_.area.x + i, still_.area.y + i, still_.area.z + i);
        transpose(firsts_ + i, still_.first.x + i, still_.first.y + i, still_.first.z + i);
        transpose(lasts_ + i, still_.last.x + i, still_.last.y + i, still_.last.z + i);
    }
    close_cycle(at_, valence_);
}

void Patch::gather_star(const Network& network, int i) {
    const Ring& ring = network.ring(ring_[i]);
    const Slot* slots = network.slots();
    const int k = ring.valence;
    moves_[i] = ring.open != 0 ? 0.0F : 1.0F;
    still_.inverse_valence[i] = 1 / static_cast<float>(k);
    const Four origin = load_xyz(&slots[winner_]);
    const int past = ring.position_of(winner_) + 2;  // w and r_(i-1)
    const auto outer = [&](int m) {
        const int j = past + m;
        return load_xyz(&slots[ring[j < k ? j : j - k]]) - origin;
    };
    const int count = k - 3;
    Four sum = {0, 0, 0, 0};
    Four area = {0, 0, 0, 0};
    // Without outer vertices r_(i-1) and r_(i+1) follow each other: the latter, as it stands, takes their part.
    Four first = points_[i + 1 == valence_ ? 0 : i + 1];
    Four last = first;
    if (count > 0) {
        sum = first = last = outer(0);
        // Four at the most is by far the most frequent. The last one stands in for those that are missing: it adds
        // no area with itself, and how many there are, which nobody can predict, needs no branch.
        for (int m = 1; m < 4; ++m) {
            const Four o = outer(m < count ? m : count - 1);
            sum += m < count ? o : Four{0, 0, 0, 0};
            area += cross(last, o);
            last = o;
        }
        for (int m = 4; m < count; ++m) {
            const Four o = outer(m);
            sum += o;
            area += cross(last, o);
            last = o;
        }
    }
    sums_[i] = sum;
    areas_[i] = area;
    firsts_[i] = first;
    lasts_[i] = last;
}

void Patch::move_winner(const vcg::Point3f& s, float alpha_w) { winner_at_ += (s - origin_ - winner_at_) * alpha_w; }

void Patch::smooth(int count, float alpha_l) {
    const float wx = winner_at_[0];
    const float wy = winner_at_[1];
    const float wz = winner_at_[2];
    for (int i = 0; i < kLanes; ++i) {
        still_.rate[i] = alpha_l * moves_[i];
        still_.sum.x[i] += wx;
        still_.sum.y[i] += wy;
        still_.sum.z[i] += wz;
        still_.first.x[i] -= wx;
        still_.first.y[i] -= wy;
        still_.first.z[i] -= wz;
        still_.last.x[i] -= wx;
        still_.last.y[i] -= wy;
        still_.last.z[i] -= wz;
    }
    (valence_ <= 8 ? sweeps_of_8 : sweeps_of_16)(still_, at_, valence_, count);
}

vcg::Point3f Patch::normal() {
    (valence_ <= 8 ? face_normals_of_8 : face_normals_of_16)(at_, winner_at_, unit_normals_);
    vcg::Point3f sum(0, 0, 0);
    for (int i = 0; i < faces_; ++i)
        sum += vcg::Point3f(unit_normals_.x[i], unit_normals_.y[i], unit_normals_.z[i]);
    const float length = sum.Norm();
    return length > 0 ? sum / length : vcg::Point3f(0, 0, 0);
}

}  // namespace neuralmesh
