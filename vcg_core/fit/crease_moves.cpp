// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/fit/crease_moves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/base/small_matrices.h"

namespace neuralmesh {

namespace {

// Lengths are in mean lengths of the edges at a vertex. Chosen by tests/experiments/paper/crease_table.py.
constexpr float kFarthest = 0.35F;  ///< from the vertex to the line
constexpr float kAlike = 0.9F;      ///< cosine above which two planes are one
constexpr float kTight = 0.03F;  ///< largest distance of the points from their planes, root mean square ...
constexpr float kNoiseShare = 1.2F;   ///< ... besides this share of the variance of the noise
constexpr float kNoisiest = 0.15F;    ///< with more noise nothing moves: planes follow it off the points
constexpr float kBetter = 0.3F;       ///< largest share of the squared error of a quadratic height field ...
constexpr float kMuchBetter = 0.04F;  ///< ... and of what noise leaves unexplained of it
constexpr int kFewestPoints = 10;     ///< of a plane
/// About as many points of the two-ring are used: with more the error is no smaller, and a fit of few
/// vertices longer (tests/experiments/accuracy/compare_accuracy.py).
constexpr int kRingPoints = 256;
constexpr int kRefinements = 4;
constexpr float kHopeless = 4;  ///< times the largest squared error, after which no refinement helps
constexpr int kVerticesAtATime = 64;

/// The two planes around one vertex after another.
class PlanesOfPoints {
public:
    /// Keeps references.
    PlanesOfPoints(const Network& network, const Surface& surface, const PointsByFace& points)
        : network_(network), surface_(surface), points_(points) {}

    /// The way from \p v to the line of its two planes; 0 if there are none, or if the line is far.
    Vector3 way_to_crease(VertexId v, float noise_variance) {
        collect_faces(surface_, network_.ring(v), faces_);
        if (!choose_seeds()) return Vector3::Zero();
        const float edge = mean_edge_length_at(surface_.positions, network_.ring(v), v);
        if (!(noise_variance < kNoisiest * kNoisiest * edge * edge)) return Vector3::Zero();
        collect_points(surface_.positions[v], edge);
        const float noise = kNoiseShare * noise_variance;
        for (int i = 0; i < kRefinements; ++i)
            if (!refine() || error_ > kHopeless * largest_error(edge, noise)) return Vector3::Zero();
        if (!are_better_than_smooth(edge, noise)) return Vector3::Zero();
        const Vector3 way = way_to_line();
        return way.norm() < kFarthest * edge ? way : Vector3::Zero();
    }

private:
    /// A face, with twice its area.
    struct Side {
        Vector3 normal;
        float area;
        int face;
    };
    /// A point relative to the vertex.
    struct Sample {
        Vector3 place;
        float weight;
    };
    struct Plane {
        Vector3 normal, point;
    };

    /// Two large faces that differ much. False if all are alike.
    bool choose_seeds() {
        sides_.clear();
        for (const int f : faces_) {
            const Vector3 along = area_vector(surface_, f);
            const float area = along.norm();
            if (area > 0) sides_.push_back({along / area, area, f});
        }
        float best = 0;
        for (std::size_t i = 1; i < sides_.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const float cosine = sides_[i].normal.dot(sides_[j].normal);
                if (cosine > kAlike) continue;
                const float difference = sides_[i].area * sides_[j].area * (1 - cosine) * (1 - cosine);
                if (difference <= best) continue;
                best = difference;
                planes_ = {plane_of(sides_[i]), plane_of(sides_[j])};
            }
        return best > 0;
    }

    Plane plane_of(const Side& side) const { return {side.normal, surface_.corner(side.face, 0)}; }

    /// A point as far as \p reach has a quarter of the weight.
    void collect_points(const Vector3& vertex, float reach) {
        samples_.clear();
        reach_ = static_cast<double>(reach);
        int count = 0;
        for (const int f : faces_) count += points_.of(f).size();
        const int step = std::max(1, count / kRingPoints);
        int next = 0;
        for (const int f : faces_) {
            const Span<const PointsByFace::Assignment> of_face = points_.of(f);
            for (; next < of_face.size(); next += step) {
                const Vector3 place = of_face[next].point - vertex;
                const float x = 1 + place.squaredNorm() / (reach * reach);
                samples_.push_back({place, of_face[next].influence / (x * x)});
            }
            next -= of_face.size();
        }
        for (Plane& plane : planes_) plane.point -= vertex;
    }

    float height(const Sample& s, std::size_t k) const {
        return planes_[k].normal.dot(s.place - planes_[k].point);
    }
    std::size_t nearer_plane(const Sample& s) const {
        return std::abs(height(s, 0)) <= std::abs(height(s, 1)) ? 0 : 1;
    }

