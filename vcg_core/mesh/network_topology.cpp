// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Operations on the whole network: construction from faces, exchange of faces, counts, orientation,
// validation.
#include <vcg/space/box3.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/z_order.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

namespace {

/// Pairs (b, c), one per face (v, b, c) of a vertex v: neighbour c follows b around v.
using Links = std::vector<std::pair<VertexId, VertexId>>;

/// Chains the links of one vertex into its ring. \return false if they are not one cycle or one open fan
bool chain(const Links& links, Ring& ring) {
    ring = Ring{};
    if (links.empty() || links.size() > Ring::kMaxValence) return false;
    const auto follows = [&](VertexId v) {
        return std::find_if(links.begin(), links.end(), [&](const auto& l) { return l.first == v; });
    };
    const auto has_predecessor = [&](VertexId v) {
        return std::any_of(links.begin(), links.end(), [&](const auto& l) { return l.second == v; });
    };
    auto start =
        std::find_if(links.begin(), links.end(), [&](const auto& l) { return !has_predecessor(l.first); });
    const bool open = start != links.end();
    if (!open) start = links.begin();

    VertexId v = start->first;
    const std::size_t valence = links.size() + (open ? 1 : 0);
    if (valence > Ring::kMaxValence) return false;
    while (ring.valence < valence) {
        if (ring.find(v) >= 0) return false;
        ring[ring.valence++] = v;
        const auto link = follows(v);
        if (link == links.end()) break;
        v = link->second;
    }
    ring.open = open ? 1 : 0;
    ring.pad_cyclically();
    return ring.valence == valence && (open || v == ring[0]);
}

Links links_of(const Ring& ring) {
    Links links;
    for (int i = 0; i < ring.face_count(); ++i) links.emplace_back(ring[i], ring.next(i));
    return links;
}

std::string breach_at(VertexId v, const char* what) {
    return "The network is broken at vertex " + std::to_string(v) + ": " + what;
}

bool finite(const vcg::Point3f& p) { return (p - p) == vcg::Point3f(0, 0, 0); }

/// Of so many places of a component most are within another, or are not. An odd number.
constexpr std::size_t kPlaces = 9;

/// Twice the signed area of a triangle, seen along the x axis. Exact but for the last sum.
double area_along_x(const vcg::Point3d& a, const vcg::Point3d& b, const vcg::Point3d& c) {
    return (b[1] - a[1]) * (c[2] - a[2]) - (c[1] - a[1]) * (b[2] - a[2]);
}

/// Whether the line from \p p along the x axis passes the edge of \p a and \p b on its left, seen along the
/// axis. Depends on no order of the two, so that of two faces at the edge one is hit, also if it is met.
bool passes(const vcg::Point3d& p, const vcg::Point3d& a, const vcg::Point3d& b) {
    if ((a[1] > p[1]) == (b[1] > p[1])) return false;
    return (a[1] < b[1] ? area_along_x(a, b, p) : area_along_x(b, a, p)) > 0;
}

/// Whether the ray from \p p along the x axis hits the face \p a \p b \p c.
bool hits(const vcg::Point3d& p, const vcg::Point3d& a, const vcg::Point3d& b, const vcg::Point3d& c) {
    const int edges = (passes(p, a, b) ? 1 : 0) + (passes(p, b, c) ? 1 : 0) + (passes(p, c, a) ? 1 : 0);
    if (edges % 2 == 0) return false;
    const vcg::Point3d normal = (b - a) ^ (c - a);
    if (normal[0] == 0) return false;
    return (normal * (a - p)) / normal[0] > 0;
}

/// A component of the network.
struct Part {
    std::vector<VertexId> vertices;
    std::vector<Triangle> faces;
    vcg::Box3d box;
    bool is_open = false;
    double volume = 0;  ///< that the faces enclose, times 6
};

vcg::Point3d place_of(const Network& network, VertexId v) {
    return vcg::Point3d::Construct(network.position(v));
}

std::vector<Part> parts_of(const Network& network) {
    const PerVertex<int> component = network.components();
    const int count = component.empty() ? 0 : 1 + *std::max_element(component.begin(), component.end());
    std::vector<Part> parts(static_cast<std::size_t>(count));
    const auto of = [&](VertexId v) -> Part& { return parts[static_cast<std::size_t>(component[v])]; };
    for (const VertexId v : network.vertices()) {
        of(v).vertices.push_back(v);
        of(v).box.Add(place_of(network, v));
        of(v).is_open = of(v).is_open || network.ring(v).open != 0;
    }
    for (const Triangle& f : network.faces()) {
        of(f[0]).faces.push_back(f);
        of(f[0]).volume += place_of(network, f[0]) * (place_of(network, f[1]) ^ place_of(network, f[2]));
    }
    return parts;
}

/// Whether most of \p part is within the closed part \p around.
bool is_within(const Network& network, const Part& part, const Part& around) {
    std::size_t within = 0;
    for (std::size_t k = 0; k < kPlaces; ++k) {
        const vcg::Point3d p = place_of(network, part.vertices[k * part.vertices.size() / kPlaces]);
        if (!around.box.IsIn(p)) continue;
        const auto hit = std::count_if(around.faces.begin(), around.faces.end(), [&](const Triangle& f) {
            return hits(p, place_of(network, f[0]), place_of(network, f[1]), place_of(network, f[2]));
        });
        within += hit % 2 != 0 ? 1 : 0;
    }
    return within > kPlaces / 2;
}

/// Of 2^21 cells along [-1, 1].
std::uint64_t cell_of(float coordinate) {
    return static_cast<std::uint64_t>((std::clamp(coordinate, -1.0F, 0.999F) + 1) * 0x1p20F);
}

}  // namespace

