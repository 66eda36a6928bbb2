// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/reconnection.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <set>
#include <utility>

#include "vcg_core/topology/corridors.h"
#include "vcg_core/topology/surroundings.h"

namespace neuralmesh {
namespace {

/// Membranes with more rims have too many reconnections to try.
constexpr std::size_t kMostRims = 4;
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

/// Which rims are joined: pairs of their indices; the others are closed.
using Matching = std::vector<std::pair<std::size_t, std::size_t>>;

void add_matchings(std::vector<std::size_t> free, Matching& chosen, std::vector<Matching>& all) {
    if (free.empty()) {
        all.push_back(chosen);
        return;
    }
    const std::size_t first = free.front();
    free.erase(free.begin());
    add_matchings(free, chosen, all);
    for (std::size_t i = 0; i < free.size(); ++i) {
        std::vector<std::size_t> rest = free;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
        chosen.emplace_back(first, free[i]);
        add_matchings(rest, chosen, all);
        chosen.pop_back();
    }
}

std::vector<Matching> matchings(std::size_t rims) {
    std::vector<std::size_t> free(rims);
    for (std::size_t i = 0; i < rims; ++i) free[i] = i;
    Matching chosen;
    std::vector<Matching> all;
    add_matchings(free, chosen, all);
    return all;
}

/// The faces that close the rims or join them as \p matching says; none if one of them gets none.
std::vector<Triangle> patches(const std::vector<Rim>& rims, const Matching& matching,
                              const PerVertex<Vector3>& positions, const Edges& edges) {
    std::vector<Triangle> all;
    std::vector<char> joined(rims.size(), 0);
    const auto add = [&](const std::vector<Triangle>& faces) {
        all.insert(all.end(), faces.begin(), faces.end());
        return !faces.empty();
    };
    for (const auto& [a, b] : matching) {
        if (!add(joining_patch(rims[a], rims[b], positions, edges))) return {};
        joined[a] = joined[b] = 1;
    }
    for (std::size_t i = 0; i < rims.size(); ++i)
        if (joined[i] == 0 && !add(closing_patch(rims[i], positions, edges))) return {};
    return all;
}

/// A membrane, and the same one and more rings wider.
using Wide = std::vector<Membrane>;

class Search {
public:
    Search(const Network& network, const Surface& surface, const FaceSignals& support,
           const std::vector<vcg::Point3f>& points)
        : network_(network),
          surface_(surface),
          support_(support),
          points_(points),
          edge_(mean_edge_length(surface)) {}

    Wide widened(const Membrane& membrane) const;
    /// The best reconnection of a membrane, if it gains enough; else one without faces.
    Reconnection of_one(const Wide& membrane) const;
    /// The same of two membranes, joined.
    Reconnection of_pair(const Wide& a, const Wide& b) const;
    bool may_join(const Membrane& a, const Membrane& b) const;

private:
    Reconnection best(const std::vector<const Membrane*>& membranes) const;
    bool widen(Membrane& membrane) const;
    /// Whether the points know a handle, or one component, where the rims that \p matching pairs are joined.
    bool knows_handle(const std::vector<const Membrane*>& membranes, const std::vector<Rim>& rims,
                      const Matching& matching, const PerFace<char>& out) const;

