// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/start/viewpoint.h"

#include <vcg/space/box3.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "vcg_core/base/disjoint_sets.h"
#include "vcg_core/base/indexed.h"
#include "vcg_core/base/logarithm.h"
#include "vcg_core/base/median.h"

namespace neuralmesh {
namespace {

using vcg::Point3f;

/// Planes that differ by less than this continue each other without doubt.
constexpr float kSureWeight = 0.1F;

/// Two points side by side and whether their normals agree.
struct Link {
    float weight;
    int a, b;
    bool opposite;
};

/// Where a surface turns evenly from \p a to \p b, the normal of b is that of a, reflected on the plane half
/// way between them. So planes around a crease, and those on the two sides of a wall, agree where they
/// should. (Koenig and Gumhold, "Consistent Propagation of Normal Orientations in Point Clouds", 2009.)
/// Ways along the surface get the lowest weights, those across a wall the highest.
Link link_of(const std::vector<Point3f>& positions, const std::vector<Point3f>& normals, int a, int b) {
    const Point3f way = positions[at(b)] - positions[at(a)];
    const float squared = std::max(way.SquaredNorm(), 1e-20F);
    const float from = normals[at(a)] * way, to = normals[at(b)] * way;
    const float agreement = (normals[at(a)] - way * (2 * from / squared)) * normals[at(b)];
    const float across = std::max(from * from, to * to) / squared;
    return {1 - std::abs(agreement) + across, a, b, agreement < 0};
}

std::vector<int> parts_of(const std::vector<Link>& links, int count) {
    DisjointSets sets(count);
    for (const Link& link : links)
        if (link.weight < kSureWeight) sets.join(link.a, link.b);
    std::vector<int> parts;
    for (int i = 0; i < count; ++i) parts.push_back(sets.find(i));
    return parts;
}

/// So many places fix the three coordinates of a sensor, and more would only cost time. The fewest fill a
/// coarse image of 8 x 8.
constexpr std::size_t kMostPlaces = 400, kFewestPlaces = 64;
/// First guesses are a quarter of the diagonal apart, up to 1.4 diagonals off the centre along each axis.
constexpr int kGuessesPerAxis = 12;
constexpr float kGuessStep = 0.25F;
constexpr std::size_t kFollowedGuesses = 16;
/// In diagonals. From further off the density of the points is even, and an origin is that of a country's
/// coordinates.
constexpr float kFarthestSensor = 4;
/// Cost beside that of even density. Frames of a range camera have 0.2 to 0.44, two stations of a scanner, an
/// aerial survey and a cloud without a sensor 0.69 to 1.
constexpr double kMostLeft = 0.5;
/// The centre of the points around a place, from the place, in radii of what is around it. At a straight edge
/// it is 4 / (3 pi) = 0.42.
constexpr float kMostAside = 0.2F;

/// A place of the surface with the logarithm of the density of its points.
struct Sample {
    Point3f position, normal;
    double density;
};

/// The place with the points on a unit of area around it; none at the edge of what is seen, where a part of
/// the area is empty, and where points repeat each other and have no density. The sphere is so wide that
/// noise hardly leaves it.
std::optional<Sample> sample_of(const NearestPoints& cloud, const SurveyedPlace& place) {
    const float reach = kSupport * place.radius;
    if (!(reach > 0)) return std::nullopt;
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
        if (!(best.cost < kMostLeft * even_)) return std::nullopt;
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
            const float cosine = std::max(std::abs(s.normal * sight) / std::sqrt(squared), kGrazing);
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
            if ((best.place - box_.Center()).Norm() > kFarthestSensor * box_.Diag()) break;
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

/// Of the area that a viewer sees, this share may be turned away: steep places under noise, and overhangs. On
/// frames and aerial scans it is 2 to 11 %; of a ball that lacks a third of its height, 25 %.
constexpr double kMostTurnedAway = 0.15;
/// Sensors of one view see no more than 120 degrees: the cosine of half of that. A cap around the origin is
/// wider.
constexpr float kHalfView = 0.5F;

/// What is turned to a viewpoint, of an area.
struct Turned {
    double front = 0;  ///< the part that is turned to it less the part that is turned away
    double all = 0;
    double cosines = 0;  ///< between the normals and the lines of sight, summed
    int points = 0;

    /// How sure its side is, in points that are seen from straight ahead, up to 1.
    float sureness() const {
        const double to_its_side = front < 0 ? -cosines : cosines;
        return static_cast<float>(std::clamp(to_its_side - static_cast<double>(kGrazing) * points, 0.0, 1.0));
    }
    bool is_single_valued() const { return std::abs(front) > (1 - 2 * kMostTurnedAway) * all; }
};

/// So far away that lines of sight are parallel but for rounding.
const Point3f kAbove(0, 0, 1e15F);
/// Lesser cosines are rounding: the sides of an upright tube are seen from nowhere.
constexpr float kInView = 1e-6F;

/// The direction from \p p to \p viewer, of length 1.
Point3f sight(const Point3f& viewer, const Point3f& p) { return (viewer - p).Normalize(); }

/// Of each part; a point stands for an area in proportion to its squared radius.
std::vector<Turned> view_from(const Point3f& viewer, const ConsolidatedPoints& points,
                              const std::vector<int>& parts) {
    std::vector<Turned> view(at(points.size()));
    for (int i = 0; i < points.size(); ++i) {
        Turned& part = view[at(parts[at(i)])];
        const auto area = static_cast<double>(points.radii[at(i)] * points.radii[at(i)]);
        const float side = points.normals[at(i)] * sight(viewer, points.positions[at(i)]);
        part.front += side > kInView ? area : side < -kInView ? -area : 0;
        part.all += area;
        part.cosines += static_cast<double>(side);
        ++part.points;
    }
    return view;
}

/// Whether a sensor at \p origin may have seen all of \p points.
bool may_be_sensor(const Point3f& origin, const std::vector<Point3f>& points) {
    vcg::Box3f box;
    for (const Point3f& p : points) box.Add(p);
    const Point3f axis = box.Center() - origin;
    if (axis.Norm() > kFarthestSensor * box.Diag()) return false;
    for (const Point3f& p : points) {
        const Point3f sight = p - origin;
        if (!(sight * axis > kHalfView * sight.Norm() * axis.Norm())) return false;
    }
    return true;
}

bool turn_to(const Point3f& viewer, const std::vector<std::pair<int, int>>& neighbours,
             const std::vector<int>& parts, ConsolidatedPoints& points) {
    const std::vector<Turned> view = view_from(viewer, points, parts);
    Turned together;
    for (const Turned& part : view) {
        together.front += std::abs(part.front);
        together.all += part.all;
    }
    if (!together.is_single_valued()) return false;
    std::vector<Point3f> sights;
    for (int i = 0; i < points.size(); ++i) {
        const Turned& part = view[at(parts[at(i)])];
        if (part.front < 0) points.normals[at(i)] = -points.normals[at(i)];
        sights.push_back(points.normals[at(i)] * (part.is_single_valued() ? part.sureness() : 0));
    }
    orient_normals(points.positions, neighbours, sights, points.normals);
    return true;
}

}  // namespace

Orientation orient_normals(const std::vector<Point3f>& positions,
                           const std::vector<std::pair<int, int>>& neighbours,
                           const std::vector<Point3f>& sights, std::vector<Point3f>& normals) {
    const int count = static_cast<int>(normals.size());
    std::vector<Link> links;
    links.reserve(neighbours.size());
    for (const auto& [a, b] : neighbours)
        links.push_back(link_of(positions, normals, std::min(a, b), std::max(a, b)));
    Orientation result;
    result.parts = parts_of(links, count);
    for (int i = 0; i < static_cast<int>(sights.size()); ++i) {
        const float front = sights[at(i)] * normals[at(i)];
        if (front != 0) links.push_back({1 - std::abs(front), i, count, front < 0});
    }
    std::sort(links.begin(), links.end(), [](const Link& x, const Link& y) {
        return std::tie(x.weight, x.a, x.b) < std::tie(y.weight, y.a, y.b);
    });
    // Sets of normals that agree; those of the points from count + 1 on are the opposite ones.
    DisjointSets sides(2 * (count + 1));
    const auto opposite = [count](int i) { return i + count + 1; };
    for (const Link& link : links) {
        const int b = link.opposite ? opposite(link.b) : link.b, not_b = link.opposite ? link.b : opposite(b);
        if (sides.find(link.a) != sides.find(not_b)) {
            sides.join(link.a, b);
            sides.join(opposite(link.a), not_b);
        } else if (link.weight < kSureWeight && link.b < count) {
            result.contradictions.push_back((positions[at(link.a)] + positions[at(link.b)]) / 2);
        }
    }
    const int front = sides.find(count), back = sides.find(opposite(count));
    for (int i = 0; i < count; ++i) {
        // Of a part that no viewer is linked to, the first normal stays.
        const int own = sides.find(i), other = sides.find(opposite(i));
        if (own == back || (own != front && other < own)) normals[at(i)] = -normals[at(i)];
    }
    return result;
}

std::optional<Point3f> sensor_place(const NearestPoints& cloud, const std::vector<SurveyedPlace>& places) {
    std::vector<Sample> samples = samples_of(cloud, places);
    if (samples.size() < kFewestPlaces) return std::nullopt;
    return SensorSearch(std::move(samples)).best();
}

bool is_above(const std::optional<Point3f>& viewer) { return viewer == kAbove; }

std::optional<Point3f> turn_to_viewer(const std::vector<std::pair<int, int>>& neighbours,
                                      const std::vector<int>& parts, const Point3f& origin,
                                      const std::optional<Point3f>& sensor, ConsolidatedPoints& points) {
    if (sensor && turn_to(*sensor, neighbours, parts, points)) return sensor;
    if (may_be_sensor(origin, points.positions) && turn_to(origin, neighbours, parts, points)) return origin;
    if (turn_to(kAbove, neighbours, parts, points)) return kAbove;
    return std::nullopt;
}

}  // namespace neuralmesh
