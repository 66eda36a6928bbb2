// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The neural mesh M: positions and connectivity of a growing, oriented 2-manifold, with or without boundary.
//
// Connectivity is stored as one ordered one-ring per vertex; faces and edges are implicit. vcglib's mesh is
// not used: it has no vertex split, and its adjacency pointers have to be updated whenever its vectors
// reallocate.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vcg_core/base/error.h"
#include "vcg_core/mesh/ring.h"

namespace neuralmesh {

/// A vertex slot: 16 bytes, so a position is one aligned load.
struct alignas(16) VertexRecord {
    float x, y, z;
    VertexId link;  ///< free for the owner of the network; the mesh does not use it

    vcg::Point3f point() const { return {x, y, z}; }
};

/// A set of ids that can be searched for an id near a given one. If ids follow positions, a new vertex then
/// shares cache lines with its neighbours.
class FreeIds {
public:
    /// Words of 64 ids that take() searches on either side of the word of the given id.
    static constexpr std::size_t kWordsAround = 2;

    int count() const { return count_; }
    /// Inserts \p id. Amortised O(1). \pre the set does not contain id
    void add(std::int32_t id);
    /// Removes and returns the nearest id in the word of \p id, else one from the nearest word within
    /// kWordsAround, else the smallest. Amortised O(1). \pre count() > 0
    std::int32_t take(std::int32_t id);

private:
    bool holds_any(std::size_t word) const { return word < words_.size() && words_[word] != 0; }
    std::int32_t take_bit(std::size_t word, int bit);

    std::vector<std::uint64_t> words_;
    std::size_t first_ = 0;  ///< all words before this one are 0
    int count_ = 0;
};

/// A simplicial, oriented 2-manifold with boundary. The id of a vertex stays the same until compact() or
/// renumber(); the id of a removed vertex is reused. Every operation preserves the manifold conditions, or
/// throws (TopologyError, std::bad_alloc) before it changes anything.
class Network {
public:
    Network() = default;

    /// A network with the given vertices and faces. O(vertices + faces).
    /// \throws TopologyError if the faces do not form an oriented manifold, or a vertex has no faces or a
    /// valence above Ring::kMaxValence
    Network(const std::vector<vcg::Point3f>& positions, const std::vector<Triangle>& faces);

    int vertex_count() const { return vertex_count_; }
    /// Ids are in [0, slot_count()); those that are not alive() are free.
    int slot_count() const { return static_cast<int>(rings_.size()); }
    /// True if id v is used, for v in [0, slot_count()).
    bool alive(VertexId v) const { return ring(v).valence != 0; }
    /// The used ids in ascending order: for (VertexId v : network.vertices()). The loop may remove vertices
    /// but must not add any.
    class Vertices;
    Vertices vertices() const;
    const Ring& ring(VertexId v) const { return rings_[static_cast<std::size_t>(v)]; }
    bool adjacent(VertexId a, VertexId b) const { return ring(a).find(b) >= 0; }
    vcg::Point3f position(VertexId v) const { return slots()[v].point(); }
    void set_position(VertexId v, const vcg::Point3f& p);
    /// By slot; the origin for free slots. O(slots).
    PerVertex<vcg::Point3f> positions() const;
    /// The vertex slots. slots()[-1] is a sentinel: infinitely far, and the end of every list of links.
    VertexRecord* slots() { return slots_.data() + 1; }
    const VertexRecord* slots() const { return slots_.data() + 1; }
    /// Where all of the surface was seen from; nothing: nobody knows. The mesh does not use it.
    const std::optional<vcg::Point3f>& viewer() const { return viewer_; }
    void set_viewer(const std::optional<vcg::Point3f>& viewer) { viewer_ = viewer; }
    /// Reserves memory for that many vertices.
    void reserve(int vertices);

    /// Vertex split, the inverse of a half-edge collapse into \p v. The new vertex, at \p where, takes the
    /// fan of \p count neighbours of v from ring position \p first on (cyclically if the ring is closed). v
    /// keeps the other neighbours; both share the two ends of the fan. \pre can_split(v, first, count)
    /// \return the new vertex. Amortised O(1).
    VertexId split(VertexId v, int first, int count, const vcg::Point3f& where);
    /// True if the fan is valid, both vertices get a valence of at least 3 (2 on a boundary), and no valence
    /// rises above Ring::kMaxValence.
    bool can_split(VertexId v, int first, int count) const;

    /// Half-edge collapse: moves \p gone into its neighbour \p kept and removes it. The position of kept
    /// stays. \pre can_collapse(gone, kept). O(valence).
    void collapse(VertexId gone, VertexId kept);
    /// True if gone and kept are adjacent, their common neighbours are exactly the vertices opposite their
    /// edge (the link condition, Dey et al. 1999), a boundary vertex moves along its boundary only, and all
    /// valences stay between 3 (2 on a boundary) and Ring::kMaxValence.
    bool can_collapse(VertexId gone, VertexId kept) const;