    const Network& network_;
    const Surface& surface_;
    const FaceSignals& support_;
    const std::vector<vcg::Point3f>& points_;
    float edge_;
    mutable std::unique_ptr<const Corridors> corridors_;  ///< made when they are first asked for
};

/// Vertices less edges and faces of the faces inside \p rims.
int euler_characteristic(const std::vector<Triangle>& faces, const std::vector<Rim>& rims) {
    std::set<VertexId> vertices;
    for (const Triangle& f : faces) vertices.insert(f.begin(), f.end());
    std::size_t sides = 3 * faces.size();  // an edge on a rim has one, the others have two
    for (const Rim& rim : rims) sides += rim.size();
    return static_cast<int>(vertices.size()) - static_cast<int>(sides / 2) + static_cast<int>(faces.size());
}

bool Search::knows_handle(const std::vector<const Membrane*>& membranes, const std::vector<Rim>& rims,
                          const Matching& matching, const PerFace<char>& out) const {
    if (!corridors_) corridors_ = std::make_unique<const Corridors>(surface_, support_, points_, edge_);
    float width = 0;
    for (const Membrane* membrane : membranes) width += corridors_->widest(membrane->faces);
    if (width < kLeastRadius * static_cast<float>(membranes.size())) return false;
    return std::none_of(matching.begin(), matching.end(), [&](const auto& pair) {
        return corridors_->lead(rims[pair.first], rims[pair.second], out);
    });
}

/// Of the membranes together; of two, one that joins them. Its gain is the lowest number if there is none.
Reconnection Search::best(const std::vector<const Membrane*>& membranes) const {
    Reconnection found;
    found.gain = std::numeric_limits<float>::lowest();
    std::vector<int> faces;
    std::vector<Rim> rims;
    for (const Membrane* membrane : membranes) {
        faces.insert(faces.end(), membrane->faces.begin(), membrane->faces.end());
        rims.insert(rims.end(), membrane->rims.begin(), membrane->rims.end());
    }
    if (rims.size() > kMostRims) return found;
    PerFace<char> out(surface_.face_count(), 0);
    for (const int f : faces) {
        if (out[f]++ != 0) return found;  // the membranes overlap
        found.gone.push_back(surface_.faces[f]);
    }
    const std::size_t of_first = membranes.front()->rims.size();
    const Edges edges(network_, surface_, out);
    const Surroundings around(surface_, support_, faces, edge_);
    const float before = around.cost(found.gone);
    const int euler = euler_characteristic(found.gone, rims);
    for (const Matching& matching : matchings(rims.size())) {
        const bool across = std::any_of(matching.begin(), matching.end(), [&](const auto& pair) {
            return (pair.first < of_first) != (pair.second < of_first);
        });
        if (across != (membranes.size() > 1)) continue;
        const bool handle = static_cast<int>(rims.size() - 2 * matching.size()) < euler;
        if (handle && points_.empty()) continue;
        std::vector<Triangle> added = patches(rims, matching, surface_.positions, edges);
        if (added.empty() || !network_.can_exchange_faces(found.gone, added)) continue;
        const float gain = before - around.cost(added);
        if (gain <= found.gain) continue;
        if (handle && gain >= kLeastGain && !knows_handle(membranes, rims, matching, out)) continue;
        found.gain = gain;
        found.added = std::move(added);
    }
    return found;
}

/// Adds the faces around.
bool Search::widen(Membrane& membrane) const {
    std::vector<int> faces;
    for (const int f : membrane.faces)
        for (const VertexId v : surface_.faces[f])
            faces.insert(faces.end(), surface_.faces_around(v).begin(), surface_.faces_around(v).end());
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    membrane.faces = std::move(faces);
    return complete(surface_, support_, membrane);
}

Wide Search::widened(const Membrane& membrane) const {
    Wide wide{membrane};
    for (Membrane next = membrane; wide.size() <= kWidest && widen(next);) wide.push_back(next);
    return wide;
}

Reconnection Search::of_one(const Wide& membrane) const {
    const float least = std::max(kLeastGain, kLeastShare * membrane.front().missing);
    Reconnection found;
    for (std::size_t ring = 0; ring < membrane.size() && ring < kWidest; ++ring) {
        Reconnection next = best({&membrane[ring]});
        if (next.gain >= least && next.gain > found.gain) found = std::move(next);
    }
    return found;
}

Reconnection Search::of_pair(const Wide& a, const Wide& b) const {
    const float least = std::max(kLeastGain, kLeastShare * (a.front().missing + b.front().missing));
    Reconnection found = best({&a.front(), &b.front()});
    if (found.gain < kHopeless) return {};
    for (const Membrane& wide_a : a)
        for (const Membrane& wide_b : b) {
            Reconnection next = best({&wide_a, &wide_b});
            if (next.gain > found.gain) found = std::move(next);
        }
    return found.gain >= least ? found : Reconnection();
}

bool Search::may_join(const Membrane& a, const Membrane& b) const {
    return a.rims.size() + b.rims.size() <= kMostRims && face_each_other(surface_, a, b, edge_);
}

}  // namespace

std::vector<Reconnection> find_reconnections(const Network& network, const Surface& surface,
                                             const FaceSignals& support,
                                             const std::vector<Membrane>& membranes,
                                             const std::vector<vcg::Point3f>& points) {
    const Search search(network, surface, support, points);
    std::vector<Reconnection> found;
    const auto keep = [&](Reconnection change, const std::vector<int>& of) {
        if (change.added.empty()) return;
        change.membranes = of;
        found.push_back(std::move(change));
    };
    const auto membrane = [&](int i) -> const Membrane& { return membranes[static_cast<std::size_t>(i)]; };
    const int count = static_cast<int>(membranes.size());
    Indexed<Wide> wide(count);
    const auto widened = [&](int i) -> const Wide& {
        if (wide[i].empty()) wide[i] = search.widened(membrane(i));
        return wide[i];
    };
    for (int a = 0; a < count; ++a) {
        if (membrane(a).certain) keep(search.of_one(widened(a)), {a});
        for (int b = a + 1; b < count; ++b)
            if (search.may_join(membrane(a), membrane(b)))
                keep(search.of_pair(widened(a), widened(b)), {a, b});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Reconnection& a, const Reconnection& b) { return a.gain > b.gain; });
    return found;
}

}  // namespace neuralmesh
