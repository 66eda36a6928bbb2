// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// A mesh with arbitrary faces taken out, added and rewired, and arbitrary coordinates, whose counters are
// asked for: the run throws an Error with a sentence, or every vertex of a face gets a finite value.
#include <cmath>
#include <set>

#include "bytes.h"
#include "tests/unit/support/referee.h"
#include "vcg_core/mesh_counters.h"

namespace {

using namespace neuralmesh;
using fuzz::Bytes;
using fuzz::expect;

Shape start_of(Bytes& bytes) {
    switch (bytes.below(6)) {
        case 0: return shapes::tetrahedron();
        case 1: return shapes::icosphere(1);
        case 2: return shapes::grid(5, 4);
        case 3: return shapes::bipyramid(4 + bytes.byte() / 4);
        case 4: return shapes::fan(2 + bytes.byte() / 8);
        default: return shapes::torus_grid(6, 4);
    }
}

/// A number from the whole range of double or of a small grid, on which vertices coincide.
double coordinate(Bytes& bytes, bool any) { return any ? bytes.raw<double>() : bytes.below(16) / 8.0; }

void change(Shape& shape, Bytes& bytes) {
    const auto some = [&](std::size_t count) { return static_cast<std::size_t>(bytes.byte()) % count; };
    const auto vertex = [&] { return static_cast<int>(some(shape.positions.size())); };
    const int what = bytes.below(5);
    if (what == 4) shape.faces.push_back({vertex(), vertex(), vertex()});
    if (shape.faces.empty()) return;
    const std::size_t face = some(shape.faces.size());
    if (what == 0) shape.faces.erase(shape.faces.begin() + static_cast<std::ptrdiff_t>(face));
    if (what == 1) shape.faces[face][some(3)] = vertex();
    if (what > 1 && what < 4) {
        const bool any = what == 3;
        vcg::Point3d& p = shape.positions[some(shape.positions.size())];
        for (int k = 0; k < 3; ++k) p[k] = coordinate(bytes, any);
    }
}

void check(const MeshCounters& found, const Shape& shape) {
    std::set<int> used;
    for (const auto& face : shape.faces) used.insert(face.begin(), face.end());
    expect(found.report.vertices == static_cast<int>(used.size()), "the vertices are miscounted");
    expect(found.counters.size() == shape.positions.size() && found.features.size() == found.counters.size(),
           "not one value and one mark for every vertex");
    int features = 0;
    for (std::size_t i = 0; i < found.counters.size(); ++i) {
        const float value = found.counters[i];
        expect(value >= 0 && std::isfinite(value), "a value is below 0 or not finite");
        expect(used.count(static_cast<int>(i)) > 0 || (value == 0 && found.features[i] == 0),
               "a vertex without faces has a value");
        features += found.features[i];
    }
    expect(features == found.report.feature_vertices, "the features are miscounted");
    expect(std::isfinite(found.report.mean_counter), "the mean is not finite");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    Settings settings;
    const int flags = bytes.byte();
    settings.feature_measure = flags & 1;
    settings.select_by = (flags & 2) / 2;
    settings.signals_per_vertex = 1;
    settings.threads = 1;
    const bool from_faces = (flags & 4) != 0;
    Shape shape = start_of(bytes);
    while (bytes.left() > 0) change(shape, bytes);
    NoProgress progress;
    try {
        const TargetSpace target = from_faces ? target_of(shape) : target_of(shape.positions);
        check(mesh_counters(shape, target, settings, progress), shape);
    } catch (const Error& error) {
        fuzz::expect_sentence(error.what());
    }
    return 0;
}