    /// Fits each plane to the points that are nearer to it. False if one has few points, or both are alike.
    bool refine() {
        struct Sums {
            Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
            Eigen::Vector3d places = Eigen::Vector3d::Zero();
            double weight = 0;
            int count = 0;
        };
        std::array<Sums, 2> sums;
        double error = 0;
        for (const Sample& s : samples_) {
            Sums& of_plane = sums[nearer_plane(s)];
            const Eigen::Vector3d p = s.place.cast<double>();
            const auto w = static_cast<double>(s.weight);
            const Eigen::Vector3d wp = w * p;
            for (int j = 0; j < 3; ++j)  // the solver reads the lower triangle only
                for (int i = j; i < 3; ++i) of_plane.squares(i, j) += wp[i] * p[j];
            of_plane.places += wp;
            of_plane.weight += w;
            ++of_plane.count;
        }
        for (std::size_t k = 0; k < 2; ++k) {
            const Sums& s = sums[k];
            if (s.count < kFewestPoints || !(s.weight > 0)) return false;
            const Eigen::Vector3d mean = s.places / s.weight;
            const Eigen::Matrix3d scatter = s.squares - s.weight * mean * mean.transpose();
            const PrincipalAxes spread = principal_axes(scatter);
            const Vector3 normal = spread.axes.col(0).cast<float>();
            error += spread.values[0];
            planes_[k] = {normal.dot(planes_[k].normal) < 0 ? Vector3(-normal) : normal, mean.cast<float>()};
        }
        error_ = static_cast<float>(error / (sums[0].weight + sums[1].weight));
        return planes_[0].normal.dot(planes_[1].normal) < kAlike;
    }

    /// Of the points from the two planes of a crease, squared.
    static float largest_error(float edge, float noise) { return kTight * kTight * edge * edge + noise; }

    /// Mean squared distance of the points from the nearer plane.
    float squared_error() const {
        double sum = 0;
        double weight = 0;
        for (const Sample& s : samples_) {
            const float h = height(s, nearer_plane(s));
            sum += static_cast<double>(s.weight * h * h);
            weight += static_cast<double>(s.weight);
        }
        return static_cast<float>(sum / weight);
    }

    /// Whether the points lie on the planes, and not on a smooth surface. \p noise: the squared error that
    /// noise explains.
    bool are_better_than_smooth(float edge, float noise) const {
        const float error = squared_error();
        if (!(error < largest_error(edge, noise))) return false;
        const float smooth = squared_error_if_smooth();
        return smooth > noise && error < kBetter * smooth && error - noise < kMuchBetter * (smooth - noise);
    }

    /// The same from the best quadratic height field over the plane between the two planes.
    float squared_error_if_smooth() const {
        const Eigen::Vector3d up = (planes_[0].normal + planes_[1].normal).cast<double>().normalized();
        const Eigen::Vector3d x = up.unitOrthogonal();
        const Eigen::Vector3d y = up.cross(x);
        Matrix6d squares = Matrix6d::Zero();
        Vector6d right = Vector6d::Zero();
        double sum = 0;
        double weight = 0;
        for (const Sample& s : samples_) {
            const Eigen::Vector3d p = s.place.cast<double>() / reach_;
            const double u = x.dot(p);
            const double v = y.dot(p);
            const double h = up.dot(p);
            const auto w = static_cast<double>(s.weight);
            Vector6d row;
            row << 1, u, v, u * u, u * v, v * v;
            squares += w * row * row.transpose();
            right += w * h * row;
            sum += w * h * h;
            weight += w;
        }
        const double left = std::max(0.0, sum - right.dot(solve(squares, right)));
        return static_cast<float>(left / weight * reach_ * reach_);
    }

    /// From the vertex, the origin, to the nearest point of the line of both planes.
    Vector3 way_to_line() const {
        const auto& [a, b] = planes_;
        const float height_a = a.normal.dot(a.point);
        const float height_b = b.normal.dot(b.point);
        const float cosine = a.normal.dot(b.normal);
        const float squared_sine = std::max(1 - cosine * cosine, 1 - kAlike * kAlike);
        return ((height_a - cosine * height_b) * a.normal + (height_b - cosine * height_a) * b.normal) /
               squared_sine;
    }

    const Network& network_;
    const Surface& surface_;
    const PointsByFace& points_;
    std::vector<int> faces_;   ///< of the two-ring
    std::vector<Side> sides_;  ///< theirs
    std::vector<Sample> samples_;
    double reach_ = 0;
    std::array<Plane, 2> planes_;
    float error_ = 0;  ///< mean squared distance of the points from the planes last fitted to them
};

/// There, points beyond the boundary belong to the faces, too.
bool is_near_boundary(const Network& network, VertexId v) {
    const Ring& ring = network.ring(v);
    return ring.open != 0 ||
           std::any_of(ring.begin(), ring.end(), [&](VertexId u) { return network.ring(u).open != 0; });
}

}  // namespace

PerVertex<Vector3> moves_to_creases(const Network& network, const Surface& surface,
                                    const PointsByFace& points, const PerVertex<float>& variances,
                                    ThreadTeam& team) {
    PerVertex<Vector3> moves(network.slot_count(), Vector3::Zero());
    const auto slots = static_cast<std::size_t>(network.slot_count());
    for_chunks(slots, kVerticesAtATime, team, [&](std::size_t, std::size_t begin, std::size_t end) {
        PlanesOfPoints planes(network, surface, points);
        for (auto v = static_cast<VertexId>(begin); v < static_cast<VertexId>(end); ++v)
            if (network.alive(v) && !is_near_boundary(network, v))
                moves[v] = planes.way_to_crease(v, variances[v]);
    });
    return moves;
}

}  // namespace neuralmesh
