// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/engine/eight_steps.h"

#include <algorithm>
#include <utility>

namespace neuralmesh {

namespace {

/// Added to squared lengths, so that a face or star without area does not divide zero by zero.
constexpr float kTiny = 1e-36F;

NEURALMESH_ALWAYS_INLINE void close_cycle(EightVectors* at, int valence) {
    at[0] = at[valence];
    at[valence + 1] = at[1];
}

vcg::Point3f point_of(const EightVectors& v, int lane) { return {v.x[lane], v.y[lane], v.z[lane]}; }

void add_to(EightVectors& v, int lane, const vcg::Point3f& d) {
    v.x[lane] += d[0];
    v.y[lane] += d[1];
    v.z[lane] += d[2];
}

}  // namespace

/// The loops over the lanes, each compiled for every instruction set.
struct EightSteps::Kernels {
    static constexpr int kSkipped = 2;  ///< entries of the ring of r_i before o_1: the winner and r_(i-1)

    /// The rings of a ring vertex in all lanes, with the places of the first of their outer vertices.
    struct OuterVertices {
        const Ring* rings[kLanes];
        int first[kLanes];
        EightInts counts;
    };

    NEURALMESH_ALWAYS_INLINE static void load_outer(const EightSteps& p, const VertexRecord* slots,
                                                    const OuterVertices& outer, int m, EightVectors& to);
    NEURALMESH_ALWAYS_INLINE static void gather_star(EightSteps& p, const Network& network, int i);
    NEURALMESH_ALWAYS_INLINE static void smooth_vertex(const Star& star, const Eight& rate,
                                                       const EightVectors* from, EightVectors& to);
    static void gather_along_boundary(EightSteps& p, const Network& network, int lane);
    static void smooth_along_boundary(EightSteps& p, float smoothing_rate);
    NEURALMESH_MULTIVERSIONED static void gather(EightSteps& p, const Network& network);
    NEURALMESH_MULTIVERSIONED static void move_winners(EightSteps& p, const vcg::Point3f* signals,
                                                       float learning_rate);
    NEURALMESH_MULTIVERSIONED static void smooth(EightSteps& p, int smoothing_steps, float smoothing_rate);
    NEURALMESH_MULTIVERSIONED static void normals(const EightSteps& p, EightVectors& normals);
    NEURALMESH_MULTIVERSIONED static void displacements(const EightSteps& p, Four* const* to);
};

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::gather(EightSteps& p, const Network& network) {
    const VertexRecord* slots = network.slots();
    Four points[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
        p.rings_[lane] = &network.ring(p.winners_[lane]);
        p.closed_[lane] = static_cast<std::int32_t>(p.rings_[lane]->open) - 1;
        points[lane] = load_raw(&slots[p.winners_[lane]]);
    }
    transpose(points, p.winner_before_);
    p.winner_now_ = EightVectors{};
    for (int i = 0; i < p.valence_; ++i) {
        for (int lane = 0; lane < kLanes; ++lane) points[lane] = load_raw(&slots[(*p.rings_[lane])[i]]);
        transpose(points, p.ring_before_[i]);
        subtract(p.ring_before_[i], p.winner_before_);
        p.ring_now_[i + 1] = p.ring_before_[i];
    }
    for (int i = 0; i < p.valence_; ++i) gather_star(p, network, i);
    p.along_boundary_count_ = 0;
    for (int lane = 0; lane < kLanes; ++lane)
        if (p.closed_[lane] == 0) gather_along_boundary(p, network, lane);
    close_cycle(p.ring_now_, p.valence_);
}

/// The winner is the last neighbour of the first of its ring, and the first one of the last.
void EightSteps::Kernels::gather_along_boundary(EightSteps& p, const Network& network, int lane) {
    const vcg::Point3f origin = network.position(p.winners_[lane]);
    const auto half_way_to = [&](VertexId v) { return (network.position(v) - origin) * 0.5F; };
    const Ring& of_first = network.ring((*p.rings_[lane])[0]);
    const Ring& of_last = network.ring((*p.rings_[lane])[p.valence_ - 1]);
    p.along_boundary_[p.along_boundary_count_++] = {lane, half_way_to(of_first[0]),
                                                    half_way_to(of_last[of_last.valence - 1])};
}

void EightSteps::Kernels::smooth_along_boundary(EightSteps& p, float smoothing_rate) {
    const float rate = rate_along_boundary(smoothing_rate);
    for (int k = 0; k < p.along_boundary_count_; ++k) {
        const auto& [lane, half_way_of_first, half_way_of_last] = p.along_boundary_[k];
        const vcg::Point3f w = point_of(p.winner_now_, lane);
        const vcg::Point3f first = point_of(p.ring_now_[1], lane);
        const vcg::Point3f last = point_of(p.ring_now_[p.valence_], lane);
        const vcg::Point3f of_winner = (first + last) * 0.5F - w;
        add_to(p.ring_now_[1], lane, (half_way_of_first + w * 0.5F - first - of_winner) * rate);
        add_to(p.ring_now_[p.valence_], lane, (half_way_of_last + w * 0.5F - last - of_winner) * rate);
    }
    close_cycle(p.ring_now_, p.valence_);
}

/// Outer vertex \p m of every lane, or the last of a lane that has fewer. Without outer vertices, r_(i+1): it
/// serves as o_1 of the area vector, not of the mean.
void EightSteps::Kernels::load_outer(const EightSteps& p, const VertexRecord* slots,
                                     const OuterVertices& outer, int m, EightVectors& to) {
    Four points[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
        const Ring& ring = *outer.rings[lane];
        const int i = outer.first[lane] + std::max(std::min(m, outer.counts[lane] - 1), 0);
        points[lane] = load_raw(&slots[ring[i < ring.valence ? i : i - ring.valence]]);
    }
    transpose(points, to);
    subtract(to, p.winner_before_);
}

void EightSteps::Kernels::gather_star(EightSteps& p, const Network& network, int i) {
    Star& star = p.stars_[i];
    OuterVertices outer;
    int most = 1;
    for (int lane = 0; lane < kLanes; ++lane) {
        const Ring& ring = network.ring((*p.rings_[lane])[i]);
        outer.rings[lane] = &ring;
        outer.first[lane] = ring.find_existing(p.winners_[lane]) + kSkipped;
        outer.counts[lane] = ring.valence - 3;
        star.inner[lane] = static_cast<std::int32_t>(ring.open) - 1;
        most = std::max(most, ring.valence - 3);
    }
    convert(outer.counts + 3, star.inverse_valence);
    star.inverse_valence = 1 / star.inverse_valence;
    star.area = EightVectors{};
    load_outer(p, network.slots(), outer, 0, star.first);
    star.last = star.first;
    star.sum = star.first;
    keep_where(outer.counts > 0, star.sum);
    for (int m = 1; m < most; ++m) {
        EightVectors o;
        load_outer(p, network.slots(), outer, m, o);
        add_cross(star.area, star.last, o);  // a repeated point adds no area
        star.last = o;
        keep_where(outer.counts > m, o);
        add(star.sum, o);
    }
}

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::move_winners(EightSteps& p, const vcg::Point3f* signals,
                                                                 float learning_rate) {
    EightVectors s;
    for (int lane = 0; lane < kLanes; ++lane) {
        s.x[lane] = signals[lane][0];
        s.y[lane] = signals[lane][1];
        s.z[lane] = signals[lane][2];
    }
    subtract(s, p.winner_before_);
    subtract(s, p.winner_now_);
    p.winner_now_.x += s.x * learning_rate;  // eq 1, as v_w + alpha_w (s - v_w)
    p.winner_now_.y += s.y * learning_rate;
    p.winner_now_.z += s.z * learning_rate;
}

/// v + rate L_t for the ring vertex v = from[1], whose neighbours in the ring are from[0] and from[2].
void EightSteps::Kernels::smooth_vertex(const Star& star, const Eight& rate, const EightVectors* from,
                                        EightVectors& to) {
    const EightVectors& a = from[0];
    const EightVectors& v = from[1];
    const EightVectors& b = from[2];
    // Twice the area vector of the star: N = w x a + a x o_1 + (o_1 x o_2 + ..) + o_m x b + b x w, where
    // w x a + a x o_1 = a x (o_1 - w), and the same at the other end.
    const Eight nx =
        star.area.x + (a.y * star.first.z - a.z * star.first.y) + (star.last.y * b.z - star.last.z * b.y);
    const Eight ny =
        star.area.y + (a.z * star.first.x - a.x * star.first.z) + (star.last.z * b.x - star.last.x * b.z);
    const Eight nz =
        star.area.z + (a.x * star.first.y - a.y * star.first.x) + (star.last.x * b.y - star.last.y * b.x);
    const Eight lx = (star.sum.x + (a.x + b.x)) * star.inverse_valence - v.x;
    const Eight ly = (star.sum.y + (a.y + b.y)) * star.inverse_valence - v.y;
    const Eight lz = (star.sum.z + (a.z + b.z)) * star.inverse_valence - v.z;
    const Eight along = (lx * nx + ly * ny + lz * nz) / (nx * nx + ny * ny + nz * nz + kTiny);
    to.x = v.x + rate * (lx - along * nx);  // section 2: v + alpha_L L_t
    to.y = v.y + rate * (ly - along * ny);
    to.z = v.z + rate * (lz - along * nz);
}

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::smooth(EightSteps& p, int smoothing_steps,
                                                           float smoothing_rate) {
    const EightVectors w = p.winner_now_;
    Eight rate[kMost];
    for (int i = 0; i < p.valence_; ++i) {
        add(p.stars_[i].sum, w);
        subtract(p.stars_[i].first, w);
        subtract(p.stars_[i].last, w);
        rate[i] = Eight{} + smoothing_rate;
        keep_where(p.stars_[i].inner, rate[i]);
    }
    EightVectors other[kMost + 2];
    EightVectors* from = p.ring_now_;
    EightVectors* to = other;
    for (int step = 0; step < smoothing_steps; ++step) {
        for (int i = 0; i < p.valence_; ++i) smooth_vertex(p.stars_[i], rate[i], from + i, to[i + 1]);
        close_cycle(to, p.valence_);
        std::swap(from, to);
    }
    if (from != p.ring_now_)
        for (int i = 0; i < p.valence_ + 2; ++i) p.ring_now_[i] = from[i];
    if (smoothing_steps > 0 && p.along_boundary_count_ > 0) smooth_along_boundary(p, smoothing_rate);
}

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::normals(const EightSteps& p, EightVectors& normals) {
    const EightVectors w = p.winner_now_;
    EightVectors sum{};
    EightVectors a = p.ring_now_[1];
    subtract(a, w);
    for (int i = 0; i < p.valence_; ++i) {
        EightVectors b = p.ring_now_[i + 2];
        subtract(b, w);
        EightVectors n{};
        add_cross(n, a, b);
        Eight length = n.x * n.x + n.y * n.y + n.z * n.z + kTiny;
        square_root(length);
        Eight inverse = 1 / length;
        if (i + 1 == p.valence_) keep_where(p.closed_, inverse);
        sum.x += n.x * inverse;
        sum.y += n.y * inverse;
        sum.z += n.z * inverse;
        a = b;
    }
    Eight length = sum.x * sum.x + sum.y * sum.y + sum.z * sum.z;
    square_root(length);
    const EightInts some = length > 0;
    // Where the normals cancel, the sum is 0 and stays 0.
    Eight one_if_zero;
    convert(~some & 1, one_if_zero);
    length += one_if_zero;
    normals.x = sum.x / length;
    normals.y = sum.y / length;
    normals.z = sum.z / length;
}

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::displacements(const EightSteps& p, Four* const* to) {
    Four moved[kLanes];
    transpose(p.winner_now_, moved);
    for (int lane = 0; lane < kLanes; ++lane) to[lane][0] = moved[lane];
    for (int i = 0; i < p.valence_; ++i) {
        EightVectors d = p.ring_now_[i + 1];
        subtract(d, p.ring_before_[i]);
        transpose(d, moved);
        for (int lane = 0; lane < kLanes; ++lane) to[lane][1 + i] = moved[lane];
    }
}

void EightSteps::gather(const Network& network, const VertexId* winners, int count) {
    valence_ = network.ring(winners[0]).valence;
    for (int lane = 0; lane < kLanes; ++lane) winners_[lane] = winners[lane < count ? lane : 0];
    Kernels::gather(*this, network);
}

void EightSteps::move_winners(const vcg::Point3f* signals, float learning_rate) {
    Kernels::move_winners(*this, signals, learning_rate);
}

void EightSteps::smooth(int smoothing_steps, float smoothing_rate) {
    Kernels::smooth(*this, smoothing_steps, smoothing_rate);
}

void EightSteps::normals(EightVectors& n) const { Kernels::normals(*this, n); }

void EightSteps::displacements(Four* const* to) const { Kernels::displacements(*this, to); }

}  // namespace neuralmesh
