// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/shell/tangent_planes.h"

#include <vcg/space/index/kdtree/kdtree.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

#include "vcg_core/base/median.h"
#include "vcg_core/shell/region.h"

namespace neuralmesh {
namespace {

using vcg::Box3f;
using vcg::Point3f;

constexpr int kMostAround = 4 * kPlanesAround;  ///< cells that a plane may need
/// Less wide than this the cells around lie on a line, as on one scan line, and more of them are needed.
constexpr float kLeastWidth = 0.3F;
/// Planes that differ by less than this continue each other without doubt.
constexpr float kSureWeight = 0.1F;
/// The lattice gets coarser where more than half of the planes are thicker than this: noise fills it.
constexpr float kThick = 0.35F;
constexpr float kCoarser[] = {1, 1.5F, 2.25F};
/// From this many lattice steps on a spacing is that of points, not of cells, and the surface must reach
/// farther by this factor at most.
constexpr float kSparse = 1.2F, kUneven = 1.7F;
constexpr float kPi = 3.1415927F;

/// Sums over the points of a cell, relative to the cell's first point.
struct Moments {
    Point3f first;
    int count = 0;
    double sum[3] = {0, 0, 0};
    double product[6] = {0, 0, 0, 0, 0, 0};  ///< xx, xy, xz, yy, yz, zz

    void add(const Point3f& p) {
        if (count++ == 0) first = p;
        const double d[3] = {static_cast<double>(p[0] - first[0]), static_cast<double>(p[1] - first[1]),
                             static_cast<double>(p[2] - first[2])};
        for (int k = 0; k < 3; ++k) sum[k] += d[k];
        for (int i = 0, k = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j) product[k++] += d[i] * d[j];
    }
    Point3f mean() const {
        const double n = count;
        return first + Point3f(static_cast<float>(sum[0] / n), static_cast<float>(sum[1] / n),
                               static_cast<float>(sum[2] / n));
    }
    /// Of the points about their mean.
    Eigen::Matrix3d covariance() const {
        Eigen::Matrix3d c;
        for (int i = 0, k = 0; i < 3; ++i)
            for (int j = i; j < 3; ++j, ++k)
                c(i, j) = c(j, i) = product[k] / count - sum[i] * sum[j] / (double{1} * count * count);
        return c;
    }
};

/// The count that half of the points find in their cell at least.
int typical_count(const PerNode<std::uint32_t>& counts) {
    std::vector<std::uint32_t> occupied;
    std::uint64_t points = 0;
    for (const std::uint32_t c : counts) {
        points += c;
        if (c != 0) occupied.push_back(c);
    }
    std::sort(occupied.begin(), occupied.end());
    std::uint64_t below = 0;
    for (const std::uint32_t c : occupied)
        if ((below += c) * 2 >= points) return static_cast<int>(c);
    return 0;
}

float step_for(const std::vector<Point3f>& points, const Box3f& box, const TangentPlaneOptions& options) {
    const float side = longest_side(box);
    const float coarsest = side / static_cast<float>(options.min_cells_per_side);
    float step = side / static_cast<float>(options.max_cells_per_side);
    while (static_cast<double>(Lattice(box, step, 0).size()) > options.max_cells) step *= 1.05F;
    while (step < coarsest &&
           typical_count(count_points(Lattice(box, step, 0), points)) < options.points_per_cell)
        step *= 1.12F;
    return std::min(step, coarsest);
}

/// Cells get numbers in the order of their first points.
std::vector<int> numbered_cells(const std::vector<Point3f>& points, const Lattice& lattice) {
    PerNode<std::int32_t> cell_at(lattice.size(), -1);
    std::vector<int> cells;
    cells.reserve(points.size());
    std::int32_t count = 0;
    for (const Point3f& p : points) {
        const NodeId node = lattice.node_of(p);
        const bool inside = node < cell_at.size();
        if (inside && cell_at[node] < 0) cell_at[node] = count++;
        cells.push_back(inside ? cell_at[node] : -1);
    }
    return cells;
}

std::vector<Moments> moments_of_cells(const std::vector<Point3f>& points, const std::vector<int>& cell_of) {
    std::vector<Moments> cells;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (cell_of[i] < 0) continue;
        const auto cell = static_cast<std::size_t>(cell_of[i]);
        if (cell == cells.size()) cells.emplace_back();
        cells[cell].add(points[i]);
    }
    return cells;
}

/// Every cell has the same weight, however many points it holds, so that a plane is not tilted where the
/// density changes.
void fit_plane(const std::vector<Moments>& cells, const std::vector<Point3f>& means,
               const std::vector<int>& around, TangentPlane& plane) {
    const auto n = static_cast<double>(around.size());
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    const auto to_double = [](const Point3f& p) {
        return Eigen::Vector3d(static_cast<double>(p[0]), static_cast<double>(p[1]),
                               static_cast<double>(p[2]));
    };
    for (const int c : around) centre += to_double(means[static_cast<std::size_t>(c)]) / n;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const int c : around) {
        const Eigen::Vector3d d = to_double(means[static_cast<std::size_t>(c)]) - centre;
        covariance += (d * d.transpose() + cells[static_cast<std::size_t>(c)].covariance()) / n;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const Eigen::Vector3d spread = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    plane.normal =
        Point3f(static_cast<float>(normal[0]), static_cast<float>(normal[1]), static_cast<float>(normal[2]));
    plane.thickness = static_cast<float>(spread[0] / std::max(spread[1], 1e-12));
    plane.width = static_cast<float>(spread[1] / std::max(spread[2], 1e-12));
    // Half the way to the plane around: less noise, but corners stay.
    const Eigen::Vector3d own = to_double(plane.centre);
    const double above = (own - centre).dot(normal) / 2;
    plane.centre -= plane.normal * static_cast<float>(above);
}

/// The cells nearest to a place, by vcglib's tree. (Its search for a number of neighbours reads memory that
/// it has not set.)
class NearestCells {
public:
    NearestCells(const std::vector<Point3f>& means, float step)
        : means_(means),
          step_(step),
          tree_(vcg::ConstDataWrapper<Point3f>(means.data(), static_cast<int>(means.size()))) {}

