// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The neural mesh M itself: positions and connectivity of a growing, oriented 2-manifold, with or
// without boundary. Knows nothing of learning.
//
// Connectivity is kept as one ordered one-ring per vertex, in a cache line of its own; faces and edges
// are implied. vcglib has no vertex split and its adjacencies move on reallocation, so this is ours.
#pragma once

#include <vcg/space/point3.h>

#include <cstdint>
#include <string>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/base/huge_pages.h"
#include "vcg_core/mesh/free_ids.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {

/// 16 bytes, so that a position is one aligned load; the spare word belongs to the winner search.
struct alignas(16) VertexRecord {
    float x, y, z;
    VertexId link;

    vcg::Point3f point() const { return {x, y, z}; }
};

/// A simplicial, oriented 2-manifold with boundary. Vertex ids are stable; free ids, of removed vertices for
/// one, are used again. Every operation below keeps the manifold or throws (TopologyError,
/// std::bad_alloc) before it has changed anything.
class Network {
public:
    Network() = default;

    /// A network with the given vertices and faces.
    /// \throws TopologyError: not an oriented manifold, a vertex without faces, or a valence above
    /// Ring::kMaxValence. O(vertices + faces).
    Network(const std::vector<vcg::Point3f>& positions, const std::vector<Triangle>& faces);

    int vertex_count() const { return vertex_count_; }
    /// Ids run from 0 to slot_count() - 1; alive() tells the used ones.
    int slot_count() const { return static_cast<int>(rings_.size()); }
    bool alive(VertexId v) const { return ring(v).valence != 0; }
    /// The used ids in rising order: for (VertexId v : network.vertices()). Skips what is removed while it
    /// runs; the network must not grow meanwhile.
    class Vertices;
    Vertices vertices() const;
    const Ring& ring(VertexId v) const { return rings_[static_cast<std::size_t>(v)]; }
    vcg::Point3f position(VertexId v) const { return slots()[v].point(); }
    void set_position(VertexId v, const vcg::Point3f& p);
    /// Regions are for threads to share the work; a new vertex has that of the vertex it was split from.
    void set_tag(VertexId v, int tag) { ring_of(v).tag = static_cast<std::uint16_t>(tag); }
    /// Raw slots for the hot loops. slots()[-1] is nobody's: far from everything, and last in any cell.
    VertexRecord* slots() { return slots_.data() + 1; }
    const VertexRecord* slots() const { return slots_.data() + 1; }
    void reserve(int vertices);
    /// Memory in use, without what is reserved for growth.
    std::size_t bytes() const {
        return rings_.size() * sizeof(Ring) + slots_.size() * sizeof(VertexRecord) +
               free_.size() * sizeof(VertexId) + gaps_.bytes();
    }

    bool adjacent(VertexId a, VertexId b) const { return ring(a).find(b) >= 0; }

    /// Vertex split: the new vertex takes over the neighbours of \p v from ring position \p first on,
    /// \p count of them (cyclically where the ring is closed), as a fan; v keeps the rest and shares the two
    /// ends. Inverse of a half-edge collapse into v. The new vertex gets the position \p where.
    /// \pre can_split(v, first, count)
    /// \return the new vertex. Amortised O(1).
    VertexId split(VertexId v, int first, int count, const vcg::Point3f& where);
    /// True if both halves keep a valence of at least 3 (2 on a boundary) and no valence grows beyond
    /// Ring::kMaxValence.
    bool can_split(VertexId v, int first, int count) const;

    /// Half-edge collapse: removes \p gone by moving it into its neighbour \p kept, which stays where it is.
    /// \pre can_collapse(gone, kept). O(valence).
    void collapse(VertexId gone, VertexId kept);
    /// The link condition (Dey et al. 1999: the common neighbours are exactly those opposite the edge), a
    /// boundary vertex only along its boundary (or the boundary would move), no valence below 3 (2 on a
    /// boundary) or above Ring::kMaxValence afterwards.
    bool can_collapse(VertexId gone, VertexId kept) const;

    /// Edge flip: replaces the inner edge a-b by the edge between the two vertices opposite to it.
    /// \pre can_flip(a, b). O(valence).
    void flip(VertexId a, VertexId b);
    /// True if a-b is an inner edge, the new edge does not exist yet and all valences stay in range.
    bool can_flip(VertexId a, VertexId b) const;

    /// Gives new ids, so that the used ones are 0 .. vertex_count() - 1, in unchanged order. Whatever holds
    /// ids, a WinnerSearch for one, must be made anew. \return for every old slot its new id, or -1.
    std::vector<VertexId> compact();
    /// The same in another order: \p order[i] is the old id of vertex i, every used id once, or -1 where i is
    /// to be free. A new vertex takes a free id near that of the one it is split from. O(vertices).
    std::vector<VertexId> renumber(const std::vector<VertexId>& order);

    int face_count() const;
    int edge_count() const;
    /// All faces, each once, starting from its smallest vertex, in order of that vertex. O(vertices).
    std::vector<Triangle> faces() const;
    /// V - E + F.
    int euler_characteristic() const { return vertex_count() - edge_count() + face_count(); }
    int component_count() const;
    /// For every slot the number of its component, from 0 in order of the smallest vertex; -1 for free slots.
    std::vector<int> components() const;
    /// Turns every closed component that encloses a negative volume inside out, so that all faces are
    /// counter-clockwise seen from outside. O(vertices).
    void orient_outward();
    int boundary_loop_count() const;
    /// Sum over the components, from the Euler characteristic: components - (euler + loops) / 2.
    int genus() const;

    /// Full check of every promise above. Empty if all hold, else a sentence naming the first breach.
    std::string validate() const;

private:
    Ring& ring_of(VertexId v) { return rings_[static_cast<std::size_t>(v)]; }
    VertexId new_vertex(VertexId parent, const vcg::Point3f& where);

    HugeVector<Ring> rings_;
    static constexpr VertexRecord kSentinel{1e18F, 1e18F, 1e18F, -1};

    HugeVector<VertexRecord> slots_{kSentinel};  ///< of vertex v at v + 1
    std::vector<VertexId> free_;
    FreeIds gaps_;  ///< those that are free in a network whose ids follow places
    int vertex_count_ = 0;
};

class Network::Vertices {
public:
    class Iterator {
    public:
        Iterator(const Network& network, VertexId v) : network_(&network), v_(v) { skip_free(); }
        VertexId operator*() const { return v_; }
        Iterator& operator++() {
            ++v_;
            skip_free();
            return *this;
        }
        bool operator!=(const Iterator& other) const { return v_ != other.v_; }

    private:
        void skip_free() {
            while (v_ < network_->slot_count() && !network_->alive(v_)) ++v_;
        }
        const Network* network_;
        VertexId v_;
    };

    explicit Vertices(const Network& network) : network_(&network) {}
    Iterator begin() const { return {*network_, 0}; }
    Iterator end() const { return {*network_, network_->slot_count()}; }

private:
    const Network* network_;
};

inline Network::Vertices Network::vertices() const { return Vertices(*this); }

}  // namespace neuralmesh
