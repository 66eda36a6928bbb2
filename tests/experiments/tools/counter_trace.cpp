// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Traces the candidates for a stop criterion while a mesh grows, for paper_termination.py:
// counter_trace IN.ply [parameter=value ...] learns the cloud without settling. Each time the number of
// vertices has doubled, it prints a line of JSON.
#include <cstdio>
#include <exception>

#include "tests/experiments/tools/ply_mesh.h"
#include "vcg_core/learn_and_fit.h"
#include "vcg_core/learning/learner.h"
#include "vcg_core/shell/shell.h"
#include "vcg_core/target/surface_survey.h"

namespace {

using namespace neuralmesh;

constexpr int kFirst = 500;  ///< vertices at the first line
constexpr int kSignalsToLand = 100;

/// Prints the learner's state each time the number of vertices has doubled. The counters of eq 4 cover only
/// about twenty signals and fluctuate, so their mean over all calls since the previous line is printed.
class Trace : public Progress {
public:
    explicit Trace(const Learner& learner) : learner_(learner) {}

    bool operator()(double /*fraction*/, const char* /*text*/) override {
        const Network& network = learner_.network();
        double eq4 = 0;
        double eq6 = 0;
        for (VertexId v = 0; v < network.slot_count(); ++v) {
            if (!network.alive(v)) continue;
            eq4 += learner_.utility_counters().value(v);
            eq6 += static_cast<double>(learner_.feature_counters().value(v));
        }
        const int count = network.vertex_count();
        sum_eq4_ += eq4;
        mean_eq4_ += eq4 / count;
        ++calls_;
        if (count < next_) return true;
        std::printf(
            "{\"vertices\":%d,\"signals\":%lld,\"mean_eq4\":%.6g,\"sum_eq4\":%.6g,\"mean_eq6\":%.6g,"
            "\"mean_turn\":%.6g}\n",
            count, static_cast<long long>(learner_.signals()), mean_eq4_ / calls_, sum_eq4_ / calls_,
            eq6 / count, learner_.mean_turn());
        next_ *= 2;
        sum_eq4_ = mean_eq4_ = calls_ = 0;
        return true;
    }

private:
    const Learner& learner_;
    int next_ = kFirst;
    double sum_eq4_ = 0;
    double mean_eq4_ = 0;
    double calls_ = 0;
};

int run(int argc, char** argv) {
    Settings settings;
    settings.settling_signals_per_vertex = 0;
    for (int i = 2; i < argc; ++i) set_parameter(settings, argv[i]);
    settings.check();
    const TargetSpace target = target_of_ply(argv[1], settings);
    NoProgress no_progress;
    Surveys surveys(target.positions(), settings.threads);
    const StartMesh shell = Shell(target.positions(), surveys, ShellOptions(), no_progress).mesh(no_progress);
    Learner learner(target, learner_options_from(settings), Network(shell.positions, shell.faces));
    Trace trace(learner);
    learner.run(kSignalsToLand, trace);
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc < 2) {
        std::fprintf(stderr, "usage: %s IN.ply [parameter=value ...]\n", argv[0]);
        return 2;
    }
    return run(argc, argv);
} catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