    /// The nearest \p wanted cells (all, if there are fewer), nearest first, with squared distances.
    const std::vector<std::pair<float, int>>& find(const Point3f& p, std::size_t wanted) {
        wanted = std::min(wanted, means_.size());
        for (float radius = 2.2F * step_;; radius *= 1.6F) {
            indices_.clear();
            squared_.clear();
            tree_.doQueryDist(p, radius, indices_, squared_);
            if (indices_.size() >= wanted) break;
        }
        found_.clear();
        for (std::size_t k = 0; k < indices_.size(); ++k)
            found_.emplace_back(squared_[k], static_cast<int>(indices_[k]));
        std::sort(found_.begin(), found_.end());
        found_.resize(wanted);
        return found_;
    }

private:
    const std::vector<Point3f>& means_;
    float step_;
    vcg::KdTree<float> tree_;
    std::vector<unsigned> indices_;
    std::vector<float> squared_;
    std::vector<std::pair<float, int>> found_;
};

/// Fits the planes and finds the cells around each.
void fit_planes(const std::vector<Moments>& cells, TangentPlanes& result) {
    std::vector<Point3f> means;
    means.reserve(cells.size());
    for (const Moments& cell : cells) means.push_back(cell.mean());
    NearestCells nearest(means, result.step);
    std::vector<int> around;
    result.planes.resize(cells.size());
    result.around.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        TangentPlane& plane = result.planes[i];
        plane.centre = means[i];
        plane.points = cells[i].count;
        for (std::size_t wanted = kPlanesAround + 1;; wanted = 2 * wanted - 1) {
            const auto& found = nearest.find(means[i], wanted);
            around.clear();
            for (const auto& hit : found) around.push_back(hit.second);
            if (wanted == kPlanesAround + 1) {
                result.around[i].fill(-1);
                for (std::size_t k = 1; k < around.size(); ++k) result.around[i][k - 1] = around[k];
            }
            TangentPlane wider = plane;
            fit_plane(cells, means, around, wider);
            wider.spacing =
                std::max(result.step, std::sqrt(kPi * found.back().first / static_cast<float>(found.size())));
            const bool last = 2 * wanted - 1 > kMostAround + 1;
            if (wider.width < kLeastWidth && !last) {
                plane.on_curve = wanted > kPlanesAround + 1;
                continue;
            }
            wider.on_curve = plane.on_curve;
            plane = wider;
            break;
        }
    }
}

/// At the edge of the surface a plane sees half as many others in the same distance as one inside, and seems
/// to be sparse.
void smooth_spacings(TangentPlanes& result) {
    std::vector<float> smoothed;
    smoothed.reserve(result.planes.size());
    std::vector<float> values;
    for (std::size_t i = 0; i < result.planes.size(); ++i) {
        values.assign(1, result.planes[i].spacing);
        for (const int j : result.around[i])
            if (j >= 0) values.push_back(result.planes[static_cast<std::size_t>(j)].spacing);
        smoothed.push_back(median(values));
    }
    // Where a cell holds one point the planes lie less evenly than cells do.
    for (std::size_t i = 0; i < smoothed.size(); ++i)
        result.planes[i].spacing =
            smoothed[i] * std::min(kUneven, std::max(1.0F, smoothed[i] / (kSparse * result.step)));
}

/// Two planes side by side and whether their normals agree.
struct Link {
    float weight;
    int a, b;
    bool opposite;
};

