// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/hollows.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "vcg_core/base/ablation.h"
#include "vcg_core/start/components.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// How far one looks for a void, beyond the opposite layer, and between two looks; in lattice steps.
constexpr float kFarthest = 8, kStride = 0.5F;
/// The outside begins at this squared distance from the points: in a wall nodes are nearer.
constexpr SquaredRadius kLeastDistance = 4;
/// A space needs this share of the places to be taken for a hollow ...
constexpr double kLeastPlaces = 0.01;
/// ... and of those that tell what it is so many have to say so. Fewer do where views of a scan do not meet.
constexpr double kSure = 0.6;

constexpr int kOutside = 0;
enum class Kind { unknown, void_space, material };

/// Sealed spaces, numbered from 1, and for each the number of layers between it and others, as the places see
/// them.
class Spaces {
public:
    Spaces(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
           const PerNode<SquaredRadius>& clearance, const NodeSet& inside);
    void look_from(const LayerPlace& place);
    void decide(std::size_t places);
    bool is_hollow(NodeId i) const { return space_[i] != kOutside && kind(space_[i]) == Kind::void_space; }
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
    std::vector<Told> what_contacts_tell() const;
    Kind kind(int space) const { return kinds_[static_cast<std::size_t>(space)]; }

    const Lattice& lattice_;
    const PerNode<SquaredRadius>& distances_;
    const PerNode<SquaredRadius>& clearance_;
    PerNode<int> space_;           ///< kOutside: none
    std::vector<NodeId> deepest_;  ///< of each space but the outside
    std::vector<Kind> kinds_;
    /// Places between two spaces, by the number of layers there: one or three, or two.
    std::map<std::pair<int, int>, std::array<int, 2>> contacts_;
};

Spaces::Spaces(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
               const PerNode<SquaredRadius>& clearance, const NodeSet& inside)
    : lattice_(lattice),
      distances_(distances),
      clearance_(clearance),
      space_(lattice.size(), kOutside),
      kinds_{Kind::void_space} {
    for_each_component(lattice, inside, 1, [&](Span<const Run> space) {
        NodeId deepest = space[0].begin;
        for (const Run& run : space)
            for (NodeId i = run.begin; i < run.end; ++i) {
                space_[i] = static_cast<int>(kinds_.size());
                if (distances[i] > distances[deepest]) deepest = i;
            }
        deepest_.push_back(deepest);
        kinds_.push_back(Kind::unknown);
    });
}

/// \param wall the distance of the opposite layer in this direction; 0: there is none
std::optional<Spaces::View> Spaces::first_void(const Point3f& from, const Point3f& direction,
                                               float wall) const {
    for (float way = lattice_.step; way < wall + kFarthest * lattice_.step; way += kStride * lattice_.step) {
        const NodeId node = lattice_.node_of(from + direction * way);
        const bool through_wall = wall > 0 && way > wall;
        if (node >= lattice_.size()) return View{kOutside, through_wall};
        if (space_[node] != kOutside) return View{space_[node], through_wall};
        if (distances_[node] >= kLeastDistance && clearance_[node] == distances_[node])
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

std::vector<Spaces::Told> Spaces::what_contacts_tell() const {
    std::vector<Told> told(kinds_.size());
    const auto count = [&](int space, int other, const std::array<int, 2>& places) {
        Told& here = told[static_cast<std::size_t>(space)];
        here.all += places[0] + places[1];
        if (kind(other) == Kind::unknown) return;
        here.known += places[0] + places[1];
        here.says_void += places[kind(other) == Kind::material ? 0 : 1];
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
        const std::vector<Told> told = what_contacts_tell();
        std::size_t next = 0;
        double share = 0;
        for (std::size_t i = 1; i < kinds_.size(); ++i)
            if (kinds_[i] == Kind::unknown && told[i].known_share() > share) {
                next = i;
                share = told[i].known_share();
            }
        if (next == 0) return;
        const Told& here = told[next];
        const bool is_void =
            here.says_void >= kSure * here.known && here.known >= kLeastPlaces * static_cast<double>(places);
        kinds_[next] = is_void ? Kind::void_space : Kind::material;
    }
}

std::vector<NodeId> Spaces::deepest_of_hollows() const {
    std::vector<NodeId> result;
    for (std::size_t i = 1; i < kinds_.size(); ++i)
        if (kinds_[i] == Kind::void_space) result.push_back(deepest_[i - 1]);
    return result;
}

}  // namespace

std::vector<NodeId> take_hollows_out(const Lattice& lattice, const PerNode<SquaredRadius>& distances,
                                     const PerNode<SquaredRadius>& clearance,
                                     const std::vector<LayerPlace>& places, NodeSet& inside) {
    if (skips("hollows")) return {};
    Spaces spaces(lattice, distances, clearance, inside);
    for (const LayerPlace& place : places) spaces.look_from(place);
    spaces.decide(places.size());
    for (NodeId i = 0; i < inside.size(); ++i)
        if (spaces.is_hollow(i)) inside[i] = 0;
    return spaces.deepest_of_hollows();
}

}  // namespace neuralmesh
