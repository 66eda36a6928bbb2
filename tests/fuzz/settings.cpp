// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Arbitrary values of all parameters: check() throws SettingError, or the learning ends with the target
// reached, within signal_bound(), or when it is cancelled.
#include "vcg_core/settings.h"

#include <cmath>

#include "bytes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learning/learner.h"

namespace {

using namespace neuralmesh;
using fuzz::Bytes;
using fuzz::expect;

constexpr int kMostReports = 12;  ///< of about a thousand signals each; then the run is cancelled
/// Runs whose seed is a multiple of kPatientSeeds continue to signal_bound(), if that is at most
/// kPatientBound.
constexpr int kPatientSeeds = 16;
constexpr std::int64_t kPatientBound = 150000;
constexpr int kPatientSweeps = 10;
/// Limits the memory of a run, which is allocated for target_vertices at its start.
constexpr int kMostVertices = 20000;
constexpr int kLargestWindow = 5000;

double value_for(const SettingInfo& info, Bytes& bytes) {
    switch (bytes.below(8)) {
        case 0: return bytes.raw<double>();
        case 1: return info.low;
        case 2: return info.high;
        case 3:
            return bytes.flag() ? std::nextafter(info.low, -HUGE_VAL) : std::nextafter(info.high, HUGE_VAL);
        case 4: return bytes.raw<std::int32_t>();
        case 5: return info.low + (info.high - info.low) * bytes.byte() / 255;
        default: return info.low + bytes.byte();
    }
}

/// True if the table allows \p value, rounded for integer parameters.
bool in_range(const SettingInfo& info, double value) {
    if (info.kind == SettingInfo::Kind::boolean) return true;
    const bool real = std::holds_alternative<double Settings::*>(info.member);
    const double stored = real ? value : std::round(value);
    return stored >= info.low && stored <= info.high;
}

Settings settings_of(Bytes& bytes, bool& sound) {
    Settings settings;
    settings.target_vertices = 20;
    settings.signals_per_split = 10;
    settings.min_wins_per_split = 3;
    settings.normalization_window = 100;
    settings.settling_signals_per_vertex = 0;
    while (bytes.left() > 0) {
        const SettingInfo& info =
            setting_table()[static_cast<std::size_t>(bytes.below(static_cast<int>(setting_table().size())))];
        const double value = value_for(info, bytes);
        info.store(settings, value);
        // Stops here, as a later value could replace this bad one.
        if (in_range(info, value)) continue;
        sound = false;
        break;
    }
    return settings;
}

class Impatient : public Progress {
public:
    explicit Impatient(bool ever) : ever_(ever) {}
    bool operator()(double fraction, const char* text) override {
        expect(fraction >= 0 && fraction <= 1 && text != nullptr, "progress is no fraction");
        expect(!stopped, "progress was reported after the run had been cancelled");
        stopped = ever_ && ++reports_ >= kMostReports;
        return !stopped;
    }
    bool stopped = false;

private:
    bool ever_;
    int reports_ = 0;
};

bool waits_for_the_bound(const Settings& settings, std::int64_t bound) {
    return settings.random_seed % kPatientSeeds == 0 && bound <= kPatientBound &&
           settings.settling_signals_per_vertex == 0 && settings.smoothing_steps <= kPatientSweeps;
}

void run(const Settings& settings) {
    static const TargetSpace target = targets::target_of(shapes::sphere_cloud(300, 0.02));
    constexpr float kA = 0.1F;
    Learner learner(target, learner_options_from(settings),
                    Network({{kA, kA, kA}, {-kA, -kA, kA}, {-kA, kA, -kA}, {kA, -kA, -kA}},
                            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
    Impatient progress(!waits_for_the_bound(settings, learner.signal_bound()));
    const StopReason reason = learner.run(0, progress);
    const Network& network = learner.network();
    const std::string breach = network.validate();
    if (!breach.empty()) fuzz::fail(breach);
    expect((reason == StopReason::cancelled) == progress.stopped, "stop reason and cancellation disagree");
    expect(reason != StopReason::target_reached || network.vertex_count() == settings.target_vertices,
           "not target_vertices vertices");
    expect(reason != StopReason::converged || settings.stop_below_mean_counter > 0, "converged to nothing");
    expect(network.vertex_count() <= settings.target_vertices, "more than target_vertices vertices");
    const std::int64_t settling = settings.settling_signals_per_vertex == 0 ? 0 : 60000;
    expect(learner.signals() <=
               learner.signal_bound() + settling +
                   std::int64_t{settings.settling_signals_per_vertex} * settings.target_vertices,
           "more signals than the bound");
    for (const VertexId v : network.vertices())
        expect(learner.feature_counters().value(v) >= 0, "a counter is below 0 or NaN");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    bool sound = true;
    Settings settings = settings_of(bytes, sound);
    try {
        settings.check();
        expect(sound, "check() accepted a value that is out of its range");
    } catch (const SettingError& error) {
        fuzz::expect_sentence(error.what());
        expect(!sound, "check() refused values that are all in their ranges");
        return 0;
    }
    settings.target_vertices = std::min(settings.target_vertices, kMostVertices);
    settings.normalization_window = std::min(settings.normalization_window, kLargestWindow);
    run(settings);
    return 0;
}
