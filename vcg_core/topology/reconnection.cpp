// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/reconnection.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "vcg_core/base/parallel_for.h"
#include "vcg_core/mesh/face_tree.h"
#include "vcg_core/topology/corridors.h"
#include "vcg_core/topology/membrane_groups.h"
#include "vcg_core/topology/necks.h"
#include "vcg_core/topology/rim_parts.h"
#include "vcg_core/topology/surroundings.h"

namespace neuralmesh {
namespace {

/// Membranes with more rims have too many reconnections to try: one or two membranes, and three or more.
constexpr std::size_t kMostRims = 4, kMostOfGroup = 5;
/// Rings by which membranes are widened.
constexpr std::size_t kWidest = 2;
/// A reconnection that loses more signals than this as the membranes are gains none with wider ones.
constexpr float kHopeless = -60;
/// A reconnection gains enough if it explains this share of what the membranes lack, and this many signals.
/// The way back would have to gain as much, so nothing oscillates while the vertices stay. Chosen by the bolt
/// holes of turbine: joints there gain 10 signals and more, joints elsewhere lose 40 and more.
constexpr float kLeastShare = 0.4F, kLeastGain = 8;

/// A handle is formed if the widest empty places of its membranes have at least this radius in the mean, in
/// spacings of the points. Two parts whose gap is narrower there may well be nearer to each other beside it,
/// where the points show no gap: then the handle would go around a bridge. Homer's legs are 1.6 to 2.3
/// spacings from the middle of the gap with 20,000 points, the holes of feline and turbine have radii of 2.5
/// and more.
constexpr float kLeastRadius = 2.4F;

/// A membrane, and the same one and more rings wider.
using Wide = std::vector<Membrane>;

/// Several threads may search at the same time.
class Search {
public:
    Search(const Network& network, const Surface& surface, const FaceSignals& support,
           const std::vector<vcg::Point3f>& points, ThreadTeam& team)
        : network_(network),
          surface_(surface),
          tree_(surface, team),
          support_(support),
          points_(points),
          edge_(mean_edge_length(surface)) {}

    Wide widened(const Membrane& membrane) const;
    /// The best reconnection of a membrane, if it gains enough; else one without faces.
    Reconnection of_one(const Wide& membrane) const;
    /// The same of two membranes, joined.
    Reconnection of_pair(const Wide& a, const Wide& b) const;
    /// The same of two membranes as one: the sides of a web, and the faces between them along its free edge.
    Reconnection of_web(const Wide& a, const Wide& b) const;
    /// The same of three and more.
    Reconnection of_group(const std::vector<const Wide*>& group) const;
    bool may_join(const Membrane& a, const Membrane& b) const;
    float edge() const { return edge_; }

private:
    Reconnection best(const std::vector<const Membrane*>& membranes) const;
    /// Makes a membrane of \p faces. \return false if it cannot be completed.
    bool make(Membrane& membrane, std::vector<int> faces) const;
    bool widen(Membrane& membrane) const;
    const Corridors& corridors() const;
    /// Whether the points know a handle, or one component, where the rims of the same part are joined.
    bool knows_handle(const std::vector<const Membrane*>& membranes, const std::vector<Rim>& rims,
                      const RimParts& parts, const PerFace<char>& out) const;

    const Network& network_;
    const Surface& surface_;
    FaceTree tree_;
    const FaceSignals& support_;
    const std::vector<vcg::Point3f>& points_;
    float edge_;
    mutable std::mutex mutex_;  // std::call_once() needs a newer C library than hosts of 2022 bring
    mutable std::unique_ptr<const Corridors> corridors_;  ///< made when they are first asked for
};

const Corridors& Search::corridors() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!corridors_) corridors_ = std::make_unique<const Corridors>(surface_, support_, points_, edge_);
    return *corridors_;
}

bool Search::knows_handle(const std::vector<const Membrane*>& membranes, const std::vector<Rim>& rims,
                          const RimParts& parts, const PerFace<char>& out) const {
    const Corridors& corridors = this->corridors();
    float width = 0;
    for (const Membrane* membrane : membranes) width += corridors.widest(membrane->faces);
    if (width < kLeastRadius * static_cast<float>(membranes.size())) return false;
    for (const std::vector<std::size_t>& part : parts)
        for (std::size_t i = 0; i < part.size(); ++i)
            for (std::size_t k = i + 1; k < part.size(); ++k)
                if (corridors.lead(rims[part[i]], rims[part[k]], out)) return false;
    return true;
}

