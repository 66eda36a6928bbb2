// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Our winner search against vcglib's hash table, vcg::SpatialHashTable: one signal finds its winner, then the
// winner and its ring move a little, as in a Basic Step.
#include <benchmark/benchmark.h>
#include <vcg/space/box3.h>
#include <vcg/space/index/spatial_hashing.h>

#include <cmath>
#include <vector>

#include "vcg_core/base/random.h"
#include "vcg_core/engine/winner_search.h"

namespace {

using namespace neuralmesh;

constexpr int kSignals = 20000;  ///< per iteration

/// A torus of n x n / 2 vertices inside the core's frame.
Network torus(int n) {
    const int across = n / 2;
    std::vector<vcg::Point3f> positions;
    std::vector<Triangle> faces;
    const auto id = [&](int i, int j) { return (i % n) * across + j % across; };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 6.283185307179586 * i / n;
            const double v = 6.283185307179586 * j / across;
            const double ring = 0.2 + 0.08 * std::cos(v);
            positions.push_back(vcg::Point3f::Construct(
                vcg::Point3d(ring * std::cos(u), ring * std::sin(u), 0.08 * std::sin(v))));
            faces.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            faces.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    return Network(positions, faces);
}

vcg::Point3f shift(Random& random, float size) {
    const float x = random.unit() - 0.5F;
    const float y = random.unit() - 0.5F;
    return vcg::Point3f(x, y, random.unit() - 0.5F) * size;
}

/// Points about half an edge from vertices.
std::vector<vcg::Point3f> signals_near(const Network& network) {
    Random random(3);
    std::vector<vcg::Point3f> signals;
    while (signals.size() < kSignals) {
        const auto v = static_cast<VertexId>(random.below(static_cast<std::uint32_t>(network.slot_count())));
        signals.push_back(network.position(v) +
                          shift(random, (network.position(v) - network.position(network.ring(v)[0])).Norm()));
    }
    return signals;
}

/// \p winner(s) and \p move(v, by) for all signals, again and again.
template <class Winner, class Move>
void run(benchmark::State& state, const Network& network, const Winner& winner, const Move& move) {
    const std::vector<vcg::Point3f> signals = signals_near(network);
    Random random(5);
    for (auto _ : state)
        for (const vcg::Point3f& s : signals) {
            const VertexId w = winner(s);
            move(w, shift(random, 2e-4F));
            for (const VertexId v : network.ring(w)) move(v, shift(random, 5e-5F));
        }
    state.counters["ns_per_signal"] =
        benchmark::Counter(static_cast<double>(state.iterations()) * kSignals * 1e-9,
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Argument: the network has n x n / 2 vertices.
void ours(benchmark::State& state) {
    Network network = torus(static_cast<int>(state.range(0)));
    WinnerSearch search(network);
    run(
        state, network, [&](const vcg::Point3f& s) { return search.winner(s); },
        [&](VertexId v, const vcg::Point3f& by) { search.move(v, network.position(v) + by); });
}
BENCHMARK(ours)->Arg(45)->Arg(141)->Arg(447)->Unit(benchmark::kMillisecond);

/// A point with the interface that vcglib's indices need.
struct Point {
    using ScalarType = float;
    vcg::Point3f p;
    const vcg::Point3f& cP() const { return p; }  // NOLINT(readability-identifier-naming): vcglib's name
    bool IsD() const { return false; }            // NOLINT(readability-identifier-naming)
    void GetBBox(vcg::Box3f& box) const {         // NOLINT(readability-identifier-naming)
        box.SetNull();
        box.Add(p);
    }
};

struct Distance {
    using QueryType = vcg::Point3f;
    static const vcg::Point3f& Pos(const vcg::Point3f& p) {
        return p;
    }  // NOLINT(readability-identifier-naming)
    bool operator()(const Point& a, const vcg::Point3f& b, float& least, vcg::Point3f& nearest) const {
        const float d = (a.p - b).Norm();
        if (d >= least) return false;
        least = d;
        nearest = a.p;
        return true;
    }
};

struct NoMarks {
    void UnMarkAll() {}                           // NOLINT(readability-identifier-naming)
    bool IsMarked(const void*) { return false; }  // NOLINT(readability-identifier-naming)
    void Mark(const void*) {}                     // NOLINT(readability-identifier-naming)
};

/// Second argument: edge of a cell, in hundredths of an edge of the mesh.
void vcglib(benchmark::State& state) {
    const Network network = torus(static_cast<int>(state.range(0)));
    std::vector<Point> points;
    vcg::Box3f box;
    for (const VertexId v : network.vertices()) {
        points.push_back({network.position(v)});
        box.Add(network.position(v));
    }
    box.Offset(0.1F);
    const float edge = (network.position(0) - network.position(1)).Norm();
    const float cell = edge * static_cast<float>(state.range(1)) / 100;
    vcg::SpatialHashTable<Point, float> table;
    const auto cells = [&](float length) { return static_cast<int>(length / cell) + 1; };
    table.InitEmpty(box, {cells(box.DimX()), cells(box.DimY()), cells(box.DimZ())});
    for (Point& p : points) table.Add(&p);
    const auto cell_of = [&](const vcg::Point3f& p) {
        vcg::Point3i c;
        table.PToIP(p, c);
        return c;
    };
    Distance distance;
    NoMarks marks;
    const auto winner = [&](const vcg::Point3f& s) {
        float least = 1;
        vcg::Point3f nearest;
        const Point* p = table.GetClosest(distance, marks, s, 1.0F, least, nearest);
        return static_cast<VertexId>(p - points.data());
    };
    const auto move = [&](VertexId v, const vcg::Point3f& by) {
        Point& p = points[static_cast<std::size_t>(v)];
        const vcg::Point3i from = cell_of(p.p);
        const vcg::Point3i to = cell_of(p.p + by);
        if (from != to) {  // as RemovePunctual(), which does not compile
            const auto range = table.hash_table.equal_range(from);
            for (auto i = range.first; i != range.second; ++i)
                if (i->second == &p) {
                    table.hash_table.erase(i);
                    break;
                }
        }
        p.p += by;
        if (from != to) table.Add(&p);
    };
    run(state, network, winner, move);
}
BENCHMARK(vcglib)->ArgsProduct({{45, 141, 447}, {200, 300, 400}})->Unit(benchmark::kMillisecond);

}  // namespace
