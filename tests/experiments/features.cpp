// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// What learning knows about features, for features.py: features IN.ply OUT VERTICES UTILITY_COUNTER SETTLING
// learns the cloud and writes OUT.learned (the mesh as learning leaves it) and OUT.fitted (after the fit):
// lines "v x y z eq6_counter statistic" in the coordinates of the cloud, and "f a b c", from 0.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "ply_mesh.h"
#include "vcg_core/features.h"
#include "vcg_core/fit.h"
#include "vcg_core/learner.h"
#include "vcg_core/shell.h"

namespace {

using namespace neuralmesh;

void write(const std::string& path, const Network& network, const Frame& frame, const Learner& learner,
           const std::vector<VertexId>& origin, const std::vector<float>& values) {
    std::FILE* out = std::fopen(path.c_str(), "w");
    if (out == nullptr) throw InputError("Cannot write " + path + ".");
    std::vector<int> index(static_cast<std::size_t>(network.slot_count()), -1);
    int count = 0;
    for (VertexId v = 0; v < network.slot_count(); ++v) {
        if (!network.alive(v)) continue;
        const auto i = static_cast<std::size_t>(v);
        index[i] = count++;
        const vcg::Point3d p = frame.outside(network.position(v));
        const float n_c = learner.feature_counters().value(origin.empty() ? v : origin[i]);
        std::fprintf(out, "v %.9g %.9g %.9g %.9g %.9g\n", p[0], p[1], p[2], static_cast<double>(n_c),
                     static_cast<double>(values[i]));
    }
    for (const Triangle& f : network.faces())
        std::fprintf(out, "f %d %d %d\n", index[static_cast<std::size_t>(f[0])],
                     index[static_cast<std::size_t>(f[1])], index[static_cast<std::size_t>(f[2])]);
    std::fclose(out);
}

/// Settles as Learner::settle does, and observes once per as many signals as there are vertices.
FeatureStatistic settle(Learner& learner, const TargetSpace& target, int per_vertex) {
    FeatureStatistic statistic;
    Random random(99);
    for (int sweep = 0; sweep < per_vertex; ++sweep) {
        for (int i = 0; i < learner.network().vertex_count(); ++i) learner.basic_step(target.sample(random));
        if (sweep >= per_vertex / 5) statistic.observe(learner.network());
    }
    return statistic;
}

int run(char** argv) {
    Settings settings;
    settings.target_vertices = std::atoi(argv[3]);
    settings.utility_counter = std::atoi(argv[4]);
    settings.settling_signals_per_vertex = 0;
    settings.check();
    const TargetSpace target = target_of_ply(argv[1], settings);
    NoProgress progress;
    ShellOptions options;
    options.target_vertices = settings.target_vertices;
    Random random(3);
    const StartMesh shell = shell_of(target, options, random, progress);
    Learner learner(target, settings, Network(shell.positions, shell.faces));
    learner.run(100, progress);
    const FeatureStatistic statistic = settle(learner, target, std::atoi(argv[5]));

    const std::string out = argv[2];
    const Network& learned = learner.network();
    write(out + ".learned", learned, target.frame(), learner, {}, statistic.values(learned));
    Network fitted = learned;
    const FitReport fit = fit_to_points(fitted, target, FitOptions(), settings.threads, 4, progress);
    const std::vector<float> values = statistic.values(learned, fitted, fit.origin);
    write(out + ".fitted", fitted, target.frame(), learner, fit.origin, values);
    return 0;
}

}  // namespace

int main(int argc, char** argv) try {
    if (argc != 6) {
        std::fprintf(stderr, "usage: %s IN.ply OUT VERTICES UTILITY_COUNTER SETTLING\n", argv[0]);
        return 2;
    }
    return run(argv);
} catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
