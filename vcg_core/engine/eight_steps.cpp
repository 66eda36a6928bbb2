// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Gathering and smoothing of the winners' surroundings, eight at a time.
#include "vcg_core/engine/eight_steps.h"

#include <algorithm>
#include <utility>

namespace neuralmesh {

namespace {

/// Keeps a face or star without area from dividing zero by zero.
constexpr float kTiny = 1e-36F;

[[gnu::always_inline]] inline void close_cycle(EightVectors* at, int valence) {
    at[0] = at[valence];
    at[valence + 1] = at[1];
}

}  // namespace

/// The loops over the lanes, each compiled for every instruction set.
struct EightSteps::Kernels {
    static constexpr int kOuter = 4;  ///< outer vertices of a star that are gathered without a branch
    static constexpr int kPast = 2;   ///< in the ring of r_i, from w past w itself and r_(i-1)

    [[gnu::always_inline]] static inline void gather_star(EightSteps& p, const Network& network, int i);
    static void gather_whole(Star& star, const EightSteps& p, const VertexRecord* slots, const Ring& ring,
                             int lane);
    NEURALMESH_MULTIVERSIONED static void gather(EightSteps& p, const Network& network);
    NEURALMESH_MULTIVERSIONED static void move_winners(EightSteps& p, const vcg::Point3f* signals,
                                                       float alpha_w);
    NEURALMESH_MULTIVERSIONED static void smooth(EightSteps& p, int sweeps, float alpha_l);
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
    transpose(points, p.origin_);
    p.winner_at_ = EightVectors{};
    for (int i = 0; i < p.valence_; ++i) {
        for (int lane = 0; lane < kLanes; ++lane) points[lane] = load_raw(&slots[(*p.rings_[lane])[i]]);
        transpose(points, p.before_[i]);
        subtract(p.before_[i], p.origin_);
        p.at_[i + 1] = p.before_[i];
    }
    for (int i = 0; i < p.valence_; ++i) gather_star(p, network, i);
    close_cycle(p.at_, p.valence_);
}

void EightSteps::Kernels::gather_star(EightSteps& p, const Network& network, int i) {
    const VertexRecord* slots = network.slots();
    Star& star = p.stars_[i];
    Four points[kOuter][kLanes];
    EightInts counts;
    int most = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
        const Ring& ring = network.ring((*p.rings_[lane])[i]);
        // How many there are nobody can predict, so there is no branch for it: past the last the ring goes
        // on, and what is read there does not count.
        const VertexId* outer =
            ring.neighbours.data() +
            std::min(ring.find_existing(p.winners_[lane]) + kPast, Ring::kMaxValence - kOuter);
        for (int m = 0; m < kOuter; ++m) points[m][lane] = load_raw(&slots[outer[m]]);
        counts[lane] = ring.valence - 3;
        star.moves[lane] = static_cast<std::int32_t>(ring.open) - 1;
        most = std::max(most, ring.valence - 3);
    }
    star.inverse_valence = 1 / __builtin_convertvector(counts + 3, Eight);
    star.area = EightVectors{};
    // Without outer vertices r_(i-1) and r_(i+1) follow each other: the latter, as it stands, takes their
    // part.
    transpose(points[0], star.first);
    subtract(star.first, p.origin_);
    star.last = star.first;
    star.sum = star.first;
    keep_where(counts > 0, star.sum);
    for (int m = 1; m < kOuter; ++m) {
        EightVectors o;
        transpose(points[m], o);
        subtract(o, p.origin_);
        const EightInts there = counts > m;
        choose(there, o, star.last, o);  // it adds no area with itself
        add_cross(star.area, star.last, o);
        star.last = o;
        keep_where(there, o);
        add(star.sum, o);
    }
    if (most <= kOuter) return;
    for (int lane = 0; lane < kLanes; ++lane)
        if (counts[lane] > kOuter) gather_whole(star, p, slots, network.ring((*p.rings_[lane])[i]), lane);
}