Network::Network(const std::vector<vcg::Point3f>& positions, const std::vector<Triangle>& faces) {
    vertex_count_ = static_cast<int>(positions.size());
    PerVertex<Links> links(vertex_count_);
    for (const Triangle& f : faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (f[k] < 0 || f[k] >= vertex_count_)
                throw TopologyError("A face of the start mesh names a vertex that does not exist.");
            links[f[k]].emplace_back(f[(k + 1) % 3], f[(k + 2) % 3]);
        }
    }
    rings_.resize(positions.size());
    slots_.resize(positions.size() + 1, kFreeSlot);
    for (VertexId v = 0; v < vertex_count_; ++v) {
        set_position(v, positions[static_cast<std::size_t>(v)]);
        if (!chain(links[v], ring_of(v)))
            throw TopologyError(breach_at(v, "its faces form no single fan of at most 15 neighbours."));
    }
    const std::string breach = validate();
    if (!breach.empty()) throw TopologyError(breach);
}

bool Network::rings_after(const std::vector<Triangle>& gone, const std::vector<Triangle>& added,
                          ChangedRings& changed) const {
    std::map<VertexId, Links> links;
    const auto links_at = [&](VertexId v) -> Links& {
        const auto [place, is_new] = links.try_emplace(v);
        if (is_new && v >= 0 && v < slot_count()) place->second = links_of(ring(v));
        return place->second;
    };
    for (const Triangle& f : gone)
        for (std::size_t k = 0; k < 3; ++k) {
            Links& at = links_at(f[k]);
            const auto link =
                std::find(at.begin(), at.end(), Links::value_type(f[(k + 1) % 3], f[(k + 2) % 3]));
            if (link == at.end()) return false;
            at.erase(link);
        }
    for (const Triangle& f : added)
        for (std::size_t k = 0; k < 3; ++k) {
            if (f[k] < 0 || f[k] >= slot_count() || !alive(f[k])) return false;
            links_at(f[k]).emplace_back(f[(k + 1) % 3], f[(k + 2) % 3]);
        }
    for (const auto& [v, at] : links) {
        Ring after{};
        if (!at.empty() && (!chain(at, after) || after.valence < after.min_valence())) return false;
        changed.emplace_back(v, after);
    }
    return true;
}

bool Network::can_exchange_faces(const std::vector<Triangle>& gone,
                                 const std::vector<Triangle>& added) const {
    ChangedRings changed;
    return rings_after(gone, added, changed);
}

void Network::exchange_faces(const std::vector<Triangle>& gone, const std::vector<Triangle>& added) {
    ChangedRings changed;
    if (!rings_after(gone, added, changed))
        throw TopologyError(
            "This exchange of faces would break the network; ask can_exchange_faces() first.");
    free_.reserve(free_.size() + changed.size());
    for (const auto& [v, after] : changed) {
        if (after.valence == 0) {
            release(v);
            --vertex_count_;
        }
        ring_of(v) = after;
    }
}

int Network::face_count() const {
    int corners = 0;
    for (const Ring& r : rings_) corners += r.valence != 0 ? r.face_count() : 0;
    return corners / 3;
}

int Network::edge_count() const {
    int ends = 0;
    for (const Ring& r : rings_) ends += r.valence;
    return ends / 2;
}

std::vector<Triangle> Network::faces() const {
    std::vector<Triangle> result;
    result.reserve(static_cast<std::size_t>(face_count()));
    for (const VertexId v : vertices()) {
        const Ring& r = ring(v);
        for (int i = 0; i < r.face_count(); ++i)
            if (v < r[i] && v < r.next(i)) result.push_back({v, r[i], r.next(i)});
    }
    return result;
}

PerVertex<int> Network::components() const {
    DisjointSets connected(slot_count());
    for (const VertexId v : vertices())
        for (const VertexId w : ring(v)) connected.join(v, w);
    PerVertex<int> component(slot_count(), -1);
    int count = 0;
    for (const VertexId v : vertices()) {
        const VertexId first = connected.find(v);
        component[v] = first == v ? count++ : component[first];
    }
    return component;
}

