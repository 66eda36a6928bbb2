// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The search for the nearest faces of 200,000 points near 10,000 faces: point by point, and in packets.
#include <benchmark/benchmark.h>

#include <vector>

#include "tests/unit/support/shapes.h"
#include "vcg_core/mesh/face_tree.h"

namespace {

using namespace neuralmesh;

Surface torus() {
    const shapes::Shape shape = shapes::torus_grid(100, 50);
    std::vector<vcg::Point3f> positions;
    for (const vcg::Point3d& p : shape.positions) positions.push_back(vcg::Point3f::Construct(p * 0.4));
    return Surface(Network(positions, shape.faces));
}

std::vector<Vector3> points_near(const Surface& surface) {
    constexpr std::size_t kPoints = 200000;
    constexpr float kOff = 0.01F;
    Random random(3);
    const auto off = [&] { return kOff * (random.unit() - 0.5F); };
    std::vector<Vector3> points;
    while (points.size() < kPoints) {
        const auto f = static_cast<int>(random.below(static_cast<std::uint32_t>(surface.face_count())));
        const float u = random.unit(), v = (1 - u) * random.unit();
        const Vector3 ab = surface.corner(f, 1) - surface.corner(f, 0);
        const Vector3 ac = surface.corner(f, 2) - surface.corner(f, 0);
        points.push_back(surface.corner(f, 0) + u * ab + v * ac + Vector3(off(), off(), off()));
    }
    return points;
}

template <class Search>
void run(benchmark::State& state, const Search& search) {
    const Surface surface = torus();
    const std::vector<Vector3> points = points_near(surface);
    const FaceTree tree(surface);
    for (auto _ : state) search(tree, points);
    state.counters["ns_per_point"] = benchmark::Counter(
        static_cast<double>(state.iterations() * static_cast<std::int64_t>(points.size())) * 1e-9,
        benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void each(benchmark::State& state) {
    run(state, [](const FaceTree& tree, const std::vector<Vector3>& points) {
        for (const Vector3& p : points) benchmark::DoNotOptimize(tree.nearest(p));
    });
}

void packets(benchmark::State& state) {
    ThreadTeam team(1);
    run(state, [&](const FaceTree& tree, const std::vector<Vector3>& points) {
        benchmark::DoNotOptimize(tree.nearest(points, team));
    });
}

BENCHMARK(each)->Unit(benchmark::kMillisecond);
BENCHMARK(packets)->Unit(benchmark::kMillisecond);

}  // namespace
