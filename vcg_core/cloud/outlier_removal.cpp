// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/cloud/outlier_removal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "vcg_core/base/ablation.h"
#include "vcg_core/base/logarithm.h"
#include "vcg_core/base/median.h"
#include "vcg_core/base/parallel_for.h"
#include "vcg_core/cloud/isolated_groups.h"

namespace neuralmesh {
namespace {

using Place = NearestPoints::Place;
using Neighbours = std::vector<NearestPoints::Neighbour>;

/// The neighbours that a point is told from, on two scales; outlier_removal.h says how its thresholds were
/// found.
constexpr int kWideCount = 48, kNarrowCount = 16;
constexpr float kSparse = 2;   ///< suspects are sparser than usual by this factor
constexpr Place kWindow = 64;  ///< places to each side that are looked at before a search
constexpr int kChunk = 1024;
constexpr float kMostRatio = 100;  ///< of spacings: neighbours may coincide

/// The places of suspects and what is known of them.
class Suspects {
public:
    Suspects(const CloudSurvey& survey, ThreadTeam& team) : cloud_(survey.cloud), team_(team) {
        note_spacings(survey);
        find();
        if (suspects_.empty()) return;
        measure();
        combine();
    }

    /// Sets \p out for suspects with enough evidence against them.
    void mark(std::vector<std::uint8_t>& out) const {
        if (suspects_.empty()) return;
        const double limit = threshold();
        for (std::size_t i = 0; i < suspects_.size(); ++i)
            if (evidence_[i] > limit) out[suspects_[i].place] = 1;
        const auto marked = static_cast<double>(std::count(out.begin(), out.end(), 1));
        if (marked <= kFew * static_cast<double>(cloud_.size()) || skips("lifted_points")) return;
        for (const Place p : lifted()) out[p] = 1;
    }

private:
    struct Suspect {
        Place place;
        float spacing;
    };
    static constexpr double kFew = 0.002;  ///< of the points
    static constexpr Place kNobody = static_cast<Place>(-1);

    void note_spacings(const CloudSurvey& survey);
    void find();
    std::vector<Place> lifted() const;
    bool has_close_neighbours(Place place, float radius) const;
    void measure();
    double evidence_alone(std::size_t suspect) const;
    void combine();
    double threshold() const;

    Place neighbour(std::size_t suspect, int rank) const {
        return neighbours_[suspect * kWideCount + static_cast<std::size_t>(rank)];
    }
    /// The spacing at \p place: its own if it is a suspect, else that around it.
    float spacing_at(Place place) const {
        const Place suspect = rank_[place];
        return suspect == kNobody ? around_[place / CloudSurvey::kRun] : suspects_[suspect].spacing;
    }

