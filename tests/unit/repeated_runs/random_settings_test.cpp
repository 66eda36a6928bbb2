// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Every parameter at the ends of its range, and random settings on random clouds: no crash, a sound mesh,
// and no more signals than the settings allow. NEURALMESH_RANDOM_RUNS=500 makes 500 runs instead of 12;
// NEURALMESH_RANDOM_FIRST=N starts with run N, to repeat a failure.
#include "tests/unit/support/runs.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learning/learner.h"

namespace neuralmesh::random_settings_test {

using Kind = SettingInfo::Kind;

/// Calls until a run is stopped, because some settings take billions of signals. Learning makes one per
/// thousand.
constexpr int kPatience = 400;

/// Upper bound on the signals of one growth with landing and settling.
std::int64_t most_of_growth(const TargetSpace& target, const Settings& settings) {
    const Learner learner(target, learner_options_from(settings), network_of(shapes::tetrahedron()));
    const std::int64_t vertices = settings.target_vertices;
    const auto learning = [&](std::int64_t per_vertex) {
        return std::max<std::int64_t>(60000, per_vertex * vertices);
    };
    return learning(100) + learner.signal_bound() + learning(settings.settling_signals_per_vertex);
}

/// Upper bound on the signals of a run: it grows to at most four times the vertices asked for and, if that
/// growth stalls, grows once more.
std::int64_t most_signals(const TargetSpace& target, const Settings& settings) {
    Settings more = settings;
    more.target_vertices *= 4;
    return most_of_growth(target, more) + most_of_growth(target, settings);
}

/// No vertex is far from the points, and Network::validate() agrees with the referee.
void expect_near_the_points(const NeuralMesh& mesh, const TargetSpace& target) {
    vcg::Box3f box;
    for (const vcg::Point3f& p : target.positions()) box.Add(p);
    // The diagonal of the box is 1. The radius of a shell around few points is about that of the box, and
    // vertices that never win stay where the shell put them.
    const std::optional<TargetSpace> once = target.each_place_once();
    const double limit = (once ? *once : target).positions().size() < 20 ? 1.5 : 1;
    std::vector<vcg::Point3f> positions;
    for (const vcg::Point3d& p : mesh.positions) {
        positions.push_back(target.frame().inside(p));
        ASSERT_LT((positions.back() - box.Center()).Norm(), limit);
    }
    EXPECT_EQ(Network(positions, mesh.faces).validate(), "");
}

/// A tetrahedron in the middle of the points, for the settings that need a start mesh of the caller's.
IndexedMesh<double> start_for(const TargetSpace& target) {
    const Shape shape = shapes::tetrahedron();
    IndexedMesh<double> start{{}, shape.faces};
    for (const vcg::Point3d& p : shape.positions)
        start.positions.push_back(target.frame().outside(vcg::Point3f::Construct(p) * 0.2F));
    return start;
}

void expect_valid_result(const TargetSpace& target, const Settings& settings) {
    Watch patience(kPatience);
    const NeuralMesh mesh = reconstruct(target, settings, patience, start_for(target));
    expect_sound(mesh);
    expect_near_the_points(mesh, target);
    EXPECT_LE(mesh.report.signals, most_signals(target, settings));
    EXPECT_LE(mesh.report.vertices, settings.target_vertices);
    if (mesh.report.stop_reason == StopReason::target_reached) {
        if (settings.target_error == 0) {
            EXPECT_EQ(mesh.report.vertices, settings.target_vertices);
        }
    } else if (mesh.report.stop_reason == StopReason::converged) {
        EXPECT_GT(settings.stop_below_mean_counter, 0);
    } else {
        EXPECT_EQ(mesh.report.stop_reason, StopReason::cancelled);
        EXPECT_TRUE(patience.stopped());
    }
}

TEST(RandomSettings, EveryParameterWorksAtBothEndsOfItsRange) {
    const TargetSpace target = target_of(shapes::sphere_cloud(500));
    for (const SettingInfo& info : setting_table())
        for (const double end : {info.low, info.high}) {
            SCOPED_TRACE(testing::Message() << info.id << " = " << end);
            Settings settings = with_target(60);
            settings.settling_signals_per_vertex = 10;
            info.store(settings, end);
            expect_valid_result(target, settings);
        }
}

/// Those that make each other worse, from the tetrahedron, where the network grows most.
TEST(RandomSettings, HostilePairsWork) {
    const TargetSpace target = target_of(shapes::torus_cloud(2000));
    const auto expect_valid = [&](const char* name, const auto& change) {
        SCOPED_TRACE(name);
        Settings settings = with_target(150, kTetrahedron);
        change(settings);
        expect_valid_result(target, settings);
    };
    expect_valid("no maturity, collapse at every chance",
                 [](Settings& s) { s.min_wins_per_split = 0, s.signals_per_collapse = 1; });
    expect_valid("split and collapse at every signal",
                 [](Settings& s) { s.signals_per_split = s.signals_per_collapse = 1; });
    expect_valid("maturity beyond reach",
                 [](Settings& s) { s.min_wins_per_split = 1000, s.signals_per_split = 1; });
    expect_valid("strongest smoothing", [](Settings& s) { s.smoothing_steps = 100, s.smoothing_rate = 1; });
    expect_valid("signal counter to the letter",
                 [](Settings& s) { s.utility_counter = kSignalCount, s.min_wins_per_split = 0; });
}

double fraction(Random& random) { return shapes::unit(random); }

/// Log-uniform between the bounds.
double log_uniform(Random& random, double low, double high) {
    const double shift = low <= 0 ? 1e-3 - low : 0;
    return std::clamp(
        std::exp(std::log(low + shift) + fraction(random) * std::log((high + shift) / (low + shift))) - shift,
        low, high);
}

/// Half of the parameters at their defaults, the others random in their ranges, a sixth of them at an end.
Settings random_settings(Random& random) {
    Settings settings;
    for (const SettingInfo& info : setting_table()) {
        if (random.below(2) == 0) continue;
        double value = log_uniform(random, info.low, info.high);
        if (info.kind == Kind::boolean || info.kind == Kind::choice)
            value = random.below(static_cast<std::uint32_t>(info.high) + 1);
        if (random.below(6) == 0) value = random.below(2) == 0 ? info.low : info.high;
        info.store(settings, value);
    }
    settings.target_vertices = static_cast<int>(log_uniform(random, 4, 400));
    // Random errors are mostly so large that a tetrahedron has them.
    if (random.below(4) != 0) settings.target_error = 0;
    if (random.below(4) != 0)
        settings.settling_signals_per_vertex = std::min(settings.settling_signals_per_vertex, 100);
    // More would only make the run slow.
    settings.smoothing_steps = std::min(settings.smoothing_steps, 30);
    return settings;
}

Cloud random_cloud(Random& random) {
    const int count = static_cast<int>(log_uniform(random, 4, 3000));
    const std::uint64_t seed = random.bits();
    const double noise = random.below(2) == 0 ? 0 : 0.1 * fraction(random);
    const auto edge = [&] { return log_uniform(random, 1e-4, 1); };
    Cloud cloud;
    switch (random.below(5)) {
        case 0: cloud = shapes::sphere_cloud(count, noise, seed); break;
        case 1: cloud = shapes::torus_cloud(count, noise, seed); break;
        case 2: cloud = shapes::box_cloud(count, {edge(), edge(), edge()}, noise, seed); break;
        case 3: cloud = shapes::plane_cloud(count, seed); break;
        default:
            for (int i = 0; i < count; ++i) cloud.push_back(shapes::in_ball(random));
            break;
    }
    const auto any = [&] { return random.below(static_cast<std::uint32_t>(cloud.size())); };
    if (random.below(4) == 0)  // many times the same points
        for (vcg::Point3d& p : cloud) p = cloud[any() % 50 % cloud.size()];
    if (random.below(4) == 0)  // gross outliers
        for (int i = 0; i < count; i += 100) cloud[any()] *= log_uniform(random, 2, 1000);
    if (random.below(4) == 0)  // a thousand times denser on one side
        for (vcg::Point3d& p : cloud)
            if (p[0] < 0 && random.below(1000) != 0) p[0] = -p[0];
    const double scale = log_uniform(random, 1e-9, 1e9);
    for (vcg::Point3d& p : cloud) p *= scale;
    return cloud;
}

/// A random cloud, or triangles of three consecutive points each.
TargetSpace random_target(Random& random) {
    const Cloud cloud = random_cloud(random);
    if (random.below(4) != 0 || cloud.size() < 6) return target_of(cloud);
    return TargetSpace::triangles(
        cloud.size() / 3, [&](std::size_t i, int k) { return cloud[3 * i + static_cast<std::size_t>(k)]; });
}

/// The parameters that differ from their defaults.
std::string changes(const Settings& settings) {
    std::ostringstream text;
    for (const SettingInfo& info : setting_table())
        if (info.value(settings) != info.value(Settings()))
            text << info.id << '=' << info.value(settings) << ' ';
    return text.str();
}

TEST(RandomSettings, GiveValidResultsOnRandomClouds) {
    const int runs = number_from("NEURALMESH_RANDOM_RUNS", 12, 1);
    const int first = number_from("NEURALMESH_RANDOM_FIRST", 0, 0);
    if (HasFailure()) return;
    int learned = 0, scattered = 0;
    for (int i = first; i < first + runs; ++i) {
        // Each has its own generator, so that a new parameter leaves the clouds as they are.
        Random random(static_cast<std::uint64_t>(i) + 1000),
            random_of_cloud(static_cast<std::uint64_t>(i) + 1);
        const Settings settings = random_settings(random);
        SCOPED_TRACE(testing::Message() << "run " << i << ": " << changes(settings));
        try {
            const TargetSpace target = random_target(random_of_cloud);
            expect_valid_result(target, settings);
            ++learned;
        } catch (const InputError& error) {
            // The points lie on a line, too few are distinct, or they fill a ball.
            const std::string sentence = error.what();
            EXPECT_EQ(sentence.back(), '.') << sentence;
            scattered += sentence.find("scattered in space") != std::string::npos ? 1 : 0;
        } catch (const SettingError& error) {
            // An open surface with its handles and boundaries needs some vertices to begin with.
            EXPECT_NE(std::string(error.what()).find("raise target_vertices"), std::string::npos)
                << error.what();
            EXPECT_NE(settings.surface, kClosedSurface);
        }
        if (HasFailure()) break;
    }
    EXPECT_GE(learned + scattered, runs * 8 / 10);  // a fifth of the clouds fill a ball
    EXPECT_GE(learned, runs * 6 / 10);
}

}  // namespace neuralmesh::random_settings_test
