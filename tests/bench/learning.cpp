// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Signals per second of the learning loop, on one thread and on two, and of its parts on one thread: search,
// smoothing, normals, counters, moves, topology. The cloud is 200,000 points of a bumpy torus, made here.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "vcg_core/engine/eight_steps.h"
#include "vcg_core/engine/winner_search.h"
#include "vcg_core/learning/learner.h"
#include "vcg_core/learning/utility_counter.h"

namespace {

using namespace neuralmesh;

constexpr int kPoints = 200000;
constexpr int kSignals = 20000;  ///< per iteration of a benchmark

const TargetSpace& cloud() {
    static const TargetSpace target = [] {
        Random random(7);
        std::vector<vcg::Point3d> points;
        for (int i = 0; i < kPoints; ++i) {
            const double u = 6.283185307179586 * random.unit();
            const double v = 6.283185307179586 * random.unit();
            const double tube = 0.4 + 0.03 * std::sin(8 * u) * std::cos(5 * v);
            const double ring = 1 + tube * std::cos(v);
            points.emplace_back(ring * std::cos(u), ring * std::sin(u), tube * std::sin(v));
        }
        return TargetSpace::points(points.size(), [&](std::size_t i) { return points[i]; });
    }();
    return target;
}

Network torus_start() {
    constexpr int kAround = 24, kAcross = 12;
    std::vector<vcg::Point3f> positions;
    std::vector<Triangle> faces;
    const auto id = [](int i, int j) { return (i % kAround) * kAcross + j % kAcross; };
    for (int i = 0; i < kAround; ++i)
        for (int j = 0; j < kAcross; ++j) {
            const double u = 6.283185307179586 * i / kAround, v = 6.283185307179586 * j / kAcross;
            positions.push_back(
                cloud().frame().inside({(1 + 0.4 * std::cos(v)) * std::cos(u),
                                        (1 + 0.4 * std::cos(v)) * std::sin(u), 0.4 * std::sin(v)}));
            faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            faces.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    return Network(positions, faces);
}

/// A network of \p vertices vertices, learned once for all benchmarks.
const Network& learned(int vertices) {
    static std::map<int, Network> networks;
    auto it = networks.find(vertices);
    if (it == networks.end()) {
        LearnerOptions options;
        options.grow_to = vertices;
        options.settling_signals_per_vertex = 0;
        Learner learner(cloud(), options, torus_start());
        NoProgress progress;
        learner.run(0, progress);
        it = networks.emplace(vertices, learner.network()).first;
    }
    return it->second;
}

std::vector<vcg::Point3f> signals() {
    Random random(11);
    std::vector<vcg::Point3f> drawn;
    for (int i = 0; i < kSignals; ++i) drawn.push_back(cloud().sample(random));
    return drawn;
}

void per_signal(benchmark::State& state, std::int64_t signals) {
    state.SetItemsProcessed(signals);
    state.counters["ns_per_signal"] = benchmark::Counter(
        static_cast<double>(signals) * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void per_signal(benchmark::State& state) { per_signal(state, state.iterations() * kSignals); }

void learn(Learner& learner, const std::vector<vcg::Point3f>& drawn) {
    const int size = static_cast<int>(drawn.size());
    for (int from = 0; from < size;) {
        const int count = std::min(learner.batch_size(), size - from);
        for (const StepResult& step : learner.basic_steps(&drawn[static_cast<std::size_t>(from)], count))
            learner.learn_counters(step);
        from += count;
    }
}

/// Whole Basic Steps on a mesh that does not grow, as it settles: signals drawn, counters learned. Arguments:
/// vertices, C_L, threads.
void basic_steps(benchmark::State& state) {
    LearnerOptions options;
    options.grow_to = static_cast<int>(state.range(0));
    options.smoothing_steps = static_cast<int>(state.range(1));
    options.threads = static_cast<int>(state.range(2));
    Learner learner(cloud(), options, learned(options.grow_to));
    NoProgress progress;
    learner.settle(1, progress);  // into memory order and into the caches
    const std::int64_t before = learner.signals();
    for (auto _ : state) learner.settle(1, progress);
    per_signal(state, learner.signals() - before);
}
BENCHMARK(basic_steps)
    ->ArgsProduct({{1000, 10000, 100000}, {5, 0}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Growth from the start mesh, splits and collapses included; arguments: vertices, threads.
void growth(benchmark::State& state) {
    LearnerOptions options;
    options.grow_to = static_cast<int>(state.range(0));
    options.settling_signals_per_vertex = 0;
    options.threads = static_cast<int>(state.range(1));
    NoProgress progress;
    std::int64_t count = 0;
    for (auto _ : state) {
        Learner learner(cloud(), options, torus_start());
        learner.run(0, progress);
        count += learner.signals();
    }
    per_signal(state, count);
}
BENCHMARK(growth)->ArgsProduct({{1000, 10000, 100000}, {1, 2}})->Unit(benchmark::kMillisecond)->UseRealTime();

void part_search(benchmark::State& state) {
    Network network = learned(static_cast<int>(state.range(0)));
    const WinnerSearch search(network);
    const auto drawn = signals();
    for (auto _ : state)
        for (const vcg::Point3f& s : drawn) benchmark::DoNotOptimize(search.winner(s));
    per_signal(state);
}

std::vector<VertexId> winners(Network& network) {
    const WinnerSearch search(network);
    std::vector<VertexId> result;
    for (const vcg::Point3f& s : signals()) result.push_back(search.winner(s));
    return result;
}

/// Groups of eight winners of one valence.
std::vector<std::vector<VertexId>> groups(Network& network) {
    std::map<int, std::vector<VertexId>> of_valence;
    std::vector<std::vector<VertexId>> result;
    for (const VertexId w : winners(network)) {
        auto& group = of_valence[network.ring(w).valence];
        group.push_back(w);
        if (group.size() < EightSteps::kLanes) continue;
        result.push_back(group);
        group.clear();
    }
    return result;
}

template <class Part>
void per_group(benchmark::State& state, const Part& part) {
    Network network = learned(static_cast<int>(state.range(0)));
    const auto all = groups(network);
    EightSteps eight;
    eight.gather(network, all.front().data(), EightSteps::kLanes);
    for (auto _ : state)
        for (const auto& group : all) {
            part(network, group, eight);
            benchmark::DoNotOptimize(eight);
        }
    per_signal(state);
}

void part_gather(benchmark::State& state) {
    per_group(state, [](const Network& network, const std::vector<VertexId>& group, EightSteps& eight) {
        eight.gather(network, group.data(), EightSteps::kLanes);
    });
}

/// Five smoothing steps.
void part_smoothing(benchmark::State& state) {
    per_group(state, [](const Network&, const std::vector<VertexId>&, EightSteps& eight) {
        eight.smooth(5, 0.05F);
    });
}

/// Normals before and after.
void part_normals(benchmark::State& state) {
    per_group(state, [](const Network&, const std::vector<VertexId>&, EightSteps& eight) {
        EightVectors n;
        eight.normals(n);
        eight.normals(n);
        benchmark::DoNotOptimize(n);
    });
}

void part_displacements(benchmark::State& state) {
    per_group(state, [](const Network&, const std::vector<VertexId>&, EightSteps& eight) {
        Four moved[EightSteps::kLanes][1 + Ring::kMaxValence];
        Four* to[EightSteps::kLanes];
        std::copy(std::begin(moved), std::end(moved), std::begin(to));
        eight.displacements(to);
        benchmark::DoNotOptimize(moved);
    });
}

void part_counters(benchmark::State& state) {
    Network network = learned(static_cast<int>(state.range(0)));
    const auto winner_ids = winners(network);
    UtilityCounters utility(0.95, 30);
    FeatureCounters features(0.95);
    WindowMean mean(1000);
    utility.resize(network.slot_count());
    features.resize(network.slot_count());
    for (auto _ : state)
        for (const VertexId w : winner_ids) {
            mean.add(1e-4);
            utility.win(w, 1e-4 / mean.mean());
            features.win(w, 1e-4 / mean.mean());
        }
    per_signal(state);
}

/// Moves of the winner and its ring in the winner search, all within their cells.
void part_moves(benchmark::State& state) {
    Network network = learned(static_cast<int>(state.range(0)));
    WinnerSearch search(network);
    const auto winner_ids = winners(network);
    for (auto _ : state)
        for (const VertexId w : winner_ids) {
            search.move(w, network.position(w));
            const Ring& ring = network.ring(w);
            for (int i = 0; i < ring.valence; ++i) search.move(ring[i], network.position(ring[i]));
        }
    per_signal(state);
}

/// Vertex splits alone; per split, not per signal.
void part_topology(benchmark::State& state) {
    LearnerOptions options;
    options.grow_to = 2 * static_cast<int>(state.range(0));
    for (auto _ : state) {
        state.PauseTiming();
        auto learner = std::make_unique<Learner>(cloud(), options, learned(static_cast<int>(state.range(0))));
        learn(*learner, signals());
        state.ResumeTiming();
        while (learner->splits() < 100 && learner->vertex_split()) {
        }
        state.PauseTiming();
        learner.reset();
        state.ResumeTiming();
    }
    state.counters["ns_per_split"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * 100 * 1e-9,
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void sizes(benchmark::internal::Benchmark* b) {
    b->Arg(1000)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);
}

BENCHMARK(part_search)->Apply(sizes);
BENCHMARK(part_gather)->Apply(sizes);
BENCHMARK(part_smoothing)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(part_normals)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(part_displacements)->Arg(10000)->Unit(benchmark::kMillisecond);
BENCHMARK(part_counters)->Apply(sizes);
BENCHMARK(part_moves)->Apply(sizes);
BENCHMARK(part_topology)->Arg(1000)->Iterations(20)->Unit(benchmark::kMillisecond);

}  // namespace