/// One lane of a star with many outer vertices.
void EightSteps::Kernels::gather_whole(Star& star, const EightSteps& p, const VertexRecord* slots,
                                       const Ring& ring, int lane) {
    const vcg::Point3f origin(p.origin_.x[lane], p.origin_.y[lane], p.origin_.z[lane]);
    const int past = ring.find_existing(p.winners_[lane]) + kPast;
    const auto outer = [&](int m) { return slots[ring[(past + m) % ring.valence]].point() - origin; };
    vcg::Point3f last = outer(0);
    vcg::Point3f sum = last;
    vcg::Point3f area(0, 0, 0);
    for (int m = 1; m < ring.valence - 3; ++m) {
        const vcg::Point3f o = outer(m);
        sum += o;
        area += last ^ o;
        last = o;
    }
    const auto store = [lane](EightVectors& to, const vcg::Point3f& v) {
        to.x[lane] = v[0];
        to.y[lane] = v[1];
        to.z[lane] = v[2];
    };
    store(star.first, outer(0));
    store(star.last, last);
    store(star.sum, sum);
    store(star.area, area);
}

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::move_winners(EightSteps& p, const vcg::Point3f* signals,
                                                                 float alpha_w) {
    EightVectors s;
    for (int lane = 0; lane < kLanes; ++lane) {
        s.x[lane] = signals[lane][0];
        s.y[lane] = signals[lane][1];
        s.z[lane] = signals[lane][2];
    }
    subtract(s, p.origin_);
    subtract(s, p.winner_at_);
    p.winner_at_.x += s.x * alpha_w;
    p.winner_at_.y += s.y * alpha_w;
    p.winner_at_.z += s.z * alpha_w;
}

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::smooth(EightSteps& p, int sweeps, float alpha_l) {
    const EightVectors w = p.winner_at_;
    Eight rate[kMost];
    for (int i = 0; i < p.valence_; ++i) {
        add(p.stars_[i].sum, w);
        subtract(p.stars_[i].first, w);
        subtract(p.stars_[i].last, w);
        rate[i] = Eight{} + alpha_l;
        keep_where(p.stars_[i].moves, rate[i]);
    }
    EightVectors other[kMost + 2];
    EightVectors* from = p.at_;
    EightVectors* to = other;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (int i = 0; i < p.valence_; ++i) {
            const Star& s = p.stars_[i];
            const EightVectors& a = from[i];
            const EightVectors& v = from[i + 1];
            const EightVectors& b = from[i + 2];
            // N = w x a + a x o_1 + (o_1 x o_2 + ..) + o_m x b + b x w: twice the star's area vector, which
            // does not depend on v itself.
            const Eight nx =
                s.area.x + (a.y * s.first.z - a.z * s.first.y) + (s.last.y * b.z - s.last.z * b.y);
            const Eight ny =
                s.area.y + (a.z * s.first.x - a.x * s.first.z) + (s.last.z * b.x - s.last.x * b.z);
            const Eight nz =
                s.area.z + (a.x * s.first.y - a.y * s.first.x) + (s.last.x * b.y - s.last.y * b.x);
            const Eight lx = (s.sum.x + (a.x + b.x)) * s.inverse_valence - v.x;
            const Eight ly = (s.sum.y + (a.y + b.y)) * s.inverse_valence - v.y;
            const Eight lz = (s.sum.z + (a.z + b.z)) * s.inverse_valence - v.z;
            const Eight along = (lx * nx + ly * ny + lz * nz) / (nx * nx + ny * ny + nz * nz + kTiny);
            to[i + 1].x = v.x + rate[i] * (lx - along * nx);
            to[i + 1].y = v.y + rate[i] * (ly - along * ny);
            to[i + 1].z = v.z + rate[i] * (lz - along * nz);
        }
        close_cycle(to, p.valence_);
        std::swap(from, to);
    }
    if (from == p.at_) return;
    for (int i = 0; i < p.valence_ + 2; ++i) p.at_[i] = from[i];
}

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::normals(const EightSteps& p, EightVectors& normals) {
    const EightVectors w = p.winner_at_;
    EightVectors sum{};
    EightVectors a = p.at_[1];
    subtract(a, w);
    for (int i = 0; i < p.valence_; ++i) {
        EightVectors b = p.at_[i + 2];
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
    // Where they cancel the sum is 0 as it is.
    length += __builtin_convertvector(~some & 1, Eight);
    normals.x = sum.x / length;
    normals.y = sum.y / length;
    normals.z = sum.z / length;
}

NEURALMESH_MULTIVERSIONED void EightSteps::Kernels::displacements(const EightSteps& p, Four* const* to) {
    Four moved[kLanes];
    transpose(p.winner_at_, moved);
    for (int lane = 0; lane < kLanes; ++lane) to[lane][0] = moved[lane];
    for (int i = 0; i < p.valence_; ++i) {
        EightVectors d = p.at_[i + 1];
        subtract(d, p.before_[i]);
        transpose(d, moved);
        for (int lane = 0; lane < kLanes; ++lane) to[lane][1 + i] = moved[lane];
    }
}

void EightSteps::gather(const Network& network, const VertexId* winners, int count) {
    valence_ = network.ring(winners[0]).valence;
    for (int lane = 0; lane < kLanes; ++lane) winners_[lane] = winners[lane < count ? lane : 0];
    Kernels::gather(*this, network);
}

void EightSteps::move_winners(const vcg::Point3f* signals, float alpha_w) {
    Kernels::move_winners(*this, signals, alpha_w);
}

void EightSteps::smooth(int sweeps, float alpha_l) { Kernels::smooth(*this, sweeps, alpha_l); }

void EightSteps::normals(EightVectors& n) const { Kernels::normals(*this, n); }

void EightSteps::displacements(Four* const* to) const { Kernels::displacements(*this, to); }

}  // namespace neuralmesh
