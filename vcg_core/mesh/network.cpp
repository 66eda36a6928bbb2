// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Operations on ordered one-rings.
#include "vcg_core/mesh/network.h"

#include <algorithm>
#include <utility>

#include "vcg_core/base/platform.h"

namespace neuralmesh {

namespace {

constexpr int kMax = Ring::kMaxValence;

VertexId* at(Ring& ring, int i) { return ring.begin() + i; }

void insert(Ring& ring, int i, VertexId v) {
    std::copy_backward(at(ring, i), ring.end(), ring.end() + 1);
    ring[i] = v;
    ++ring.valence;
    ring.pad_cyclically();
}

void insert_before(Ring& ring, VertexId where, VertexId v) { insert(ring, ring.find(where), v); }
void insert_after(Ring& ring, VertexId where, VertexId v) { insert(ring, ring.find(where) + 1, v); }

void erase(Ring& ring, VertexId v) {
    const int i = ring.find(v);
    std::copy(at(ring, i + 1), ring.end(), at(ring, i));
    --ring.valence;
    ring.pad_cyclically();
}

void replace(Ring& ring, VertexId old, VertexId now) {
    ring[ring.find(old)] = now;
    ring.pad_cyclically();
}

/// Replaces \p old by the \p count vertices from \p now on.
void replace(Ring& ring, VertexId old, const VertexId* now, int count) {
    const int i = ring.find(old);
    std::array<VertexId, kMax> tail;
    const auto tail_end = std::copy(at(ring, i + 1), ring.end(), tail.begin());
    std::copy(tail.begin(), tail_end, std::copy(now, now + count, at(ring, i)));
    ring.valence = static_cast<std::uint8_t>(ring.valence + count - 1);
    ring.pad_cyclically();
}

/// Makes position i of a closed ring its start.
void rotate(Ring& ring, int i) {
    std::rotate(ring.begin(), at(ring, i), ring.end());
    ring.pad_cyclically();
}

int common_neighbours(const Ring& a, const Ring& b) {
    return static_cast<int>(std::count_if(a.begin(), a.end(), [&](VertexId v) { return b.find(v) >= 0; }));
}

/// Position of the set bit of \p word nearest to \p bit; of two, the higher. \pre word != 0
int nearest(std::uint64_t word, int bit) {
    const std::uint64_t above = word >> bit << bit;
    const std::uint64_t below = word ^ above;
    if (above == 0) return highest_bit(below);
    if (below == 0) return lowest_bit(above);
    return lowest_bit(above) - bit <= bit - highest_bit(below) ? lowest_bit(above) : highest_bit(below);
}

}  // namespace

void FreeIds::add(std::int32_t id) {
    const auto word = static_cast<std::size_t>(id) / 64;
    if (word >= words_.size()) words_.resize(word + 1, 0);
    words_[word] |= std::uint64_t{1} << (id % 64);
    first_ = std::min(first_, word);
    ++count_;
}

std::int32_t FreeIds::take(std::int32_t id) {
    const auto word = static_cast<std::size_t>(id) / 64;
    if (holds_any(word)) return take_bit(word, nearest(words_[word], id % 64));
    for (std::size_t d = 1; d <= kWordsAround; ++d) {
        if (holds_any(word + d)) return take_bit(word + d, lowest_bit(words_[word + d]));
        if (word >= d && holds_any(word - d)) return take_bit(word - d, highest_bit(words_[word - d]));
    }
    while (words_[first_] == 0) ++first_;
    return take_bit(first_, lowest_bit(words_[first_]));
}

std::int32_t FreeIds::take_bit(std::size_t word, int bit) {
    words_[word] &= ~(std::uint64_t{1} << bit);
    --count_;
    return static_cast<std::int32_t>(64 * word) + bit;
}

void Network::reserve(int vertices) {
    rings_.reserve(static_cast<std::size_t>(vertices));
    slots_.reserve(static_cast<std::size_t>(vertices) + 1);
}

void Network::set_position(VertexId v, const vcg::Point3f& p) {
    VertexRecord& slot = slots()[v];
    slot.x = p[0];
    slot.y = p[1];
    slot.z = p[2];
}

PerVertex<vcg::Point3f> Network::positions() const {
    PerVertex<vcg::Point3f> result(slot_count(), vcg::Point3f(0, 0, 0));
    for (const VertexId v : vertices()) result[v] = position(v);
    return result;
}

VertexId Network::new_vertex(VertexId parent, const vcg::Point3f& where) {
    VertexId v = slot_count();
    if (gaps_.count() > 0) {
        v = gaps_.take(parent);
    } else if (!free_.empty()) {
        v = free_.back();
        free_.pop_back();
    } else {
        // The new slot may exist: if an earlier push_back() below has thrown, it was left over.
        slots_.resize(rings_.size() + 2, kFreeSlot);
        rings_.push_back(Ring{});
    }
    set_position(v, where);
    ++vertex_count_;
    return v;
}

void Network::release(VertexId v) {
    if (gaps_.count() > 0) {
        gaps_.add(v);
    } else {
        free_.push_back(v);
    }
}

bool Network::can_split(VertexId v, int first, int count) const {
    const Ring& r = ring(v);
    const int k = r.valence;
    if (first < 0 || first >= k || count < 1 || count > k) return false;
    if (r.open != 0) {
        if (first + count > k) return false;
        if (first == 0 || first + count == k) {
            const VertexId shared = first == 0 ? r[count - 1] : r[first];
            return k - count + 2 <= kMax && count + 1 <= kMax && ring(shared).valence < kMax;
        }
    }
    const VertexId e2 = r[first];
    const VertexId e1 = r[(first + count - 1) % k];
    return count >= 2 && k - count + 3 <= kMax && count + 1 <= kMax && ring(e1).valence < kMax &&
           ring(e2).valence < kMax;
}

VertexId Network::split(VertexId v, int first, int count, const vcg::Point3f& where) {
    if (!alive(v) || !can_split(v, first, count))
        throw TopologyError("This vertex split would break the network; ask can_split() first.");
    const VertexId u = new_vertex(v, where);
    Ring& rv = ring_of(v);
    Ring& ru = ring_of(u);
    const bool takes_start = rv.open != 0 && first == 0;
    const bool takes_end = rv.open != 0 && !takes_start && first + count == rv.valence;
    if (rv.open == 0) {
        rotate(rv, first);
        first = 0;
    }

    ru = Ring{};
    std::copy(at(rv, first), at(rv, first + count), at(ru, 0));
    ru.valence = static_cast<std::uint8_t>(count);
    ru.open = (takes_start || takes_end) ? 1 : 0;
    const VertexId e2 = ru[0];
    const VertexId e1 = ru[count - 1];
    insert(ru, takes_end ? 0 : count, v);

    // v keeps the neighbours outside the fan and its shared ends, with u between them.
    const int keep_from = takes_start ? first : first + 1;
    const int keep_to = takes_end ? first + count : first + count - 1;
    std::copy(at(rv, keep_to), rv.end(), at(rv, keep_from));
    rv.valence = static_cast<std::uint8_t>(rv.valence - (keep_to - keep_from));
    insert(rv, keep_from, u);

    const bool shares_e2 = !takes_start || count == 1;
    const bool shares_e1 = !takes_end;
    enter_fan(v, u, shares_e2 ? e2 : -1, shares_e1 ? e1 : -1);
    return u;
}

/// Enters the new vertex u into the rings of its neighbours other than v: at the shared ends of its fan
/// beside v, else in place of v. An end that is not shared is -1.
void Network::enter_fan(VertexId v, VertexId u, VertexId shared_begin, VertexId shared_end) {
    for (const VertexId t : ring(u)) {
        if (t == v) continue;
        if (t == shared_end) {
            insert_after(ring_of(t), v, u);
        } else if (t == shared_begin) {
            insert_before(ring_of(t), v, u);
        } else {
            replace(ring_of(t), v, u);
        }
    }
}

bool Network::can_collapse(VertexId gone, VertexId kept) const {
    const Ring& rg = ring(gone);
    const Ring& rk = ring(kept);
    const int i = rg.find(kept);
    if (i < 0) return false;
    const bool on_boundary = rg.is_boundary_edge(i);
    // A boundary vertex may move only along its boundary: else the boundary would change its shape or be
    // pinched.
    if (rg.open != 0 && !on_boundary) return false;
    const int opposite = on_boundary ? 1 : 2;
    if (common_neighbours(rg, rk) != opposite) return false;
    const int valence = on_boundary ? rg.valence + rk.valence - 3 : rg.valence + rk.valence - 4;
    if (valence < rk.min_valence() || valence > kMax) return false;
    const auto can_lose_one = [&](VertexId w) { return ring(w).valence > ring(w).min_valence(); };
    if (on_boundary) return can_lose_one(i == 0 ? rg[1] : rg[i - 1]);
    return can_lose_one(rg.next(i)) && can_lose_one(rg.previous(i));
}

void Network::collapse(VertexId gone, VertexId kept) {
    if (!can_collapse(gone, kept))
        throw TopologyError("This half-edge collapse would break the network; ask can_collapse() first.");
    // First, as it may throw std::bad_alloc.
    release(gone);
    Ring rg = ring(gone);
    const bool on_boundary = rg.open != 0;
    const int i = rg.find(kept);
    // kept takes over [from, to) of gone's ring; each vertex opposite the edge loses one edge.
    int from = 2;
    int to = rg.valence - 1;
    if (!on_boundary) {
        rotate(rg, i);
        erase(ring_of(rg[1]), gone);
        erase(ring_of(rg[rg.valence - 1]), gone);
    } else if (i == 0) {
        to = rg.valence;
        erase(ring_of(rg[1]), gone);
    } else {
        from = 0;
        to = rg.valence - 2;
        erase(ring_of(rg[to]), gone);
    }
    for (int j = from; j < to; ++j) replace(ring_of(rg[j]), gone, kept);
    replace(ring_of(kept), gone, rg.neighbours.data() + from, to - from);
    ring_of(gone) = Ring{};
    --vertex_count_;
}

bool Network::can_flip(VertexId a, VertexId b) const {
    const Ring& ra = ring(a);
    const Ring& rb = ring(b);
    const int i = ra.find(b);
    if (i < 0 || ra.is_boundary_edge(i)) return false;
    const VertexId c = ra.next(i);
    const VertexId d = ra.previous(i);
    return ra.valence > ra.min_valence() && rb.valence > rb.min_valence() && ring(c).valence < kMax &&
           ring(d).valence < kMax && !adjacent(c, d);
}

void Network::flip(VertexId a, VertexId b) {
    if (!can_flip(a, b)) throw TopologyError("This edge flip would break the network; ask can_flip() first.");
    const int i = ring(a).find(b);
    const VertexId c = ring(a).next(i);
    const VertexId d = ring(a).previous(i);
    erase(ring_of(a), b);
    erase(ring_of(b), a);
    insert_after(ring_of(c), a, d);
    insert_after(ring_of(d), b, c);
}

bool Network::can_fill_notch(VertexId v) const {
    const Ring& r = ring(v);
    if (r.open == 0 || r.valence < 3) return false;
    const Ring& after = ring(r[0]);
    const Ring& before = ring(r[r.valence - 1]);
    return after.find(r[r.valence - 1]) < 0 && after.valence < kMax && before.valence < kMax;
}

void Network::fill_notch(VertexId v) {
    if (!can_fill_notch(v)) throw TopologyError("This notch cannot be filled; ask can_fill_notch() first.");
    Ring& r = ring_of(v);
    const VertexId after = r[0];
    const VertexId before = r[r.valence - 1];
    r.open = 0;
    insert(ring_of(after), ring(after).valence, before);
    insert(ring_of(before), 0, after);
}

bool Network::can_open_face(VertexId v) const {
    const Ring& r = ring(v);
    return r.open != 0 && r.valence > 2 && ring(r[0]).valence > 2 && ring(r[1]).open == 0;
}

void Network::open_face(VertexId v) {
    if (!can_open_face(v)) throw TopologyError("This face cannot be removed; ask can_open_face() first.");
    const VertexId after = ring(v)[0];
    Ring& corner = ring_of(ring(v)[1]);
    erase(ring_of(v), after);
    erase(ring_of(after), v);
    rotate(corner, corner.find(after));
    corner.open = 1;
}

PerVertex<VertexId> Network::compact() {
    std::vector<VertexId> order;
    for (const VertexId v : vertices()) order.push_back(v);
    return renumber(order);
}

PerVertex<VertexId> Network::renumber(const std::vector<VertexId>& order) {
    PerVertex<VertexId> moved(slot_count(), -1);
    FreeIds gaps;
    VertexId id = 0;
    for (const VertexId old : order) {
        if (old >= 0) {
            moved[old] = id;
        } else {
            gaps.add(id);
        }
        ++id;
    }
    std::vector<Ring> rings;
    std::vector<VertexRecord> slots_in_order;
    rings.reserve(std::max(rings_.capacity(), order.size()));
    slots_in_order.reserve(std::max(slots_.capacity(), order.size() + 1));
    slots_in_order.push_back(kSentinel);
    for (const VertexId old : order) {
        rings.push_back(old < 0 ? Ring{} : ring(old));
        slots_in_order.push_back(old < 0 ? kFreeSlot : slots()[old]);
        for (VertexId& v : rings.back()) v = moved[v];
        rings.back().pad_cyclically();
    }
    rings_.swap(rings);
    slots_.swap(slots_in_order);
    free_.clear();
    gaps_ = std::move(gaps);
    return moved;
}

}  // namespace neuralmesh