    /// Edge flip: replaces the inner edge a-b by the edge between the two vertices opposite to it.
    /// \pre can_flip(a, b). O(valence).
    void flip(VertexId a, VertexId b);
    /// True if a-b is an inner edge, the new edge does not exist yet, and all valences stay between 3 (2 on a
    /// boundary) and Ring::kMaxValence.
    bool can_flip(VertexId a, VertexId b) const;

    /// Fills the notch at a boundary vertex: adds the face of v and its two neighbours along the boundary,
    /// which makes v an inner vertex. \pre can_fill_notch(v). O(valence).
    void fill_notch(VertexId v);
    /// True if v is on a boundary of more than three edges, the two neighbours along it are not adjacent yet,
    /// and all valences stay between 3 (2 on a boundary) and Ring::kMaxValence.
    bool can_fill_notch(VertexId v) const;

    /// The inverse: removes the face at the boundary edge from \p v to ring(v)[0]. Its third corner, the
    /// inner vertex ring(v)[1], joins the boundary. \pre can_open_face(v). O(valence).
    void open_face(VertexId v);
    /// True if v is on a boundary, the third corner is an inner vertex, and both ends of the edge keep a
    /// valence of at least 2.
    bool can_open_face(VertexId v) const;

    /// Exchanges faces: removes the faces \p gone and adds the faces \p added, whose corners exist. Vertices
    /// that have no faces then are removed. \pre can_exchange_faces(gone, added). O(faces log faces).
    void exchange_faces(const std::vector<Triangle>& gone, const std::vector<Triangle>& added);
    /// True if the faces \p gone exist and the network is a manifold without them and with those \p added:
    /// every vertex concerned keeps one fan of faces, with a valence between 3 (2 on a boundary) and
    /// Ring::kMaxValence, or none.
    bool can_exchange_faces(const std::vector<Triangle>& gone, const std::vector<Triangle>& added) const;

    /// Renumbers the vertices to 0 .. vertex_count() - 1 and keeps their order. Invalidates all ids, for
    /// example those in a WinnerSearch. \return per old slot the new id, or -1. O(vertices).
    PerVertex<VertexId> compact();
    /// Renumbers the vertices: order[i] is the old id of vertex i, or -1 to make id i free. Every used id
    /// occurs once. Later splits take a free id near the id of the parent. \return as compact(). O(vertices).
    PerVertex<VertexId> renumber(const std::vector<VertexId>& order);

    /// O(vertices), as all functions from here on.
    int face_count() const;
    int edge_count() const;
    /// All faces, each once, starting with its smallest vertex, ordered by that vertex.
    std::vector<Triangle> faces() const;
    /// V - E + F.
    int euler_characteristic() const { return vertex_count() - edge_count() + face_count(); }
    int component_count() const;
    /// Per slot the number of its component, in the order of their smallest vertices; -1 for free slots.
    PerVertex<int> components() const;
    /// Orients every closed component so that its faces are counter-clockwise seen from outside of the body:
    /// the enclosed volume becomes positive, and negative for components within an odd number of others,
    /// which are hollows: within most of it, where one cuts another. O(components^2 + faces x the depth).
    void orient_outward();
    int boundary_loop_count() const;
    /// Sum over the components, from the Euler characteristic: components - (euler + loops) / 2.
    int genus() const;

    /// Checks the manifold conditions, the padding, the positions and the counts. \return a sentence about
    /// the first violation, empty if there is none.
    std::string validate() const;

private:
    Ring& ring_of(VertexId v) { return rings_[static_cast<std::size_t>(v)]; }
    VertexId new_vertex(VertexId parent, const vcg::Point3f& where);
    void release(VertexId v);
    void enter_fan(VertexId v, VertexId u, VertexId shared_begin, VertexId shared_end);
    std::string validate_edge(VertexId v, int i) const;
    /// Rings after an exchange of faces; those of vertices without faces have valence 0.
    using ChangedRings = std::vector<std::pair<VertexId, Ring>>;
    bool rings_after(const std::vector<Triangle>& gone, const std::vector<Triangle>& added,
                     ChangedRings& changed) const;

    static constexpr VertexRecord kSentinel{1e18F, 1e18F, 1e18F, -1};
    static constexpr VertexRecord kFreeSlot{0, 0, 0, -1};

    std::vector<Ring> rings_;
    std::vector<VertexRecord> slots_{kSentinel};  ///< slot v is element v + 1
    std::vector<VertexId> free_;                 ///< removed ids while gaps_ is empty
    FreeIds gaps_;                               ///< free ids of a network that renumber() left with gaps
    int vertex_count_ = 0;
    std::optional<vcg::Point3f> viewer_;
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

/// The used ids of \p network along the Z-order curve of their positions (Morton 1966): near vertices mostly
/// get near places. Positions beyond [-1, 1]^3 count as if on its border. O(n log n).
std::vector<VertexId> morton_order(const Network& network);

/// \p ids, with \p count times -1 (a free id) spread evenly between them: new vertices then find a free id
/// near that of the vertex they are split from. O(ids + count).
/// \pre 0 <= count <= ids.size()
std::vector<VertexId> interleave_free(const std::vector<VertexId>& ids, int count);

}  // namespace neuralmesh