    const NearestPoints& cloud_;
    ThreadTeam& team_;
    std::vector<float> around_;             ///< median spacing around each sample
    float of_all_ = 0;                      ///< median spacing of the cloud
    std::vector<Suspect> suspects_;         ///< by ascending place
    std::vector<Place> rank_;               ///< of each place among the suspects, or kNobody
    std::vector<Place> neighbours_;         ///< kWideCount for each suspect, nearest first
    std::vector<std::uint8_t> in_plane_;    ///< 1 for suspects in the plane of their neighbours
    std::vector<double> narrow_, wide_;     ///< surface variations
    std::vector<double> evidence_;
};

/// The median spacing of the cloud, and that around each of its samples.
void Suspects::note_spacings(const CloudSurvey& survey) {
    std::vector<float> samples;
    for (const float squared : survey.squared_spacings) samples.push_back(std::sqrt(squared));
    of_all_ = median(samples);
    around_ = running_median(samples);
}

/// Are there CloudSurvey::kNeighbour points within \p radius, among those of nearby places? True for nearly
/// all points of a surface, at a small part of what a search costs.
bool Suspects::has_close_neighbours(Place place, float radius) const {
    const vcg::Point3f& centre = cloud_.point(place);
    const float limit = radius * radius;
    int close = 0;
    for (Place d = 1; d <= kWindow; ++d) {
        if (place >= d) close += (cloud_.point(place - d) - centre).SquaredNorm() <= limit ? 1 : 0;
        if (place + d < cloud_.size())
            close += (cloud_.point(place + d) - centre).SquaredNorm() <= limit ? 1 : 0;
        if (close >= CloudSurvey::kNeighbour) return true;
    }
    return false;
}

void Suspects::find() {
    suspects_ = parallel_collect<Suspect>(
        static_cast<int>(cloud_.size()), kChunk, team_, [&](int i, std::vector<Suspect>& found) {
            const auto place = static_cast<Place>(i);
            const float radius = kSparse * std::min(of_all_, around_[place / CloudSurvey::kRun]);
            if (has_close_neighbours(place, radius)) return;
            Neighbours near;
            cloud_.nearest(place, CloudSurvey::kNeighbour, near);
            const float own = std::sqrt(near.back().squared_distance);
            if (own > radius) found.push_back({place, own});
        });
}

/// In a cloud with hardly any outliers they are part of the surface more often than not.
std::vector<Place> Suspects::lifted() const {
    constexpr float kSparser = 1.35F;  // than usual, by this factor
    constexpr double kSpacing = 1.78;  // that of even points on a plane in distances to the tenth neighbour
    // From the plane of its neighbours so many times as far as these are, or as .3 spacings.
    constexpr double kLeast = 0.3, kLifted = 4;
    return parallel_collect<Place>(
        static_cast<int>(cloud_.size()), kChunk, team_, [&](int i, std::vector<Place>& found) {
            const auto place = static_cast<Place>(i);
            const float usual = std::min(of_all_, around_[place / CloudSurvey::kRun]);
            if (has_close_neighbours(place, kSparser * usual)) return;
            Neighbours near;
            cloud_.nearest(place, kNarrowCount, near);
            if (std::sqrt(near[CloudSurvey::kNeighbour - 1].squared_distance) <= kSparser * usual) return;
            std::vector<Place> places;
            for (const NearestPoints::Neighbour& n : near) places.push_back(n.place);
            const double least = kLeast * static_cast<double>(usual) / kSpacing;
            const Extent around(cloud_, places);
            const double spread = std::sqrt(around.thickness() * around.thickness() + least * least);
            if (around.is_plane() && around.height(cloud_.point(place)) / spread > kLifted)
                found.push_back(place);
        });
}

void Suspects::measure() {
    constexpr double kContinues = 0.35;  // sine of the angle between a plane and the way to a point of it
    rank_.assign(cloud_.size(), kNobody);
    for (std::size_t i = 0; i < suspects_.size(); ++i) rank_[suspects_[i].place] = static_cast<Place>(i);
    neighbours_.resize(suspects_.size() * kWideCount);
    in_plane_.resize(suspects_.size());
    narrow_.resize(suspects_.size());
    wide_.resize(suspects_.size());
    parallel_for(static_cast<int>(suspects_.size()), kChunk / 16, team_, [&](int number) {
        const auto i = static_cast<std::size_t>(number);
        Neighbours near;
        std::vector<Place> around;
        cloud_.nearest(suspects_[i].place, kWideCount, near);
        for (const NearestPoints::Neighbour& n : near) around.push_back(n.place);
        std::copy(around.begin(), around.end(),
                  neighbours_.begin() + static_cast<std::ptrdiff_t>(i * kWideCount));
        const std::vector<Place> wide = around;
        around.resize(kNarrowCount);
        const Extent neighbours(cloud_, around);
        const vcg::Point3f& own = cloud_.point(suspects_[i].place);
        in_plane_[i] =
            neighbours.is_plane() && neighbours.height(own) < kContinues * neighbours.distance(own) ? 1 : 0;
        around.push_back(suspects_[i].place);
        narrow_[i] = Extent(cloud_, around).variation();
        around.insert(around.end(), wide.begin() + kNarrowCount, wide.end());
        wide_[i] = Extent(cloud_, around).variation();
    });
}

/// The evidence against a suspect without that of the suspects around it.
double Suspects::evidence_alone(std::size_t suspect) const {
    // These weights separate, by logistic regression, outliers from points of room and building scans.
    constexpr double kFill = 37, kDensest = 1.6, kUsual = 3.5, kInPlane = -4, kOffset = -5.3;
    double narrow = narrow_[suspect], wide = wide_[suspect];
    int count = 1;
    for (int k = 0; k < CloudSurvey::kNeighbour; ++k) {
        const Place other = rank_[neighbour(suspect, k)];
        if (other == kNobody) continue;
        narrow += narrow_[other];
        wide += wide_[other];
        ++count;
    }
    std::array<float, kWideCount> spacings;
    for (int k = 0; k < kWideCount; ++k)
        spacings[static_cast<std::size_t>(k)] = spacing_at(neighbour(suspect, k));
    const float own = suspects_[suspect].spacing;
    const auto log_ratio = [own](float other) {
        return portable_log(
            static_cast<double>(std::min(kMostRatio, own / std::max(other, own / kMostRatio))));
    };
    const float usual = median<float>({spacings.begin(), spacings.begin() + CloudSurvey::kNeighbour});
    std::nth_element(spacings.begin(), spacings.begin() + kWideCount / 10, spacings.end());
    return kFill * std::min(narrow, wide) / count + kDensest * log_ratio(spacings[kWideCount / 10]) +
           kUsual * log_ratio(usual) + kInPlane * in_plane_[suspect] + kOffset;
}

/// The evidence against each suspect, with that of the suspects around it.
void Suspects::combine() {
    // Weights by logistic regression, as those of the evidence alone.
    constexpr double kOwn = 0.7, kAround = 0.5, kCompany = 2, kCompanyOffset = -1;
    std::vector<double> alone(suspects_.size());
    for (std::size_t i = 0; i < suspects_.size(); ++i) alone[i] = evidence_alone(i);
    evidence_.resize(suspects_.size());
    for (std::size_t i = 0; i < suspects_.size(); ++i) {
        double sum = 0;
        int count = 0;
        for (int k = 0; k < kWideCount; ++k) {
            const Place other = rank_[neighbour(i, k)];
            if (other == kNobody) continue;
            sum += alone[other];
            ++count;
        }
        evidence_[i] = kOwn * alone[i] + kAround * (count > 0 ? sum / count : alone[i]) +
                       kCompany * count / kWideCount + kCompanyOffset;
    }
}

/// The lowest evidence where next to none of the points lies: the gap between orderly points and outliers,
/// most of which have much evidence against them.
double Suspects::threshold() const {
    // From the lowest evidence to the strict threshold, in steps. At least half of the points beyond the gap
    // have more evidence than where orderly and wild ones mix.
    constexpr double kLowest = -2, kStrict = 3.5, kMixed = 2.5, kStep = 0.5;
    constexpr double kEmptyShare = 0.0006, kEmptyOfSuspects = 0.05;  // of the points, of the suspects
    const double empty = std::min(kEmptyShare * static_cast<double>(cloud_.size()),
                                  kEmptyOfSuspects * static_cast<double>(suspects_.size()));
    const auto count = [this](double low, double high) {
        return static_cast<double>(std::count_if(evidence_.begin(), evidence_.end(),
                                                 [&](double e) { return low <= e && e < high; }));
    };
    for (double at = kLowest; at < kStrict; at += kStep)
        if (count(at - kStep, at + kStep) <= empty && count(kMixed, HUGE_VAL) * 2 >= count(at, HUGE_VAL))
            return at;
    return kStrict;
}

}  // namespace

std::vector<std::uint8_t> find_outliers(const CloudSurvey& survey, int threads,
                                        const std::function<void()>& beat) {
    const NearestPoints& cloud = survey.cloud;
    if (cloud.size() < kFewestForOutliers) return {};
    ThreadTeam team(thread_count(threads));
    team.set_beat(beat);
    std::vector<std::uint8_t> out(cloud.size());
    Suspects(survey, team).mark(out);
    mark_isolated_clumps(cloud, out);
    if (std::find(out.begin(), out.end(), 1) == out.end()) return {};
    std::vector<std::uint8_t> result(cloud.size());
    for (Place p = 0; p < cloud.size(); ++p) result[cloud.index(p)] = out[p];
    return result;
}

}  // namespace neuralmesh