int Network::component_count() const {
    const PerVertex<int> component = components();
    return component.empty() ? 0 : *std::max_element(component.begin(), component.end()) + 1;
}

void Network::orient_outward() {
    const std::vector<Part> parts = parts_of(*this);
    for (const Part& part : parts) {
        if (part.is_open) continue;
        const auto depth = std::count_if(parts.begin(), parts.end(), [&](const Part& around) {
            return &around != &part && !around.is_open && is_within(*this, part, around);
        });
        if ((depth % 2 != 0 ? -part.volume : part.volume) >= 0) continue;
        for (const VertexId v : part.vertices) {
            Ring& r = ring_of(v);
            std::reverse(r.begin(), r.end());
            r.pad_cyclically();
        }
    }
}

int Network::boundary_loop_count() const {
    PerVertex<char> seen(slot_count(), 0);
    int loops = 0;
    for (const VertexId start : vertices()) {
        if (ring(start).open == 0 || seen[start] != 0) continue;
        ++loops;
        for (VertexId v = start; seen[v] == 0; v = ring(v)[0]) seen[v] = 1;
    }
    return loops;
}

int Network::genus() const {
    return component_count() - (euler_characteristic() + boundary_loop_count()) / 2;
}

std::string Network::validate() const {
    int count = 0;
    for (const VertexId v : vertices()) {
        const Ring& r = ring(v);
        ++count;
        if (!finite(position(v))) return breach_at(v, "its position is not finite.");
        if (r.valence < r.min_valence() || r.valence > Ring::kMaxValence)
            return breach_at(v, "its valence is out of range.");
        for (int i = r.valence; i < Ring::kMaxValence; ++i)
            if (r[i] != r[i - r.valence]) return breach_at(v, "its ring is not padded cyclically.");
        for (int i = 0; i < r.valence; ++i) {
            const std::string breach = validate_edge(v, i);
            if (!breach.empty()) return breach;
        }
    }
    if (count != vertex_count_)
        return "The network is broken: it counts " + std::to_string(vertex_count_) + " vertices but holds " +
               std::to_string(count) + ".";
    if (count + static_cast<int>(free_.size()) + gaps_.count() != slot_count())
        return "The network is broken: free and used slots do not add up.";
    return {};
}

/// validate() for the edge from v to the neighbour at ring position i and the face after it.
std::string Network::validate_edge(VertexId v, int i) const {
    const Ring& r = ring(v);
    const VertexId w = r[i];
    if (w < 0 || w >= slot_count() || !alive(w) || w == v) return breach_at(v, "a neighbour does not exist.");
    if (r.find(w) != i) return breach_at(v, "a neighbour appears twice.");
    const Ring& rw = ring(w);
    const int back = rw.find(v);
    if (back < 0) return breach_at(v, "it is missing from the ring of a neighbour.");
    if (r.open != 0 && i + 1 == r.valence)
        return rw.open != 0 && back == 0 ? "" : breach_at(v, "its last boundary edge has two faces.");
    if (r.open != 0 && i == 0 && (rw.open == 0 || back + 1 != rw.valence))
        return breach_at(v, "its first boundary edge has two faces.");
    // The face (v, w, x): in the ring of w, v follows x.
    const int x = rw.find(r.next(i));
    const bool wraps = x >= 0 && rw.open != 0 && x + 1 == rw.valence;
    if (x < 0 || wraps || rw.next(x) != v)
        return breach_at(v, "a face differs between the rings of its corners.");
    return {};
}

std::vector<VertexId> morton_order(const Network& network) {
    std::vector<std::pair<std::uint64_t, VertexId>> codes;
    codes.reserve(static_cast<std::size_t>(network.vertex_count()));
    for (const VertexId v : network.vertices()) {
        const vcg::Point3f p = network.position(v);
        codes.emplace_back(z_order(cell_of(p[0]), cell_of(p[1]), cell_of(p[2])), v);
    }
    std::sort(codes.begin(), codes.end());
    std::vector<VertexId> order;
    order.reserve(codes.size());
    for (const auto& [code, v] : codes) order.push_back(v);
    return order;
}

std::vector<VertexId> interleave_free(const std::vector<VertexId>& ids, int count) {
    std::vector<VertexId> result;
    result.reserve(ids.size() + static_cast<std::size_t>(count));
    const auto size = static_cast<std::int64_t>(ids.size());
    std::int64_t i = 0;
    for (const VertexId v : ids) {
        result.push_back(v);
        if ((i + 1) * count / size > i * count / size) result.push_back(-1);
        ++i;
    }
    return result;
}

}  // namespace neuralmesh