/// Of the membranes together; one that joins them, if they are several. Its gain is the lowest number if
/// there is none.
Reconnection Search::best(const std::vector<const Membrane*>& membranes) const {
    Reconnection found;
    found.gain = std::numeric_limits<float>::lowest();
    std::vector<int> faces;
    std::vector<Rim> rims;
    std::vector<std::size_t> membrane_of;
    for (std::size_t m = 0; m < membranes.size(); ++m) {
        faces.insert(faces.end(), membranes[m]->faces.begin(), membranes[m]->faces.end());
        rims.insert(rims.end(), membranes[m]->rims.begin(), membranes[m]->rims.end());
        membrane_of.resize(rims.size(), m);
    }
    if (rims.size() > (membranes.size() > 2 ? kMostOfGroup : kMostRims)) return found;
    PerFace<char> out(surface_.face_count(), 0);
    for (const int f : faces) {
        if (out[f]++ != 0) return found;  // the membranes overlap
        found.gone.push_back(surface_.faces[f]);
    }
    const Edges edges(network_, surface_, out);
    std::optional<const Surroundings> around;  // for many membranes no patch can be made
    const int euler = euler_characteristic(found.gone, rims);
    for (const RimParts& parts : partitions(rims.size())) {
        if (!connect_all(parts, membrane_of)) continue;
        const bool handle = euler_characteristic(parts) < euler;
        if (handle && points_.empty()) continue;
        std::vector<Triangle> added = patches_of(parts, rims, surface_.positions, edges);
        if (added.empty() || !network_.can_exchange_faces(found.gone, added)) continue;
        if (!around) around.emplace(surface_, tree_, support_, faces, edge_);
        const float gain = around->gain(added);
        if (gain <= found.gain) continue;
        if (handle && gain >= kLeastGain && !knows_handle(membranes, rims, parts, out)) continue;
        found.gain = gain;
        found.added = std::move(added);
    }
    return found;
}

bool Search::make(Membrane& membrane, std::vector<int> faces) const {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    membrane.faces = std::move(faces);
    return complete(surface_, support_, membrane);
}

/// Adds the faces around.
bool Search::widen(Membrane& membrane) const {
    std::vector<int> faces;
    for (const int f : membrane.faces)
        for (const VertexId v : surface_.faces[f])
            faces.insert(faces.end(), surface_.faces_around(v).begin(), surface_.faces_around(v).end());
    return make(membrane, std::move(faces));
}

Wide Search::widened(const Membrane& membrane) const {
    Wide wide{membrane};
    for (Membrane next = membrane; wide.size() <= kWidest && widen(next);) wide.push_back(next);
    return wide;
}

/// The least gain of a reconnection of membranes that lack so many signals.
float least_gain(float missing) { return std::max(kLeastGain, kLeastShare * missing); }

Reconnection Search::of_one(const Wide& membrane) const {
    const float least = least_gain(membrane.front().missing);
    Reconnection found;
    for (std::size_t ring = 0; ring < membrane.size() && ring < kWidest; ++ring) {
        Reconnection next = best({&membrane[ring]});
        if (next.gain >= least && next.gain > found.gain) found = std::move(next);
    }
    return found;
}

Reconnection Search::of_pair(const Wide& a, const Wide& b) const {
    const float least = least_gain(a.front().missing + b.front().missing);
    Reconnection found = best({&a.front(), &b.front()});
    if (found.gain < kHopeless) return {};
    for (const Membrane& wide_a : a)
        for (const Membrane& wide_b : b) {
            if (&wide_a == &a.front() && &wide_b == &b.front()) continue;
            Reconnection next = best({&wide_a, &wide_b});
            if (next.gain > found.gain) found = std::move(next);
        }
    return found.gain >= least ? found : Reconnection();
}

std::vector<int> faces_of(const Membrane& a, const Membrane& b) {
    std::vector<int> faces = a.faces;
    faces.insert(faces.end(), b.faces.begin(), b.faces.end());
    return faces;
}

/// Whether their normals differ by clearly more than 90 degrees: the angle at the edges of a cube. With a
/// bound of 120 degrees, webs of armadillo stay.
bool are_opposite(const Membrane& a, const Membrane& b) {
    return a.area.dot(b.area) < -0.1F * a.area.norm() * b.area.norm();
}

