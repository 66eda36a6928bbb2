// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Flattened and folded faces along a boundary, and its notches.
#include "vcg_core/learning/boundary_faces.h"

#include "tests/unit/support/prelude.h"
#include "vcg_core/mesh/triangle.h"

namespace neuralmesh::boundary_faces_test {

using vcg::Point3f;

constexpr float kHeight = 0.8660254F;  ///< of an equilateral triangle

GrowthOptions options() {
    GrowthOptions result;
    result.grow_to = 200;
    return result;
}

/// The vertices of a flat patch of equilateral triangles with edges of length 1, at most \p radius edges from
/// the middle.
struct Patch {
    std::vector<Point3f> positions;
    std::vector<Triangle> faces;

    explicit Patch(int radius = 2) {
        std::map<std::pair<int, int>, VertexId> at;
        for (int i = -radius; i <= radius; ++i)
            for (int j = -radius; j <= radius; ++j) {
                if (std::abs(i + j) > radius) continue;
                at[{i, j}] = static_cast<VertexId>(positions.size());
                positions.emplace_back(static_cast<float>(i) + 0.5F * static_cast<float>(j),
                                       kHeight * static_cast<float>(j), 0.0F);
            }
        for (const auto& [place, v] : at) {
            const auto [i, j] = place;
            const auto right = at.find({i + 1, j}), up = at.find({i, j + 1}), left = at.find({i - 1, j + 1});
            if (right != at.end() && up != at.end()) faces.push_back({v, right->second, up->second});
            if (up != at.end() && left != at.end()) faces.push_back({v, up->second, left->second});
        }
    }
    Network network() const { return Network(positions, faces); }

    VertexId nearest(const Point3f& place) const {
        const auto distance = [&](const Point3f& p) { return (p - place).SquaredNorm(); };
        const auto found =
            std::min_element(positions.begin(), positions.end(),
                             [&](const Point3f& a, const Point3f& b) { return distance(a) < distance(b); });
        return static_cast<VertexId>(found - positions.begin());
    }

    /// With another face on the lower boundary edge from (-1, y) to (0, y), y = -2 kHeight.
    Network with_ear(float x, float y) {
        const VertexId a = nearest({-1, -2 * kHeight, 0});
        const VertexId b = nearest({0, -2 * kHeight, 0});
        positions.emplace_back(x, y, 0.0F);
        faces.push_back({b, a, static_cast<VertexId>(positions.size()) - 1});
        return network();
    }
};

int folded_faces(const Network& network) {
    int count = 0;
    for (const Triangle& f : network.faces())
        if (area_vector(network.position(f[0]), network.position(f[1]), network.position(f[2]))[2] < 0)
            ++count;
    return count;
}

using Signals = std::vector<std::pair<VertexId, Point3f>>;

/// Mends \p network. \return the number of faces changed
int mend(Network& network, bool may_remove, const Signals& won = {}) {
    LearningState state(options(), network);
    BoundarySignals signals;
    for (const auto& [winner, signal] : won) signals.add(winner, signal);
    const int changed = mend_boundary_faces(state, signals, may_remove);
    network = state.network;
    EXPECT_EQ(network.validate(), "");
    EXPECT_EQ(network.euler_characteristic(), 1);
    return changed;
}

TEST(BoundaryFaces, OfAGoodMeshStay) {
    Network patch = Patch().network();
    EXPECT_EQ(mend(patch, true), 0);
    Network sharp = Patch().with_ear(-0.5F, -3.2F * kHeight);
    EXPECT_EQ(mend(sharp, true), 0);
}

TEST(BoundaryFaces, OpenForAnInnerVertexAtOrBeyondTheirEdge) {
    const Patch patch;
    const VertexId inner = patch.nearest({-0.5F, -kHeight, 0});
    for (const float y : {-1.8F, -2.1F}) {  // times kHeight: the boundary edge is at -2
        Network network = patch.network();
        network.set_position(inner, {-0.5F, y * kHeight, 0});
        EXPECT_EQ(mend(network, false), 1);
        EXPECT_EQ(network.ring(inner).open, 1);
        EXPECT_EQ(network.face_count(), static_cast<int>(patch.faces.size()) - 1);
        EXPECT_EQ(folded_faces(network), 0);
    }
}

TEST(BoundaryFaces, GainFromFlippingAnEar) {
    for (const float y : {-2.4F, -1.7F}) {  // blunt, and folded
        Network network = Patch().with_ear(-0.5F, y * kHeight);
        EXPECT_EQ(mend(network, false), 1);
        EXPECT_EQ(network.vertex_count(), 20);
        EXPECT_EQ(folded_faces(network), 0);
        EXPECT_EQ(network.ring(19).valence, 3);
    }
}

TEST(BoundaryFaces, LoseAnEarThatNoFlipUnfolds) {
    Network network = Patch().with_ear(0.9F, -1.2F * kHeight);
    EXPECT_EQ(folded_faces(network), 1);
    EXPECT_EQ(mend(network, false), 0) << "it may not be removed";
    EXPECT_EQ(mend(network, true), 1);
    EXPECT_EQ(network.vertex_count(), 19);
    EXPECT_EQ(folded_faces(network), 0);
}

/// A patch with a boundary of 6 x \p radius edges. In the middle of its lowest row of faces, one face is a
/// notch whose mouth has the width \p mouth and the middle (x, y).
struct Notched {
    int radius;
    float x = radius % 2 == 0 ? -0.5F : 0.0F;
    float y = -static_cast<float>(radius) * kHeight;
    Patch patch{radius};
    VertexId left = patch.nearest({x - 0.5F, y, 0});
    VertexId right = patch.nearest({x + 0.5F, y, 0});

