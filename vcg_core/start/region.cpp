// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/cloud/isolated_groups.h"
namespace neuralmesh {
namespace {

using vcg::Point3f;

// tests/experiments/accuracy/ablation.py shows what a change of these figures does.

/// How far one looks for a void, beyond the opposite layer, in lattice steps.
constexpr float kFarthest = 8;
/// The outside begins at this squared distance from the points: in a wall nodes are nearer.
constexpr SquaredRadius kLeastDistance = 4;
/// A space needs this share of the places to be taken for a hollow ...
constexpr double kLeastPlaces = 0.01;
/// ... and of those that tell what it is so many have to say so. Fewer do where views of a scan do not meet.
constexpr double kSure = 0.6;

constexpr int kOutside = 0;
enum class Kind { unknown, void_space, material };

/// Tells the hollows of a body, whose surface is seen from within, from its material. Sealed spaces are
/// numbered from 1.
///
/// From places of the cloud one looks along the normal to both sides, up to the first void: the outside or a
/// sealed space. Between the two voids lies one layer of points, or two if the place has a layer opposite and
/// both are passed: a wall too thin for the lattice. One layer separates material from void, two void from
/// void. From the outside inward this decides what each sealed space is.
class Spaces {
public:
    /// \p inside: the nodes of all sealed spaces. \pre the clearance of \p region is that without them
    Spaces(const Region& region, const NodeSet& inside);
    void look_from(const LayerPlace& place);
    void decide(std::size_t places);
    bool is_hollow(NodeId i) const { return space_[i] != kOutside && kinds_[space_[i]] == Kind::void_space; }
    /// The node of each hollow that is farthest from the points.
    std::vector<NodeId> deepest_of_hollows() const;

private:
    struct View {
        int space;
        bool through_wall;
    };
    std::optional<View> first_void(const Point3f& from, const Point3f& direction, float wall) const;
    /// Of a space: its places of contact, those with spaces of known kind, and of these those that say that
    /// it is void.
    struct Told {
        int all = 0, known = 0, says_void = 0;
        double known_share() const { return all > 0 ? static_cast<double>(known) / all : 0; }
    };
    Indexed<Told> what_contacts_tell() const;

