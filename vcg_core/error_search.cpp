// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/error_search.h"

#include <algorithm>
#include <cmath>

#include "vcg_core/base/logarithm.h"

namespace neuralmesh {
namespace {

/// The first trial: as many vertices as come at once, and have the shape of most things.
constexpr int kFirst = 1000;
/// Errors from .9 to 1.05 of what is asked for are as asked: they vary by as much with the seed.
constexpr double kLeastShare = 0.9, kMostShare = 1.05, kAim = 0.97;
/// Nor do numbers of vertices that differ by less say anything.
constexpr double kSameNumber = 1.1;
/// The power law holds over a factor of so many vertices.
constexpr double kStep = 4;
/// The exponents that surfaces have; below the second the error levels off.
constexpr double kUsual = 0.8, kLevel = 0.1, kSteepest = 1.5, kFlattest = 0.35;
/// The exponent falls with the vertices, as what is left is creases and noise.
constexpr double kFalls = 0.85;
constexpr std::size_t kMostTrials = 8;

/// \p ratio to the power \p exponent, at least 1 / kStep and at most kStep. By bisection, because the last
/// bits of std::pow depend on the C library.
double step_of(double ratio, double exponent) {
    constexpr int kBits = 50;  // of the 53 of a double
    if (!(ratio > 0)) return 1 / kStep;
    const double wanted = exponent * portable_log(ratio);
    double low = 1 / kStep, high = kStep;
    for (int bit = 0; bit < kBits; ++bit) {
        const double middle = (low + high) / 2;
        (portable_log(middle) < wanted ? low : high) = middle;
    }
    return high;
}

}  // namespace

void ErrorSearch::add(int vertices, double error) {
    const auto after = std::find_if(trials_.begin(), trials_.end(),
                                    [&](const Trial& trial) { return trial.vertices > vertices; });
    trials_.insert(after, {vertices, error});
}

bool ErrorSearch::is_enough(const Trial& trial) const { return trial.error <= kMostShare * wanted_; }

std::size_t ErrorSearch::enough() const {
    const auto first =
        std::find_if(trials_.begin(), trials_.end(), [this](const Trial& trial) { return is_enough(trial); });
    return static_cast<std::size_t>(first - trials_.begin());
}

double ErrorSearch::exponent(const Trial& a, const Trial& b) {
    constexpr double kTiny = 1e-300;
    return portable_log(std::max(a.error, kTiny) / std::max(b.error, kTiny)) /
           portable_log(static_cast<double>(b.vertices) / a.vertices);
}

bool ErrorSearch::levels_off() const {
    if (reached() || trials_.size() < 2) return false;
    return exponent(trials_[trials_.size() - 2], trials_.back()) < kLevel;
}

ErrorSearch::Trial ErrorSearch::best() const {
    if (reached()) return trials_[enough()];
    double least = trials_.front().error;
    for (const Trial& trial : trials_) least = std::min(least, trial.error);
    return *std::find_if(trials_.begin(), trials_.end(),
                         [&](const Trial& trial) { return trial.error <= kMostShare * least; });
}

int ErrorSearch::extrapolated(const Trial& from, double exponent, int low, int high) const {
    const double vertices = from.vertices * step_of(from.error / (kAim * wanted_), 1 / exponent);
    return std::clamp(static_cast<int>(std::lround(vertices)), low, high);
}

int ErrorSearch::next() const {
    if (least_ > most_ || trials_.size() == kMostTrials) return 0;
    if (trials_.empty()) return std::clamp(kFirst, least_, most_);
    const std::size_t fine = enough(), count = trials_.size();
    const auto usual = [](double p) { return std::clamp(p, kFlattest, kSteepest); };
    if (fine == count) {
        const Trial& last = trials_.back();
        if (last.vertices == most_ || levels_off()) return 0;
        const double p = count < 2 ? kUsual : kFalls * exponent(trials_[count - 2], last);
        return extrapolated(last, usual(p), last.vertices + 1, most_);
    }
    const Trial& found = trials_[fine];
    if (found.error >= kLeastShare * wanted_) return 0;
    const double least = fine == 0 ? least_ : kSameNumber * trials_[fine - 1].vertices;
    if (found.vertices <= kSameNumber * least) return 0;
    const double p = fine > 0    ? exponent(trials_[fine - 1], found)
                     : count < 2 ? kUsual
                                 : (exponent(found, trials_[1]) + kUsual) / 2;
    const int low = static_cast<int>(std::ceil(least)), high = static_cast<int>(found.vertices / kSameNumber);
    const int next = extrapolated(found, usual(p), low, high);
    // The error jumps there.
    return fine > 0 && next == low ? static_cast<int>(std::sqrt(least * high)) : next;
}

}  // namespace neuralmesh