/// How two planes lie to each other.
struct Relation {
    float agreement;  ///< cosine between the normal of b and what that of a becomes on the way there
    float across;     ///< squared cosine between the way and the nearer normal: 1 if b lies above a
};

/// Where a surface turns evenly from \p a to \p b, the normal of b is that of a, reflected on the plane half
/// way between them. So planes around a crease, and those on the two sides of a wall, agree where they
/// should. (Koenig and Gumhold, "Consistent Propagation of Normal Orientations in Point Clouds", 2009.)
Relation relate(const TangentPlane& a, const TangentPlane& b) {
    const Point3f way = b.centre - a.centre;
    const float squared = std::max(way.SquaredNorm(), 1e-20F);
    const float from = a.normal * way, to = b.normal * way;
    return {(a.normal - way * (2 * from / squared)) * b.normal, std::max(from * from, to * to) / squared};
}

std::vector<Link> sorted_links(const TangentPlanes& planes) {
    std::vector<Link> links;
    links.reserve(planes.planes.size() * kPlanesAround);
    for (std::size_t i = 0; i < planes.planes.size(); ++i)
        for (const int j : planes.around[i]) {
            if (j < 0) continue;
            const auto [agreement, across] =
                relate(planes.planes[i], planes.planes[static_cast<std::size_t>(j)]);
            const int a = static_cast<int>(i);
            // Ways along the surface come first, those across a wall last.
            links.push_back(
                {1 - std::abs(agreement) + across, std::min(a, j), std::max(a, j), agreement < 0});
        }
    std::sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
        return std::tie(x.weight, x.a, x.b) < std::tie(y.weight, y.a, y.b);
    });
    return links;
}

/// Union-find in which every plane knows whether its normal is opposite to that of its root.
class Orientation {
public:
    explicit Orientation(std::size_t count) : parent_(count), flipped_(count, 0) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    struct Root {
        int plane;
        bool flipped;
    };
    Root root(int i) {
        int top = i;
        char flips = 0;
        while (parent_[at(top)] != top) {
            flips = static_cast<char>(flips ^ flipped_[at(top)]);
            top = parent_[at(top)];
        }
        for (int k = i; parent_[at(k)] != k;) {  // paths become short
            const int next = parent_[at(k)];
            const char own = flipped_[at(k)];
            parent_[at(k)] = top;
            flipped_[at(k)] = flips;
            flips = static_cast<char>(flips ^ own);
            k = next;
        }
        return {top, i != top && flipped_[at(i)] != 0};
    }
    void join(const Root& a, const Root& b, bool opposite) {
        const int low = std::min(a.plane, b.plane), high = std::max(a.plane, b.plane);
        parent_[at(high)] = low;
        flipped_[at(high)] = (a.flipped != b.flipped) != opposite ? 1 : 0;
    }

private:
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    std::vector<int> parent_;
    std::vector<char> flipped_;
};

void orient(TangentPlanes& result) {
    Orientation orientation(result.planes.size());
    for (const Link& link : sorted_links(result)) {
        const Orientation::Root a = orientation.root(link.a), b = orientation.root(link.b);
        if (a.plane != b.plane) {
            orientation.join(a, b, link.opposite);
        } else if ((a.flipped != b.flipped) != link.opposite && link.weight < kSureWeight) {
            result.contradictions.push_back((result.planes[static_cast<std::size_t>(link.a)].centre +
                                             result.planes[static_cast<std::size_t>(link.b)].centre) /
                                            2);
        }
    }
    for (std::size_t i = 0; i < result.planes.size(); ++i)
        if (orientation.root(static_cast<int>(i)).flipped) result.planes[i].normal = -result.planes[i].normal;
}

float median_thickness(const std::vector<TangentPlane>& planes) {
    std::vector<float> values;
    for (const TangentPlane& plane : planes) values.push_back(plane.thickness);
    return median(std::move(values));
}

}  // namespace

TangentPlanes tangent_planes(const std::vector<Point3f>& points, const Box3f& box,
                             const TangentPlaneOptions& options) {
    TangentPlanes result;
    const float finest = step_for(points, box, options);
    for (const float coarser : kCoarser) {
        TangentPlanes candidate;
        candidate.step = finest * coarser;
        candidate.cell_of = numbered_cells(points, Lattice(box, candidate.step, 0));
        const std::vector<Moments> cells = moments_of_cells(points, candidate.cell_of);
        if (cells.size() <= kPlanesAround) break;
        fit_planes(cells, candidate);
        candidate.thickness = median_thickness(candidate.planes);
        const bool thin = candidate.thickness < kThick;
        if (result.planes.empty() || thin) result = std::move(candidate);
        if (thin) break;
    }
    if (result.planes.empty()) return result;
    smooth_spacings(result);
    orient(result);
    return result;
}

}  // namespace neuralmesh