    const Region& region_;
    PerNode<int> space_;       ///< kOutside: none
    Indexed<Kind> kinds_;      ///< of each space
    Indexed<NodeId> deepest_;  ///< the same; nothing for the outside
    /// Places between two spaces, by the number of layers there: one or three, or two.
    std::map<std::pair<int, int>, std::array<int, 2>> contacts_;
};

Spaces::Spaces(const Region& region, const NodeSet& inside)
    : region_(region), space_(inside.size(), kOutside), kinds_{Kind::void_space}, deepest_{0} {
    const PerNode<SquaredRadius>& distances = region.distances;
    for_each_component(region.lattice, inside, 1, [&](Span<const Run> space) {
        NodeId deepest = space[0].begin;
        for (const Run& run : space)
            for (NodeId i = run.begin; i < run.end; ++i) {
                space_[i] = kinds_.size();
                if (distances[i] > distances[deepest]) deepest = i;
            }
        deepest_.push_back(deepest);
        kinds_.push_back(Kind::unknown);
    });
}

/// \param wall the distance of the opposite layer in this direction; 0: there is none
std::optional<Spaces::View> Spaces::first_void(const Point3f& from, const Point3f& direction,
                                               float wall) const {
    const float step = region_.lattice.step;
    for (float way = step; way < wall + kFarthest * step; way += Lattice::kRayStride * step) {
        const NodeId node = region_.lattice.node_of(from + direction * way);
        const bool through_wall = wall > 0 && way > wall;
        if (node >= space_.size()) return View{kOutside, through_wall};
        if (space_[node] != kOutside) return View{space_[node], through_wall};
        const SquaredRadius distance = region_.distances[node];
        if (distance >= kLeastDistance && region_.clearance[node] == distance)
            return View{kOutside, through_wall};
    }
    return {};
}

void Spaces::look_from(const LayerPlace& place) {
    const std::optional<View> up = first_void(place.position, place.normal, place.above);
    const std::optional<View> down = first_void(place.position, -place.normal, place.below);
    if (!up || !down || up->space == down->space) return;
    ++contacts_[std::minmax(up->space, down->space)][up->through_wall != down->through_wall ? 1 : 0];
}

Indexed<Spaces::Told> Spaces::what_contacts_tell() const {
    Indexed<Told> told(kinds_.size());
    const auto count = [&](int space, int other, const std::array<int, 2>& places) {
        Told& here = told[space];
        here.all += places[0] + places[1];
        if (kinds_[other] == Kind::unknown) return;
        here.known += places[0] + places[1];
        here.says_void += places[kinds_[other] == Kind::material ? 0 : 1];
    };
    for (const auto& [spaces, places] : contacts_) {
        count(spaces.first, spaces.second, places);
        count(spaces.second, spaces.first, places);
    }
    return told;
}

/// From the outside inward: next is always the space with the largest share of contacts with decided ones. A
/// wall around a hollow has as many with the outside as with the hollow.
void Spaces::decide(std::size_t places) {
    for (;;) {
        const Indexed<Told> told = what_contacts_tell();
        int next = kOutside;
        double share = 0;
        for (int i = 1; i < kinds_.size(); ++i)
            if (kinds_[i] == Kind::unknown && told[i].known_share() > share) {
                next = i;
                share = told[i].known_share();
            }
        if (next == kOutside) return;
        const Told& here = told[next];
        const bool is_void =
            here.says_void >= kSure * here.known && here.known >= kLeastPlaces * static_cast<double>(places);
        kinds_[next] = is_void ? Kind::void_space : Kind::material;
    }
}

std::vector<NodeId> Spaces::deepest_of_hollows() const {
    std::vector<NodeId> result;
    for (int i = 1; i < kinds_.size(); ++i)
        if (kinds_[i] == Kind::void_space) result.push_back(deepest_[i]);
    return result;
}

// A space is sealed if it is this much wider than its opening ...
constexpr double kWidthRatio = 1.7;
// ... or, in a cloud that encloses nothing else, this much and at least this many coarse steps deep.
constexpr double kSingleLayerWidthRatio = 1.2;
constexpr int kSingleLayerSquaredDepth = 4 * 4;
// The lattice for that: steps along the longest side. No radius is larger than half of it.
constexpr int kCoarseSteps = 40;

/// A component holds at least so many points.
constexpr long long kSpeckPoints = 20;

// A node is fringe if its density is below this share of the highest density close by ...
constexpr double kFringeShare = 0.2;
// ... where that is at least this many points in 3 x 3 x 3 nodes: fewer may differ so much by chance.
constexpr std::uint32_t kFringeMinPoints = 40;

/// For every node combine() of the values in a cube of 2 * reach + 1 nodes per side around it, axis by axis.
template <class T, class Combine>
PerNode<T> combine_boxes(const Lattice& l, const PerNode<T>& values, int reach, const Combine& combine) {
    PerNode<T> out = values;
    for (NodeId row = 0; row < l.size(); row += l.nx)
        for (int d = 1; d <= reach; ++d) {
            const T* const in = values.data() + row;
            T* const to = out.data() + row;
            for (int x = 0; x < l.nx - d; ++x) to[x] = combine(to[x], in[x + d], d);
            for (int x = d; x < l.nx; ++x) to[x] = combine(to[x], in[x - d], d);
        }
    combine_across_rows(l, reach, combine, out);
    return out;
}

/// Points in the 3 x 3 x 3 nodes around every node.
PerNode<std::uint32_t> box_sums(const Lattice& lattice, const PerNode<std::uint32_t>& counts) {
    return combine_boxes(lattice, counts, 1, [](std::uint32_t a, std::uint32_t b, int) { return a + b; });
}

/// The largest value in the 5 x 5 x 5 nodes around every node.
template <class T>
PerNode<T> box_maxima(const Lattice& lattice, const PerNode<T>& values) {
    return combine_boxes(lattice, values, 2, [](T a, T b, int) { return a < b ? b : a; });
}

/// 0 instead of the counts of fringe nodes.
PerNode<std::uint32_t> without_fringe(const Lattice& lattice, const PerNode<std::uint32_t>& counts) {
    const PerNode<std::uint32_t> sums = box_sums(lattice, counts), most = box_maxima(lattice, sums);
    PerNode<std::uint32_t> kept = counts;
    for (NodeId i = 0; i < kept.size(); ++i)
        if (most[i] >= kFringeMinPoints && sums[i] < kFringeShare * most[i] && !skips("fringe")) kept[i] = 0;
    return kept;
}

/// Adds to \p inside the nodes of \p lattice whose nearest node of \p coarse is in \p coarse_inside.
void add_refined(const Lattice& coarse, const NodeSet& coarse_inside, const Lattice& lattice,
                 NodeSet& inside) {
    // Of node (x, y, z) it is xs[x] + ys[y] + zs[z].
    const auto along = [&](int axis, int count) {
        std::vector<NodeId> nearest;
        for (int i = 0; i < count; ++i) {
            Point3f p = coarse.corner;
            p[axis] = lattice.position(i, i, i)[axis];
            nearest.push_back(coarse.node_of(p));
        }
        return nearest;
    };
    const std::vector<NodeId> xs = along(0, lattice.nx), ys = along(1, lattice.ny), zs = along(2, lattice.nz);
    for_each_node(lattice, [&](int x, int y, int z) {
        const NodeId j = xs[at(x)] + ys[at(y)] + zs[at(z)];
        if (j < coarse.size() && coarse_inside[j] != 0) inside[lattice.index(x, y, z)] = 1;
    });
}

double radius_of_opening(const SealedSpaces& sealed, const Lattice& lattice) {
    return static_cast<double>(lattice.step) * std::sqrt(static_cast<double>(sealed.widest_opening));
}

/// Adds to \p inside the spaces with openings wider than kMaxRadius, found on a coarser lattice.
void seal_wide_openings(const std::vector<Point3f>& points, const vcg::Box3f& box, Region& region,
                        NodeSet& inside) {
    const float step = longest_side(box) / static_cast<float>(kCoarseSteps);
    if (region.encloses_space || !(step > region.lattice.step) || skips("wide_lattice")) return;
    const Lattice coarse(box, step, Region::kMargin);
    const PerNode<SquaredRadius> distances =
        squared_distances(coarse, count_points(coarse, points), kCoarseSteps / 2);
    const PerNode<SquaredRadius> clearance = clearances(coarse, distances, kCoarseSteps / 2, {});
    const SealedSpaces sealed =
        enclosed_spaces(coarse, distances, clearance, kSingleLayerWidthRatio, kSingleLayerSquaredDepth);
    if (sealed.nodes == 0) return;
    add_refined(coarse, sealed.inside, region.lattice, inside);
    region.encloses_space = true;
    region.widest_opening = radius_of_opening(sealed, coarse);
}

/// Takes the hollows out of \p inside, and sets region.hollows.
void take_hollows_out(const std::vector<LayerPlace>& places, Region& region, NodeSet& inside) {
    Spaces spaces(region, inside);
    for (const LayerPlace& place : places) spaces.look_from(place);
    spaces.decide(places.size());
    for (NodeId i = 0; i < inside.size(); ++i)
        if (spaces.is_hollow(i)) inside[i] = 0;
    region.hollows = spaces.deepest_of_hollows();
}

/// Fills clearance, encloses_space, widest_opening and hollows.
void seal(const std::vector<Point3f>& points, const vcg::Box3f& box, const std::vector<LayerPlace>& places,
          Region& region) {
    region.clearance = clearances(region.lattice, region.distances, Region::kMaxRadius, {});
    SealedSpaces sealed = enclosed_spaces(region.lattice, region.distances, region.clearance, kWidthRatio, 0);
    region.encloses_space = sealed.nodes > 0;
    region.widest_opening = radius_of_opening(sealed, region.lattice);
    seal_wide_openings(points, box, region, sealed.inside);
    if (!region.encloses_space) return;
    if (!skips("hollows")) take_hollows_out(places, region, sealed.inside);
    region.clearance =
        clearances(region.lattice, region.distances, Region::kMaxRadius, sealed.inside, region.hollows);
}

long long points_of_component(long long total) {
    const long long wanted =
        std::max(kSpeckPoints, static_cast<long long>(kComponentShare * static_cast<double>(total)));
    return std::min(wanted, 1 + total / 4);  // so that a cloud of a few points has a component
}

}  // namespace

ThinParts thin_parts(const Region& region, const std::vector<LayerPlace>& places) {
    NodeSet enclosed(region.lattice.size(), 0);
    if (region.encloses_space)
        for (NodeId i = 0; i < enclosed.size(); ++i)
            enclosed[i] = region.clearance[i] == 0 && region.distances[i] > 0 ? 1 : 0;
    const NodeSet beside = box_maxima(region.lattice, enclosed);
    long long nodes = 0, of_sheet = 0;
    for (NodeId i = 0; i < beside.size(); ++i) {
        if (region.counts[i] == 0) continue;
        ++nodes;
        of_sheet += beside[i] == 0 ? 1 : 0;
    }
    ThinParts thin;
    thin.share = nodes == 0 ? 0 : static_cast<double>(of_sheet) / static_cast<double>(nodes);
    for (const LayerPlace& place : places) {
        const NodeId i = region.lattice.node_of(place.position);
        if (i < beside.size() && region.counts[i] != 0 && beside[i] == 0) thin.places.push_back(place);
    }
    return thin;
}

PerNode<std::uint32_t> count_points(const Lattice& lattice, const std::vector<Point3f>& points) {
    PerNode<std::uint32_t> counts(lattice.size(), 0);
    for (const Point3f& p : points) {
        const NodeId i = lattice.node_of(p);
        if (i < counts.size()) ++counts[i];
    }
    return counts;
}

Region examine(const std::vector<Point3f>& points, const vcg::Box3f& box, float step,
               const std::vector<LayerPlace>& places) {
    Region region;
    region.lattice = Lattice(box, step, Region::kMargin);
    region.counts = without_fringe(region.lattice, count_points(region.lattice, points));
    region.distances = squared_distances(region.lattice, region.counts, Region::kMaxRadius);
    seal(points, box, places, region);
    region.total_points = static_cast<long long>(points.size());
    region.min_points = points_of_component(region.total_points);
    return region;
}

std::vector<std::uint8_t> outliers_of(const std::vector<Point3f>& points, const Region& region,
                                      const NodeSet& solid) {
    std::vector<std::uint8_t> result;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const NodeId node = region.lattice.node_of(points[i]);
        if (node < solid.size() && (region.counts[node] == 0 || solid[node] != 0)) continue;
        result.resize(points.size(), 0);
        result[i] = 1;
    }
    return result;
}

}  // namespace neuralmesh
