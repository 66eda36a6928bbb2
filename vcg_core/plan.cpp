// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

#include "vcg_core/plan.h"

#include <algorithm>

#include "vcg_core/base/ablation.h"

namespace neuralmesh {
namespace {

/// Beyond a million vertices the fit inserts up to this many times those that it finds. A number that is a
/// slip of the pen, 20 million from 500 points, would take all memory at once; learning takes its time and
/// can be cancelled.
constexpr std::size_t kMillion = 1000000, kMostPerCarried = 64;

/// From 1 up to \p first down to 0 from \p last on.
double falling(double x, double first, double last) {
    return std::clamp((last - x) / (last - first), 0.0, 1.0);
}

double between(double low, double high, double share) { return low + share * (high - low); }

/// Both layers of a sheet have all of its points.
std::size_t carried_by_points(const Circumstances& given) {
    return given.carried_by_points * (given.encloses_space ? 1 : 2);
}

/// Whether the fit inserts the vertices that the points do not carry: if it may redistribute vertices, and
/// only their number ends growth.
bool fills_up(const Circumstances& given) {
    const auto wanted = static_cast<std::size_t>(given.vertices);
    const bool slip = wanted > kMillion && wanted / kMostPerCarried > carried_by_points(given);
    return given.redistributes && !given.exact && !slip && !skips("refine");
}

/// How far shape may choose what goes, in [0, 1]: not on open surfaces, not of points drawn from faces, which
/// need not bound a solid (a fin on a ball would have 1.6 times the error), and not where a tenth to a fifth
/// of the points were outliers, of which some are left beside the surface.
double trust_in_shape(const Circumstances& given) {
    if (skips("volume_reduction") || given.exact || !given.closed) return 0;
    return falling(given.outliers, 0.1, 0.2);
}

/// Noise in edges that is small beside them: clean clouds come to .005 to .02. Up to .1 genus3 of 10,000,
/// with noise of .1 % of the diagonal, would have 1.14 times the error in 1.65 times the time.
double calmness(const Circumstances& given) { return falling(given.noise, 0.04, 0.06); }

/// The share of the noisy surplus. With noise, 5,000 vertices gain nothing from one in 1.4 times the time,
/// and 1,000 may have twice the error where it is 2 % of the diagonal (.45 edges).
double noisy_share(const Circumstances& given, int vertices) {
    return falling(given.noise, 0.15, 0.2) * falling(vertices, 2000, 5000);
}

/// Points for each learned vertex. With 4 of them sharp edges of small meshes are doubled and corners cut
/// off: 5 of 16 cubes of 400 and 600 vertices then have more than 12 crease lines. From 2,000 vertices on 3
/// do, if they are calm.
double points_per_learned(int vertices, double calm) {
    return between(10, 3, calm * (1 - falling(vertices, 1000, 2000)));
}

/// Calm: with 2,500, 500 vertices would have 1.1 times the error, with 5,000, 2,000 would; a preview of 1,000
/// has to come at once. With noise of .6 % of the diagonal and 10,000, 5,000 vertices would have 1.1 times
/// the error.
double surplus(const Circumstances& given, int vertices, double trust, double calm) {
    constexpr double kLeast = 4000, kMost = 10000;  // of calm surfaces, from 2,000 and up to 1,250 vertices
    const double usual = usual_surplus(vertices);
    const double noisy = between(usual, std::max(usual, kLeast), noisy_share(given, vertices));
    const double of_calm = between(kMost, kLeast, falling(vertices, 1250, 2000));
    return between(usual, between(noisy, of_calm, calm), trust);
}

/// What a preview saves on the signals of the vertices that go. Of 2,000 and more, accuracy is wanted: with
/// .58 of the signals fandisk of 2,000 has 1.08 times the error, and 1.16 with noise of .1 % of the diagonal;
/// with .75 of them it has 1.06 with 10,000.
double hurry(int vertices) { return 0.6 * falling(vertices, 1000, 2000); }

}  // namespace

int usual_surplus(int vertices) {
    constexpr int kSurplus = 2500;  // falls to none at 5,000 vertices
    return std::max(0, std::min(3 * vertices, kSurplus - vertices / 2));
}

Plan plan_for(const Circumstances& given) {
    Plan plan;
    plan.fills_up = fills_up(given);
    const std::size_t placed =
        std::max(carried_by_points(given), static_cast<std::size_t>(given.start_vertices));
    plan.carried = plan.fills_up
                       ? static_cast<int>(std::min(placed, static_cast<std::size_t>(given.vertices)))
                       : given.vertices;
    plan.grow_to = std::max(plan.carried, given.start_vertices);
    if (!given.redistributes || !given.encloses_space) return plan;
    const double trust = trust_in_shape(given), calm = trust * calmness(given);
    plan.by_volume = calm > 0 || trust * noisy_share(given, plan.carried) > 0;
    const double learned = plan.carried + surplus(given, plan.carried, trust, calm);
    const double supported = static_cast<double>(given.points) / points_per_learned(plan.carried, calm);
    // Growth removes the vertices that the landing leaves without signals, far off.
    const int least = given.start_vertices >= plan.carried ? given.start_vertices + given.start_vertices / 4
                                                           : given.start_vertices;
    plan.grow_to = std::max(
        {plan.carried, least, static_cast<int>(given.exact ? learned : std::min(learned, supported))});
    const double kept = static_cast<double>(plan.carried) / plan.grow_to;
    // Half of the signals where most vertices stay: with more the network follows the noise.
    if (!skips("settling_surplus")) plan.settling_share = std::min(kept, 0.5);
    const double noisy = given.closed && !given.exact ? 1 - falling(given.noise, 0.1, 0.15) : 0;
    if (skips("brief_learning")) return plan;
    plan.growth_share = std::max(0.5, (1 - hurry(plan.carried) * (1 - kept)) * between(1, 0.5, noisy));
    return plan;
}

}  // namespace neuralmesh
