// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Gathering and smoothing of a winner's surroundings, in loops that vectorise.
#include "patch.h"

#include <cmath>

namespace neuralmesh {

namespace {

vcg::Point3f cross(const vcg::Point3f& a, const vcg::Point3f& b) { return a ^ b; }

}  // namespace

Patch::Patch(const Network& network, VertexId winner)
    : winner_(winner),
      valence_(network.ring(winner).valence),
      lanes_((valence_ + 3) & ~3),
      faces_(network.ring(winner).face_count()),
      ring_(network.ring(winner).neighbours.data()),
      origin_(network.position(winner)) {
    for (int i = 0; i < valence_; ++i) __builtin_prefetch(&network.ring(ring_[i]));
    for (int i = 0; i < valence_; ++i) {
        const vcg::Point3f p = network.position(ring_[i]) - origin_;
        at_.x[i + 1] = p[0];
        at_.y[i + 1] = p[1];
        at_.z[i + 1] = p[2];
    }
    close_cycle(at_);
    for (int i = 0; i < valence_; ++i) gather_surroundings(network, i);
}

void Patch::gather_surroundings(const Network& network, int i) {
    const Ring& ring = network.ring(ring_[i]);
    if (ring.open != 0) return;  // moves_ stays 0
    const int k = ring.valence;
    int j = ring.find(winner_) + 2;  // past w and r_(i-1)
    if (j >= k) j -= k;
    vcg::Point3f sum(0, 0, 0);
    vcg::Point3f area(0, 0, 0);
    // Without outer vertices r_(i-1) and r_(i+1) follow each other: the latter, as it stood, takes their part.
    vcg::Point3f first(at_.x[i + 2], at_.y[i + 2], at_.z[i + 2]);
    vcg::Point3f last = first;
    for (int m = 0; m < k - 3; ++m) {
        const vcg::Point3f o = network.position(ring[j]) - origin_;
        sum += o;
        if (m == 0) {
            first = o;
        } else {
            area += cross(last, o);
        }
        last = o;
        if (++j == k) j = 0;
    }
    const int lane = i + 1;
    outer_sum_.x[lane] = sum[0];
    outer_sum_.y[lane] = sum[1];
    outer_sum_.z[lane] = sum[2];
    outer_area_.x[lane] = area[0];
    outer_area_.y[lane] = area[1];
    outer_area_.z[lane] = area[2];
    outer_first_.x[lane] = first[0];
    outer_first_.y[lane] = first[1];
    outer_first_.z[lane] = first[2];
    outer_last_.x[lane] = last[0];
    outer_last_.y[lane] = last[1];
    outer_last_.z[lane] = last[2];
    inverse_valence_[lane] = 1 / static_cast<float>(k);
    moves_[lane] = 1;
}

void Patch::close_cycle(Vectors& v) const {
    v.x[0] = v.x[valence_];
    v.y[0] = v.y[valence_];
    v.z[0] = v.z[valence_];
    v.x[valence_ + 1] = v.x[1];
    v.y[valence_ + 1] = v.y[1];
    v.z[valence_ + 1] = v.z[1];
}

void Patch::move_winner(const vcg::Point3f& s, float alpha_w) { winner_at_ += (s - origin_ - winner_at_) * alpha_w; }

void Patch::smooth(int sweeps, float alpha_l) {
    const float wx = winner_at_[0];
    const float wy = winner_at_[1];
    const float wz = winner_at_[2];
    Vectors now;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (int i = 1; i <= lanes_; ++i) {
            const float ax = at_.x[i - 1], ay = at_.y[i - 1], az = at_.z[i - 1];  // r_(i-1)
            const float bx = at_.x[i + 1], by = at_.y[i + 1], bz = at_.z[i + 1];  // r_(i+1)
            const float fx = outer_first_.x[i] - wx, fy = outer_first_.y[i] - wy, fz = outer_first_.z[i] - wz;
            const float lx = outer_last_.x[i] - wx, ly = outer_last_.y[i] - wy, lz = outer_last_.z[i] - wz;
            // N = w x a + a x o_1 + (o_1 x o_2 + ..) + o_m x b + b x w: twice the star's area vector,
            // which does not depend on r_i itself.
            const float nx = outer_area_.x[i] + (ay * fz - az * fy) + (ly * bz - lz * by);
            const float ny = outer_area_.y[i] + (az * fx - ax * fz) + (lz * bx - lx * bz);
            const float nz = outer_area_.z[i] + (ax * fy - ay * fx) + (lx * by - ly * bx);
            const float dx = (outer_sum_.x[i] + wx + ax + bx) * inverse_valence_[i] - at_.x[i];
            const float dy = (outer_sum_.y[i] + wy + ay + by) * inverse_valence_[i] - at_.y[i];
            const float dz = (outer_sum_.z[i] + wz + az + bz) * inverse_valence_[i] - at_.z[i];
            // The tiny term keeps a star without area from dividing zero by zero.
            const float along = (dx * nx + dy * ny + dz * nz) / (nx * nx + ny * ny + nz * nz + 1e-36F);
            const float rate = alpha_l * moves_[i];
            now.x[i] = at_.x[i] + rate * (dx - along * nx);
            now.y[i] = at_.y[i] + rate * (dy - along * ny);
            now.z[i] = at_.z[i] + rate * (dz - along * nz);
        }
        close_cycle(now);
        at_ = now;
    }
}

vcg::Point3f Patch::normal() const {
    float sx[kLanes], sy[kLanes], sz[kLanes];
    for (int i = 0; i < lanes_; ++i) {
        const float ax = at_.x[i + 1] - winner_at_[0], ay = at_.y[i + 1] - winner_at_[1],
                    az = at_.z[i + 1] - winner_at_[2];
        const float bx = at_.x[i + 2] - winner_at_[0], by = at_.y[i + 2] - winner_at_[1],
                    bz = at_.z[i + 2] - winner_at_[2];
        const float nx = ay * bz - az * by;
        const float ny = az * bx - ax * bz;
        const float nz = ax * by - ay * bx;
        const float inverse = 1 / std::sqrt(nx * nx + ny * ny + nz * nz + 1e-36F);
        sx[i] = nx * inverse;
        sy[i] = ny * inverse;
        sz[i] = nz * inverse;
    }
    vcg::Point3f sum(0, 0, 0);
    for (int i = 0; i < faces_; ++i) sum += vcg::Point3f(sx[i], sy[i], sz[i]);
    const float length = sum.Norm();
    return length > 0 ? sum / length : vcg::Point3f(0, 0, 0);
}

}  // namespace neuralmesh
