// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What conjugate gradients compute with: for one solution floats and vectors, for four at once vectors of
// four. Each lane has the bits of a solution alone.
#pragma once

#include <array>
#include <cstddef>

#include "vcg_core/base/simd.h"
#include "vcg_core/fit/symmetric3.h"
#include "vcg_core/mesh/ring.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh {

/// Four vectors, one per lane.
struct FourVectors {
    Four x, y, z;

    Vector3 lane(std::size_t i) const { return {x[i], y[i], z[i]}; }

    FourVectors& operator+=(const FourVectors& b) { return *this = *this + b; }
    FourVectors& operator-=(const FourVectors& b) { return *this = *this - b; }
    friend FourVectors operator+(const FourVectors& a, const FourVectors& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend FourVectors operator-(const FourVectors& a, const FourVectors& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend FourVectors operator*(const Four& s, const FourVectors& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend FourVectors operator*(float s, const FourVectors& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend FourVectors operator*(const Symmetric3& m, const FourVectors& a) {
        return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
                m.xz * a.x + m.yz * a.y + m.zz * a.z};
    }
};

/// Four matrices, one per lane.
struct FourMatrices {
    Four xx, xy, xz, yy, yz, zz;

    FourVectors operator*(const FourVectors& a) const {
        return {xx * a.x + xy * a.y + xz * a.z, xy * a.x + yy * a.y + yz * a.z,
                xz * a.x + yz * a.y + zz * a.z};
    }
};

/// One solution.
struct OneLane {
    static constexpr std::size_t kCount = 1;
    using Number = float;
    using Vector = Vector3;
    using Matrix = Symmetric3;

    static Vector vector(const Vector3& v) { return v; }
    /// The inverse of \p m with \p s added to its diagonal.
    static Matrix inverse(Symmetric3 m, float s) {
        m.add_identity(s);
        return m.inverse();
    }
    static float dot(const Vector& a, const Vector& b) { return a.dot(b); }
    static float lane(float number, std::size_t /*i*/) { return number; }
    static void set_lane(float& number, std::size_t /*i*/, float value) { number = value; }
};

/// Four solutions.
struct FourLanes {
    static constexpr std::size_t kCount = 4;
    using Number = Four;
    using Vector = FourVectors;
    using Matrix = FourMatrices;

    static Vector vector(const Vector3& v) { return {Four{} + v[0], Four{} + v[1], Four{} + v[2]}; }
    static Matrix inverse(const Symmetric3& m, const Four& s) {
        Matrix result;
        for (std::size_t i = 0; i < kCount; ++i) {
            const Symmetric3 one = OneLane::inverse(m, s[i]);
            result.xx[i] = one.xx;
            result.xy[i] = one.xy;
            result.xz[i] = one.xz;
            result.yy[i] = one.yy;
            result.yz[i] = one.yz;
            result.zz[i] = one.zz;
        }
        return result;
    }
    /// Summed as Eigen sums three products.
    static Four dot(const Vector& a, const Vector& b) { return a.x * b.x + (a.y * b.y + a.z * b.z); }
    static float lane(const Four& numbers, std::size_t i) { return numbers[i]; }
    static void set_lane(Four& numbers, std::size_t i, float value) { numbers[i] = value; }
};

/// a . b of each lane, in double precision.
template <class Lanes>
std::array<double, Lanes::kCount> dots(const PerVertex<typename Lanes::Vector>& a,
                                       const PerVertex<typename Lanes::Vector>& b) {
    std::array<double, Lanes::kCount> sums{};
    for (VertexId v = 0; v < a.size(); ++v) {
        const typename Lanes::Number product = Lanes::dot(a[v], b[v]);
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += static_cast<double>(Lanes::lane(product, i));
    }
    return sums;
}

/// How far the conjugate gradients of each lane have come, and the lengths of their steps. A lane that has
/// finished takes steps of length 0.
template <class Lanes>
class Descent {
public:
    using Sums = std::array<double, Lanes::kCount>;
    using Number = typename Lanes::Number;

    /// \p energy: residual . scaled residual, as at the start. A lane finishes once it has fallen by the
    /// square of \p tolerance.
    Descent(const Sums& energy, double tolerance) : energy_(energy) {
        for (std::size_t i = 0; i < energy.size(); ++i) {
            enough_[i] = tolerance * tolerance * energy[i];
            active_[i] = is_wanted(i);
        }
    }

    bool goes_on() const {
        for (const bool active : active_)
            if (active) return true;
        return false;
    }

    /// alpha. \p curvature: step . image of the step
    Number step_lengths(const Sums& curvature) {
        Number alpha{};
        for (std::size_t i = 0; i < curvature.size(); ++i) {
            active_[i] = active_[i] && curvature[i] > 0;
            if (active_[i]) Lanes::set_lane(alpha, i, static_cast<float>(energy_[i] / curvature[i]));
        }
        return alpha;
    }

    /// beta. \p energy: as after the step
    Number conjugation(const Sums& energy) {
        Number beta{};
        for (std::size_t i = 0; i < energy.size(); ++i) {
            if (!active_[i]) continue;
            Lanes::set_lane(beta, i, static_cast<float>(energy[i] / energy_[i]));
            energy_[i] = energy[i];
            active_[i] = is_wanted(i);
        }
        return beta;
    }

private:
    bool is_wanted(std::size_t i) const { return energy_[i] > enough_[i] && energy_[i] > 0; }

    Sums energy_;
    Sums enough_;
    std::array<bool, Lanes::kCount> active_;
};

}  // namespace neuralmesh