    Network network(float mouth) const {
        Network network = patch.network();
        network.open_face(network.ring(left)[0] == right ? left : right);
        network.set_position(left, {x - mouth / 2, y, 0});
        network.set_position(right, {x + mouth / 2, y, 0});
        return network;
    }
    /// A signal that the left corner has won.
    Signals signal(float to_right, float inward, float aside = 0) const {
        return {{left, {x + to_right, y + inward * kHeight, aside}}};
    }
};

constexpr int kShort = 2;
constexpr int kLong = 7;

TEST(BoundaryFaces, FillAnAcuteNotch) {
    const Notched notched{kLong};
    Network network = notched.network(1);
    EXPECT_EQ(mend(network, false), 1);
    EXPECT_EQ(network.vertex_count(), static_cast<int>(notched.patch.positions.size()));
    EXPECT_EQ(network.face_count(), static_cast<int>(notched.patch.faces.size()));
    EXPECT_EQ(folded_faces(network), 0);
    Network wide = notched.network(2.2F);
    EXPECT_EQ(mend(wide, true), 0);
}

TEST(BoundaryFaces, FillANotchOfAShortBoundaryWhereItHasSignals) {
    const Notched notched{kShort};
    Network network = notched.network(1);
    EXPECT_EQ(mend(network, false), 0);
    EXPECT_EQ(mend(network, false, notched.signal(0, 0.8F)), 0) << "beside the notch itself";
    EXPECT_EQ(mend(network, false, notched.signal(-0.3F, 0.1F)), 0) << "beside its side";
    EXPECT_EQ(mend(network, false, notched.signal(0, -0.2F)), 0) << "beyond its mouth";
    EXPECT_EQ(mend(network, false, notched.signal(0, 0.2F, 0.6F)), 0) << "of other surface";
    EXPECT_EQ(mend(network, false, notched.signal(0, 0.2F, 0.1F)), 1);
    EXPECT_EQ(network.face_count(), static_cast<int>(notched.patch.faces.size()));
}

TEST(BoundaryFaces, JoinTheSidesOfASlit) {
    const Notched notched{kLong};
    for (const float mouth : {0.2F, -0.2F}) {  // open, and overlapping
        Network network = notched.network(mouth);
        EXPECT_EQ(mend(network, false), 0) << "no vertex may be removed";
        EXPECT_EQ(mend(network, true), 1);
        EXPECT_EQ(network.vertex_count(), static_cast<int>(notched.patch.positions.size()) - 1);
        EXPECT_EQ(network.face_count(), static_cast<int>(notched.patch.faces.size()) - 1);
        EXPECT_EQ(folded_faces(network), 0);
    }
    Network of_short = Notched{kShort}.network(0.2F);
    EXPECT_EQ(mend(of_short, true), 0);
}

TEST(BoundaryFaces, DoNotTakeASpikeForANotch) {
    Network spike = Patch().with_ear(-0.5F, -4.5F * kHeight);
    EXPECT_EQ(mend(spike, true), 0);
}

}  // namespace neuralmesh::boundary_faces_test
