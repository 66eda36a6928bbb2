// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Gathering and smoothing of a winner's surroundings, in loops that vectorise.
#include "patch.h"

#include <algorithm>
#include <cmath>
#include <cstring>

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

template <class T>
struct Vector {
    T x, y, z;
};

/// What does not change for one ring vertex, or for as many as T has lanes. See Patch::Still.
template <class T>
struct StillOf {
    Vector<T> sum, area, first, last;
    T inverse_valence, rate;
};

/// The new place of ring vertex v between a = r_(i-1) and b = r_(i+1).
template <class T>
[[gnu::always_inline]] inline void smooth_vertex(const StillOf<T>& s, const Vector<T>& a, Vector<T>& v,
                                                 const Vector<T>& b) {
    // N = w x a + a x o_1 + (o_1 x o_2 + ..) + o_m x b + b x w: twice the star's area vector, which does not
    // depend on v itself.
    const T nx = s.area.x + (a.y * s.first.z - a.z * s.first.y) + (s.last.y * b.z - s.last.z * b.y);
    const T ny = s.area.y + (a.z * s.first.x - a.x * s.first.z) + (s.last.z * b.x - s.last.x * b.z);
    const T nz = s.area.z + (a.x * s.first.y - a.y * s.first.x) + (s.last.x * b.y - s.last.y * b.x);
    const T lx = (s.sum.x + (a.x + b.x)) * s.inverse_valence - v.x;
    const T ly = (s.sum.y + (a.y + b.y)) * s.inverse_valence - v.y;
    const T lz = (s.sum.z + (a.z + b.z)) * s.inverse_valence - v.z;
    const T along = (lx * nx + ly * ny + lz * nz) / (nx * nx + ny * ny + nz * nz + kTiny);
    v.x = v.x + s.rate * (lx - along * nx);
    v.y = v.y + s.rate * (ly - along * ny);
    v.z = v.z + s.rate * (lz - along * nz);
}

/// All sweeps for ring vertices 0 .. kWidth - 1, on any machine.
template <int kWidth>
void sweep_in_memory(const Still& still, Vectors& at, int valence, int count) {
    const auto lane = [](const Vectors& v, int i) -> Vector<float> { return {v.x[i], v.y[i], v.z[i]}; };
    Vectors other;
    Vectors* from = &at;
    Vectors* to = &other;
    for (int sweep = 0; sweep < count; ++sweep) {
        for (int i = 0; i < kWidth; ++i) {
            const StillOf<float> s{lane(still.sum, i),  lane(still.area, i),      lane(still.first, i),
                                   lane(still.last, i), still.inverse_valence[i], still.rate[i]};
            Vector<float> v = lane(*from, i + 1);
            smooth_vertex(s, lane(*from, i), v, lane(*from, i + 2));
            to->x[i + 1] = v.x;
            to->y[i + 1] = v.y;
            to->z[i + 1] = v.z;
        }
        close_cycle(*to, valence);
        std::swap(from, to);
    }
    if (from != &at) at = *from;
}

#ifdef NEURALMESH_HAS_AVX2
using Eight = float __attribute__((vector_size(32)));

[[gnu::target("avx2")]] inline void load(const Vectors& from, int lane, Vector<Eight>& to) {
    std::memcpy(&to.x, from.x + lane, sizeof to.x);
    std::memcpy(&to.y, from.y + lane, sizeof to.y);
    std::memcpy(&to.z, from.z + lane, sizeof to.z);
}

/// The same for up to 8 ring vertices that never leave the registers: a sweep waits for the one before it,
/// and the way through memory would be half of that wait.
[[gnu::target("avx2")]] void sweep_in_registers(const Still& still, Vectors& at, int valence, int count) {
    alignas(32) std::int32_t before[8];
    alignas(32) std::int32_t after[8];
    for (int i = 0; i < 8; ++i) {
        before[i] = i == 0 ? valence - 1 : i - 1;
        after[i] = i + 1 < valence ? i + 1 : 0;
    }
    const __m256i to_before = _mm256_load_si256(reinterpret_cast<const __m256i*>(before));
    const __m256i to_after = _mm256_load_si256(reinterpret_cast<const __m256i*>(after));
    StillOf<Eight> s;
    load(still.sum, 0, s.sum);
    load(still.area, 0, s.area);
    load(still.first, 0, s.first);
    load(still.last, 0, s.last);
    std::memcpy(&s.inverse_valence, still.inverse_valence, sizeof s.inverse_valence);
    std::memcpy(&s.rate, still.rate, sizeof s.rate);
    Vector<Eight> v;
    load(at, 1, v);
    for (int sweep = 0; sweep < count; ++sweep) {
        const Vector<Eight> a{_mm256_permutevar8x32_ps(v.x, to_before),
                              _mm256_permutevar8x32_ps(v.y, to_before),
                              _mm256_permutevar8x32_ps(v.z, to_before)};
        const Vector<Eight> b{_mm256_permutevar8x32_ps(v.x, to_after),
                              _mm256_permutevar8x32_ps(v.y, to_after),
                              _mm256_permutevar8x32_ps(v.z, to_after)};
        smooth_vertex(s, a, v, b);
    }
    std::memcpy(at.x + 1, &v.x, sizeof v.x);
    std::memcpy(at.y + 1, &v.y, sizeof v.y);
    std::memcpy(at.z + 1, &v.z, sizeof v.z);
    close_cycle(at, valence);
}
#endif

void sweep_ring(const Still& still, Vectors& at, int valence, int count) {
#ifdef NEURALMESH_HAS_AVX2
    static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
    if (has_avx2 && valence <= 8) return sweep_in_registers(still, at, valence, count);
#endif
    if (valence <= 8) return sweep_in_memory<8>(still, at, valence, count);
    sweep_in_memory<16>(still, at, valence, count);
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

NEURALMESH_MULTIVERSIONED void face_normals_of_16(const Vectors& at, const vcg::Point3f& w,
                                                  Vectors& normals) {
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
    // Without outer vertices r_(i-1) and r_(i+1) follow each other: the latter, as it stands, takes their
    // part.
    Four first = points_[i + 1 == valence_ ? 0 : i + 1];
    Four last = first;
    if (count > 0) {
        sum = first = last = outer(0);
        // Four at the most is by far the most frequent. The last one stands in for those that are missing: it
        // adds no area with itself, and how many there are, which nobody can predict, needs no branch.
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

void Patch::move_winner(const vcg::Point3f& s, float alpha_w) {
    winner_at_ += (s - origin_ - winner_at_) * alpha_w;
}

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
    sweep_ring(still_, at_, valence_, count);
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