/// A web may have points at its free edge: those of the corner that it spans are nearest to it. The sides of
/// a web are opposite and lack signals by no accident. So small membranes beside a sharp edge are none.
Reconnection Search::of_web(const Wide& a, const Wide& b) const {
    Reconnection found;
    if (!are_opposite(a.front(), b.front()) ||
        support_.lack_of(faces_of(a.front(), b.front())) < least_lack(surface_))
        return found;
    const float least = least_gain(a.front().missing + b.front().missing);
    for (std::size_t ring = 1; ring < std::min(a.size(), b.size()); ++ring) {
        Membrane web;
        if (!make(web, faces_of(a[ring], b[ring])) || web.rims.size() != 1) continue;
        Reconnection next = best({&web});
        if (next.gain >= least && next.gain > found.gain) found = std::move(next);
    }
    return found;
}

Reconnection Search::of_group(const std::vector<const Wide*>& group) const {
    float missing = 0;
    for (const Wide* wide : group) missing += wide->front().missing;
    Reconnection found;
    found.gain = std::numeric_limits<float>::lowest();
    for (std::size_t ring = 0; ring <= kWidest; ++ring) {
        std::vector<Membrane> membranes;
        for (const Wide* wide : group) membranes.push_back((*wide)[std::min(ring, wide->size() - 1)]);
        if (!take_apart(surface_, support_, membranes)) continue;
        std::vector<const Membrane*> all;
        for (const Membrane& membrane : membranes) all.push_back(&membrane);
        Reconnection next = best(all);
        if (next.gain > found.gain) found = std::move(next);
    }
    return found.gain >= least_gain(missing) ? found : Reconnection();
}

bool Search::may_join(const Membrane& a, const Membrane& b) const {
    return a.rims.size() + b.rims.size() <= kMostRims && face_each_other(surface_, a, b, edge_);
}

void keep(Reconnection change, const std::vector<int>& of, std::vector<Reconnection>& found) {
    if (change.added.empty()) return;
    change.membranes = of;
    found.push_back(std::move(change));
}

/// Of the membrane \p a alone, and with each of those after it.
void search_from(int a, const Search& search, const Indexed<Wide>& wide, std::vector<Reconnection>& found) {
    if (wide[a].front().certain) keep(search.of_one(wide[a]), {a}, found);
    for (int b = a + 1; b < wide.size(); ++b) {
        if (!search.may_join(wide[a].front(), wide[b].front())) continue;
        Reconnection change = search.of_pair(wide[a], wide[b]);
        if (change.added.empty()) change = search.of_web(wide[a], wide[b]);
        keep(std::move(change), {a, b}, found);
    }
}

/// Without those that lack the least signals, as long as the others gain too little with them.
void search_group(std::vector<int> group, const Search& search, const Indexed<Wide>& wide,
                  std::vector<Reconnection>& found) {
    for (const std::size_t before = found.size(); group.size() >= 3 && found.size() == before;
         group.pop_back()) {
        std::vector<const Wide*> of;
        for (const int i : group) of.push_back(&wide[i]);
        keep(search.of_group(of), group, found);
    }
}

}  // namespace

std::vector<Reconnection> find_reconnections(const Network& network, const Surface& surface,
                                             const FaceSignals& support,
                                             const std::vector<Membrane>& membranes,
                                             const std::vector<vcg::Point3f>& points, bool in_groups,
                                             ThreadTeam& team) {
    const std::vector<Membrane> necks = find_necks(network, surface, support);
    std::vector<Reconnection> found;
    if (membranes.empty() && necks.empty()) return found;
    const Search search(network, surface, support, points, team);
    const auto collect = [&](std::size_t count, const auto& find) {
        for (Reconnection& change : parallel_collect<Reconnection>(static_cast<int>(count), 1, team, find))
            found.push_back(std::move(change));
    };
    Indexed<Wide> wide(static_cast<int>(membranes.size()));
    parallel_for(wide.size(), 1, team,
                 [&](int i) { wide[i] = search.widened(membranes[static_cast<std::size_t>(i)]); });
    collect(membranes.size(), [&](int i, auto& all) { search_from(i, search, wide, all); });
    collect(necks.size(), [&](int i, auto& all) {
        keep(search.of_one(search.widened(necks[static_cast<std::size_t>(i)])), {}, all);
    });
    std::vector<std::vector<int>> groups;
    if (in_groups) groups = membrane_groups(surface, membranes, search.edge(), kMostOfGroup);
    collect(groups.size(),
            [&](int i, auto& all) { search_group(groups[static_cast<std::size_t>(i)], search, wide, all); });
    std::stable_sort(found.begin(), found.end(),
                     [](const Reconnection& a, const Reconnection& b) { return a.gain > b.gain; });
    return found;
}

}  // namespace neuralmesh
