// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/sensor_place.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>

#include "vcg_core/base/logarithm.h"
#include "vcg_core/base/median.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// So many places fix the three coordinates of a sensor, and more would only cost time. The fewest fill a
/// coarse image of 8 x 8.
constexpr std::size_t kMostPlaces = 400, kFewestPlaces = 64;
/// First guesses are a quarter of the diagonal apart, up to 1.4 diagonals off the centre along each axis.
constexpr int kGuessesPerAxis = 12;
constexpr float kGuessStep = 0.25F;
constexpr std::size_t kFollowedGuesses = 16;
/// In diagonals. From further off the density of the points is even.
constexpr float kFarthestGuess = 4;
/// Cost beside that of even density. Frames of a range camera have 0.2 to 0.44, two stations of a scanner, an
/// aerial survey and a cloud without a sensor 0.69 to 1.
constexpr double kMostLeft = 0.5;
/// The centre of the points around a place, from the place, in radii of what is around it. At a straight edge
/// it is 4 / (3 pi) = 0.42.
constexpr float kMostAside = 0.2F;
/// Grazing sight: noise of the normals hides smaller cosines.
constexpr float kGrazingCosine = 0.05F;

/// A place of the surface with the logarithm of the density of its points.
struct Sample {
    Point3f position, normal;
    double density;
};

/// The place with the points on a unit of area around it; none at the edge of what is seen, where a part of
/// the area is empty. The sphere is so wide that noise hardly leaves it.
std::optional<Sample> sample_of(const NearestPoints& cloud, const SurveyedPlace& place) {
    const float reach = kSupport * place.radius;
    int count = 0;
    Point3f sum(0, 0, 0);
    cloud.any_within(place.position, reach, [&](NearestPoints::Place other) {
        ++count;
        sum += cloud.point(other) - place.position;
        return false;
    });
    if (sum.Norm() > kMostAside * reach * static_cast<float>(count)) return std::nullopt;
    return Sample{place.position, place.normal,
                  portable_log(static_cast<double>(count) / static_cast<double>(reach * reach))};
}

std::vector<Sample> samples_of(const NearestPoints& cloud, const std::vector<SurveyedPlace>& places) {
    std::vector<Sample> samples;
    const std::size_t step = places.size() / kMostPlaces + 1;
    for (std::size_t i = 0; i < places.size(); i += step) {
        if (places[i].clutter) continue;
        if (const std::optional<Sample> sample = sample_of(cloud, places[i])) samples.push_back(*sample);
    }
    return samples;
}

double mean_deviation(const std::vector<double>& values) {
    const double middle = median(values);
    double sum = 0;
    for (const double v : values) sum += std::abs(v - middle);
    return sum / static_cast<double>(values.size());
}

/// Looks for the sensor by descent from many guesses.
class SensorSearch {
public:
    explicit SensorSearch(std::vector<Sample> samples) : samples_(std::move(samples)) {
        for (const Sample& s : samples_) {
            box_.Add(s.position);
            left_.push_back(s.density);
        }
        even_ = mean_deviation(left_);
    }
    std::optional<Point3f> best() {
        Guess best{even_, {}};
        for (const Guess& guess : guesses()) best = std::min(best, descent(guess), cheaper);
        if (best.cost > kMostLeft * even_) return std::nullopt;
        return best.place;
    }

private:
    struct Guess {
        double cost;
        Point3f place;
    };
    static bool cheaper(const Guess& a, const Guess& b) { return a.cost < b.cost; }

    Guess guess_at(const Point3f& sensor) {
        left_.clear();
        for (const Sample& s : samples_) {
            const Point3f sight = sensor - s.position;
            const float squared = std::max(sight.SquaredNorm(), 1e-12F);
            const float cosine = std::max(std::abs(s.normal * sight) / std::sqrt(squared), kGrazingCosine);
            left_.push_back(s.density - portable_log(static_cast<double>(cosine / squared)));
        }
        return {mean_deviation(left_), sensor};
    }
    std::vector<Guess> guesses() {
        std::vector<Guess> all;
        const float step = kGuessStep * box_.Diag();
        for (int i = 0; i < kGuessesPerAxis * kGuessesPerAxis * kGuessesPerAxis; ++i) {
            const auto along = [&](int k) {
                return (static_cast<float>(k % kGuessesPerAxis) - (kGuessesPerAxis - 1) / 2.0F) * step;
            };
            all.push_back(guess_at(box_.Center() + Point3f(along(i), along(i / kGuessesPerAxis),
                                                           along(i / kGuessesPerAxis / kGuessesPerAxis))));
        }
        std::stable_sort(all.begin(), all.end(), cheaper);
        all.resize(kFollowedGuesses);
        return all;
    }
    Guess descent(Guess guess) {
        for (float step = box_.Diag() / 8; step > box_.Diag() / 400;) {
            Guess best = guess;
            for (int way = 0; way < 6; ++way) {
                Point3f place = guess.place;
                place[way / 2] += way % 2 == 0 ? step : -step;
                best = std::min(best, guess_at(place), cheaper);
            }
            if ((best.place - box_.Center()).Norm() > kFarthestGuess * box_.Diag()) break;
            if (best.cost < guess.cost)
                guess = best;
            else
                step /= 2;
        }
        return guess;
    }

    std::vector<Sample> samples_;
    vcg::Box3f box_;
    double even_ = 0;
    std::vector<double> left_;
};

}  // namespace

std::optional<Point3f> sensor_place(const NearestPoints& cloud, const std::vector<SurveyedPlace>& places) {
    std::vector<Sample> samples = samples_of(cloud, places);
    if (samples.size() < kFewestPlaces) return std::nullopt;
    return SensorSearch(std::move(samples)).best();
}

}  // namespace neuralmesh
