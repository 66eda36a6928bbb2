// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/surroundings.h"

#include <algorithm>

#include "vcg_core/mesh/face_tree.h"

namespace neuralmesh {
namespace {

using Box = Eigen::AlignedBox3f;

/// A signal that lies this far off the surface is not explained at all, in mean edges.
constexpr float kFar = 0.5F;
/// Faces up to here are counted, with their signals, in mean edges.
constexpr float kMargin = 3;

Box grown(const Box& box, float by) {
    const Vector3 margin = Vector3::Constant(by);
    return {box.min() - margin, box.max() + margin};
}

Box box_of(const Surface& surface, int face) {
    Box box(surface.corner(face, 0));
    return box.extend(surface.corner(face, 1)).extend(surface.corner(face, 2));
}

/// The bounding boxes of the faces of a patch, of every few of them, which are near each other, and of all.
class PatchBoxes {
public:
    PatchBoxes(const std::vector<Triangle>& patch, const PerVertex<Vector3>& positions)
        : of_face_(patch.size()), of_group_((patch.size() + kGroup - 1) / kGroup) {
        for (std::size_t p = 0; p < patch.size(); ++p) {
            for (const VertexId v : patch[p]) of_face_[p].extend(positions[v]);
            of_group_[p / kGroup].extend(of_face_[p]);
            all_.extend(of_face_[p]);
        }
    }
    /// Calls \p visit for the faces whose boxes are nearer to \p signal than \p squared, which it may lower.
    template <class Visit>
    void for_near(const Vector3& signal, const float& squared, const Visit& visit) const {
        const auto is_near = [&](const Box& box) { return box.squaredExteriorDistance(signal) < squared; };
        if (!is_near(all_)) return;
        for (std::size_t group = 0; group < of_group_.size(); ++group) {
            if (!is_near(of_group_[group])) continue;
            const std::size_t end = std::min((group + 1) * kGroup, of_face_.size());
            for (std::size_t p = group * kGroup; p < end; ++p)
                if (is_near(of_face_[p])) visit(p);
        }
    }

private:
    static constexpr std::size_t kGroup = 8;
    std::vector<Box> of_face_, of_group_;
    Box all_;
};

}  // namespace

Surroundings::Surroundings(const Surface& surface, const FaceSignals& support,
                           const std::vector<int>& left_out, float edge)
    : surface_(surface), support_(support), far_(kFar * edge * kFar * edge) {
    Box box;
    PerFace<char> out(surface.face_count(), 0);
    for (const int f : left_out) {
        out[f] = 1;
        box.extend(box_of(surface, f));
    }
    const Box near = grown(box, kMargin * edge);
    PerFace<int> place(surface.face_count(), -1);
    for (int f = 0; f < surface.face_count(); ++f) {
        if (out[f] != 0 || !box_of(surface, f).intersects(near)) continue;
        place[f] = static_cast<int>(kept_.size());
        kept_.push_back(f);
        for (const FaceSignals::Assigned& s : support.of(f))
            signals_.push_back({s.point, s.squared_distance, place[f]});
    }
    const FaceTree tree(surface, kept_);
    for (const int f : left_out)
        for (const FaceSignals::Assigned& s : support.of(f)) {
            const Hit hit = tree.nearest(s.point);
            signals_.push_back({s.point, hit.foot.squared_distance, hit.face < 0 ? -1 : place[hit.face]});
        }
}

float Surroundings::squared_distance(const Vector3& signal, const Triangle& face) const {
    const auto& p = surface_.positions;
    return foot_on_triangle(signal, p[face[0]], p[face[1]], p[face[2]]).squared_distance;
}

float Surroundings::expected(const Triangle& face) const {
    return support_.expected_on(face, area_vector(face, surface_.positions).norm() / 2);
}

float Surroundings::cost(const std::vector<Triangle>& patch) const {
    const PatchBoxes boxes(patch, surface_.positions);
    std::vector<float> wins(kept_.size(), 0.0F), patch_wins(patch.size(), 0.0F);
    double cost = 0;
    for (const Near& signal : signals_) {
        float least = signal.squared_distance;
        std::size_t winner = patch.size();
        boxes.for_near(signal.point, least, [&](std::size_t p) {
            const float squared = squared_distance(signal.point, patch[p]);
            if (squared >= least) return;
            least = squared;
            winner = p;
        });
        if (winner < patch.size()) {
            ++patch_wins[winner];
        } else if (signal.kept >= 0) {
            ++wins[static_cast<std::size_t>(signal.kept)];
        }
        cost += static_cast<double>(std::min(1.0F, least / far_));
    }
    const auto lacks = [&](float expects, float won) {
        cost += static_cast<double>(std::max(0.0F, expects - won));
    };
    for (std::size_t k = 0; k < kept_.size(); ++k) lacks(support_.expected[kept_[k]], wins[k]);
    for (std::size_t p = 0; p < patch.size(); ++p) lacks(expected(patch[p]), patch_wins[p]);
    return static_cast<float>(cost);
}

}  // namespace neuralmesh
