// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The network as a whole: built from faces, counted, listed and checked.
#include <algorithm>

#include "vcg_core/mesh/network.h"

namespace neuralmesh {

namespace {

/// Around one vertex: to each neighbour the one that follows it, from one face each.
using Links = std::vector<std::pair<VertexId, VertexId>>;

/// Chains the links of one vertex to its ring; false if they do not form one cycle or one open fan.
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
    for (std::size_t i = 0; i < valence; ++i) {
        if (ring.find(v) >= 0) return false;
        ring.neighbours[i] = v;
        ++ring.valence;
        const auto link = follows(v);
        if (link == links.end()) break;
        v = link->second;
    }
    ring.open = open ? 1 : 0;
    ring.pad_cyclically();
    return ring.valence == valence && (open || v == ring[0]);
}

std::string at_vertex(VertexId v, const char* what) {
    return "The network is broken at vertex " + std::to_string(v) + ": " + what;
}

bool finite(const vcg::Point3f& p) { return (p - p) == vcg::Point3f(0, 0, 0); }

}  // namespace

Network::Network(const std::vector<vcg::Point3f>& positions, const std::vector<Triangle>& faces) {
    std::vector<Links> links(positions.size());
    for (const Triangle& f : faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (f[k] < 0 || static_cast<std::size_t>(f[k]) >= positions.size())
                throw TopologyError("A face of the start mesh names a vertex that does not exist.");
            links[static_cast<std::size_t>(f[k])].emplace_back(f[(k + 1) % 3], f[(k + 2) % 3]);
        }
    }
    rings_.resize(positions.size());
    slots_.resize(positions.size() + 1, VertexRecord{0, 0, 0, -1});
    vertex_count_ = static_cast<int>(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        set_position(static_cast<VertexId>(v), positions[v]);
        if (!chain(links[v], rings_[v]))
            throw TopologyError(at_vertex(static_cast<VertexId>(v),
                                          "its faces form no single fan of at most 15 neighbours."));
    }
    const std::string breach = validate();
    if (!breach.empty()) throw TopologyError(breach);
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
    for (VertexId v = 0; v < slot_count(); ++v) {
        const Ring& r = ring(v);
        for (int i = 0; r.valence != 0 && i < r.face_count(); ++i)
            if (v < r[i] && v < r.next(i)) result.push_back({v, r[i], r.next(i)});
    }
    return result;
}

std::vector<int> Network::components() const {
    std::vector<int> component(rings_.size(), -1);
    std::vector<VertexId> stack;
    int count = 0;
    for (VertexId start = 0; start < slot_count(); ++start) {
        if (!alive(start) || component[static_cast<std::size_t>(start)] >= 0) continue;
        component[static_cast<std::size_t>(start)] = count;
        stack.push_back(start);
        while (!stack.empty()) {
            const Ring& r = ring(stack.back());
            stack.pop_back();
            for (int i = 0; i < r.valence; ++i) {
                if (component[static_cast<std::size_t>(r[i])] >= 0) continue;
                component[static_cast<std::size_t>(r[i])] = count;
                stack.push_back(r[i]);
            }
        }
        ++count;
    }
    return component;
}

int Network::component_count() const {
    const std::vector<int> component = components();
    return component.empty() ? 0 : *std::max_element(component.begin(), component.end()) + 1;
}

void Network::orient_outward() {
    const std::vector<int> component = components();
    std::vector<double> volume(component.size() + 1, 0.0);
    std::vector<char> open(component.size() + 1, 0);
    for (const Triangle& f : faces()) {
        const auto p = [&](std::size_t k) { return vcg::Point3d::Construct(position(f[k])); };
        volume[static_cast<std::size_t>(component[static_cast<std::size_t>(f[0])])] += p(0) * (p(1) ^ p(2));
    }
    for (std::size_t v = 0; v < rings_.size(); ++v)
        if (rings_[v].open != 0) open[static_cast<std::size_t>(component[v])] = 1;
    for (std::size_t v = 0; v < rings_.size(); ++v) {
        Ring& r = rings_[v];
        if (r.valence == 0) continue;
        const auto c = static_cast<std::size_t>(component[v]);
        if (volume[c] >= 0 || open[c] != 0) continue;
        std::reverse(r.neighbours.begin(), r.neighbours.begin() + r.valence);
        r.pad_cyclically();
    }
}

int Network::boundary_loop_count() const {
    std::vector<char> seen(rings_.size(), 0);
    int loops = 0;
    for (VertexId start = 0; start < slot_count(); ++start) {
        if (ring(start).open == 0 || seen[static_cast<std::size_t>(start)] != 0) continue;
        ++loops;
        for (VertexId v = start; seen[static_cast<std::size_t>(v)] == 0; v = ring(v)[0])
            seen[static_cast<std::size_t>(v)] = 1;
    }
    return loops;
}

int Network::genus() const {
    return component_count() - (euler_characteristic() + boundary_loop_count()) / 2;
}

std::string Network::validate() const {
    int count = 0;
    for (VertexId v = 0; v < slot_count(); ++v) {
        const Ring& r = ring(v);
        if (r.valence == 0) continue;
        ++count;
        if (!finite(position(v))) return at_vertex(v, "its position is not finite.");
        if (r.valence < (r.open != 0 ? 2 : 3) || r.valence > Ring::kMaxValence)
            return at_vertex(v, "its valence is out of range.");
        for (int i = r.valence; i < Ring::kMaxValence; ++i)
            if (r[i] != r[i - r.valence]) return at_vertex(v, "its ring does not repeat.");
        for (int i = 0; i < r.valence; ++i) {
            const VertexId w = r[i];
            if (w < 0 || w >= slot_count() || !alive(w) || w == v)
                return at_vertex(v, "a neighbour does not exist.");
            if (r.find(w) != i) return at_vertex(v, "a neighbour appears twice.");
            const int back = ring(w).find(v);
            if (back < 0) return at_vertex(v, "a neighbour does not know it.");
            const bool last = r.open != 0 && i + 1 == r.valence;
            if (last) {
                if (ring(w).open == 0 || back != 0)
                    return at_vertex(v, "its last boundary edge has two faces.");
                continue;
            }
            if (r.open != 0 && i == 0 && (ring(w).open == 0 || back + 1 != ring(w).valence))
                return at_vertex(v, "its first boundary edge has two faces.");
            // The face (v, w, x) must be seen from w as x followed by v.
            const int x = ring(w).find(r.next(i));
            const bool wraps = x >= 0 && ring(w).open != 0 && x + 1 == ring(w).valence;
            if (x < 0 || wraps || ring(w).next(x) != v)
                return at_vertex(v, "a face is not seen alike from its corners.");
        }
    }
    if (count != vertex_count_)
        return "The network is broken: it counts " + std::to_string(vertex_count_) + " vertices but holds " +
               std::to_string(count) + ".";
    if (count + static_cast<int>(free_.size()) + gaps_.count() != slot_count())
        return "The network is broken: free and used slots do not add up.";
    return {};
}

}  // namespace neuralmesh
