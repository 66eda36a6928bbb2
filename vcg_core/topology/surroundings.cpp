// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/topology/surroundings.h"

#include <algorithm>

namespace neuralmesh {
namespace {

using Box = Eigen::AlignedBox3f;

/// A signal that lies this far off the surface is not explained at all, in mean edges.
constexpr float kFar = 0.5F;
/// Faces up to here are counted, with their signals, in mean edges.
constexpr float kMargin = 3;

}  // namespace

Box box_around(const Surface& surface, const std::vector<int>& faces, float margin) {
    Box box;
    for (const int f : faces)
        for (const VertexId v : surface.faces[f]) box.extend(surface.positions[v]);
    return {box.min() - Vector3::Constant(margin), box.max() + Vector3::Constant(margin)};
}

/// The bounding boxes of the faces of a patch, and of all.
class Surroundings::PatchBoxes {
public:
    PatchBoxes(const std::vector<Triangle>& patch, const PerVertex<Vector3>& positions)
        : of_face_(patch.size()) {
        for (std::size_t p = 0; p < patch.size(); ++p) {
            for (const VertexId v : patch[p]) of_face_[p].extend(positions[v]);
            all_.extend(of_face_[p]);
        }
    }
    /// Whether a signal of a face may be nearer to the patch than to its face. \p farthest: the greatest
    /// squared distance of its signals.
    bool may_attract(const Box& face, float farthest) const {
        // Such a signal goes at most that far to its face, and less to the patch: twice the way in all.
        constexpr float kRounded = 1.01F;
        return all_.squaredExteriorDistance(face) <= 4 * kRounded * farthest;
    }
    /// Calls \p visit for the faces whose boxes are nearer to \p signal than \p squared, which it may lower.
    template <class Visit>
    void for_near(const Vector3& signal, const float& squared, const Visit& visit) const {
        const auto is_near = [&](const Box& box) { return box.squaredExteriorDistance(signal) < squared; };
        for (std::size_t p = 0; is_near(all_) && p < of_face_.size(); ++p)
            if (is_near(of_face_[p])) visit(p);
    }

private:
    std::vector<Box> of_face_;
    Box all_;
};

Surroundings::Surroundings(const Surface& surface, const FaceTree& tree, const FaceSignals& support,
                           const std::vector<int>& left_out, float edge)
    : surface_(surface), support_(support), far_(kFar * edge * kFar * edge) {
    std::vector<int> out = left_out;
    std::sort(out.begin(), out.end());
    tree.for_overlapping(box_around(surface, left_out, kMargin * edge), [&](int f) {
        if (!std::binary_search(out.begin(), out.end(), f)) kept_.push_back(f);
    });
    std::sort(kept_.begin(), kept_.end());
    for (const int f : kept_) wins_.push_back(support.wins[f]);
    std::vector<Vector3> points;
    for (const int f : left_out)
        for (const FaceSignals::Assigned& s : support.of(f)) points.push_back(s.point);
    ThreadTeam alone(1);
    const std::vector<Hit> hits = FaceTree(surface, kept_, alone).nearest(points, alone);
    auto next = hits.begin();
    for (const int f : left_out) {
        int won = support.wins[f];
        for (const FaceSignals::Assigned& s : support.of(f)) {
            const Hit& hit = *next++;
            const auto place = std::lower_bound(kept_.begin(), kept_.end(), hit.face) - kept_.begin();
            freed_.push_back({s.point, s.squared_distance, hit.foot.squared_distance,
                              hit.face < 0 ? -1 : static_cast<int>(place)});
            // At an edge that both share. A patch has it as well, and would lose the signal.
            if (hit.face < 0 || hit.foot.squared_distance > s.squared_distance) continue;
            --won;
            ++wins_[static_cast<std::size_t>(place)];
        }
        lack_ += lack(support.expected[f], won);
    }
}

double Surroundings::misfit(float squared_distance) const {
    return static_cast<double>(std::min(1.0F, squared_distance / far_));
}

double Surroundings::lack(float expected, int won) {
    return static_cast<double>(std::max(0.0F, expected - static_cast<float>(won)));
}

std::size_t Surroundings::winner(const PatchBoxes& boxes, const std::vector<Triangle>& patch,
                                 const Vector3& signal, float& least) const {
    const auto& p = surface_.positions;
    std::size_t winner = patch.size();
    boxes.for_near(signal, least, [&](std::size_t i) {
        const Triangle& face = patch[i];
        const float squared = foot_on_triangle(signal, p[face[0]], p[face[1]], p[face[2]]).squared_distance;
        if (squared >= least) return;
        least = squared;
        winner = i;
    });
    return winner;
}

float Surroundings::gain(const std::vector<Triangle>& patch) const {
    const PatchBoxes boxes(patch, surface_.positions);
    std::vector<int> won(patch.size(), 0), kept_won(kept_.size(), 0);
    double gain = lack_;
    for (std::size_t k = 0; k < kept_.size(); ++k) {
        if (!boxes.may_attract(box_around(surface_, {kept_[k]}, 0), support_.farthest[kept_[k]])) continue;
        for (const FaceSignals::Assigned& s : support_.of(kept_[k])) {
            float least = s.squared_distance;
            const std::size_t face = winner(boxes, patch, s.point, least);
            if (face == patch.size()) continue;
            ++won[face];
            --kept_won[k];
            gain += misfit(s.squared_distance) - misfit(least);
        }
    }
    for (const Freed& signal : freed_) {
        float least = signal.squared_distance_of_kept;
        const std::size_t face = winner(boxes, patch, signal.point, least);
        if (face < patch.size()) {
            ++won[face];
        } else if (signal.kept >= 0) {
            ++kept_won[static_cast<std::size_t>(signal.kept)];
        }
        gain += misfit(signal.squared_distance) - misfit(least);
    }
    for (std::size_t k = 0; k < kept_.size(); ++k) {
        const float expected = support_.expected[kept_[k]];
        gain += lack(expected, wins_[k]) - lack(expected, support_.wins[kept_[k]] + kept_won[k]);
    }
    for (std::size_t i = 0; i < patch.size(); ++i) {
        const float area = area_vector(patch[i], surface_.positions).norm() / 2;
        gain -= lack(support_.expected_on(patch[i], area), won[i]);
    }
    return static_cast<float>(gain);
}

}  // namespace neuralmesh
