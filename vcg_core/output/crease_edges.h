// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The edges of a mesh that lie on creases, while they are chosen.
#pragma once

#include <vcg/space/point3.h>

#include <array>
#include <vector>

#include "vcg_core/learning/filtered_faces.h"
#include "vcg_core/mesh/network.h"

namespace neuralmesh {

/// A graph over the vertices of a network. It begins with sharp edges and is tidied step by step until its
/// edges form lines, as crease_lines() says. A line runs from a corner (more than two edges) or end (one
/// edge) to the next.
class CreaseEdges {
public:
    /// Keeps references. \p measure: that of CreaseMeasure.
    CreaseEdges(const Network& network, const FilteredFaces& faces, const PerVertex<float>& measure)
        : network_(network), faces_(faces), measure_(measure), joined_(network.slot_count()) {}

    void add_sharp_edges();
    /// A face between three sharp edges is a bevel or the tip of a corner: its least sharp edge goes.
    void open_triangles();
    /// Goes on from the ends of lines, straight ahead, to another line at most \p reach away.
    void bridge_gaps(float reach);
    /// Cuts branches of few edges, and separate lines of few edges.
    void drop_spurs();
    /// Contracts edges shorter than \p least, so that strips of faces along a crease, and zigzags, become one
    /// line. The sharper end stays.
    void contract_below(float least);
    /// Of three edges that form a triangle, cuts the longest.
    void open_loops();
    /// Joins the ends of lines, which may be anywhere beside a corner, to lines at most \p reach away.
    void join_ends(float reach);
    /// Of two short lines between the same corners, which border a strip of faces, keeps the one of higher
    /// measure.
    void drop_doubles();

    int degree(VertexId v) const { return static_cast<int>(joined_[v].size()); }
    /// The other ends of the edges at \p v.
    const std::vector<VertexId>& joined(VertexId v) const { return joined_[v]; }

private:
    using Edge = std::array<VertexId, 2>;
    using Line = std::vector<VertexId>;

    /// How a line may go on from its end: how far, over which vertices, and the cosine of the widest turn.
    struct Search {
        float reach, least_measure, least_cosine;
    };

    bool are_joined(VertexId a, VertexId b) const;
    void join(VertexId a, VertexId b);
    void cut(VertexId a, VertexId b);
    void cut(const Line& line);
    template <class Value>
    void open_loops_by(const Value& value);
    void contract(VertexId gone, VertexId kept);
    bool drop_double_at(VertexId a);
    VertexId joined_before(VertexId v, float least) const;
    Line path_ahead(VertexId end, const Search& search) const;
    bool is_ahead(VertexId end, VertexId v, const Search& search) const;
    Line line_from(VertexId v, VertexId next) const;
    double mean_measure(const Line& line) const;
    float cosine(VertexId a, VertexId b) const;
    float length(VertexId a, VertexId b) const;
    vcg::Point3f unit_from(VertexId a, VertexId b) const;

    const Network& network_;
    const FilteredFaces& faces_;
    const PerVertex<float>& measure_;
    PerVertex<std::vector<VertexId>> joined_;
};

}  // namespace neuralmesh
