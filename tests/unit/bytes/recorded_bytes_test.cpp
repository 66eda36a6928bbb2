// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Small runs give the recorded bytes, with any compiler and on any machine.
#include <fstream>

#include "tests/unit/support/runs.h"

namespace neuralmesh::recorded_bytes_test {

/// Adds \p values to \p hash by FNV-1a.
template <class T>
void hash_bytes(const std::vector<T>& values, std::uint64_t& hash) {
    const char* bytes = reinterpret_cast<const char*>(values.data());
    for (std::size_t i = 0; i < values.size() * sizeof(T); ++i)
        hash = (hash ^ static_cast<std::uint8_t>(bytes[i])) * 0x100000001b3U;
}

std::string line_for(const std::string& run, const NeuralMesh& mesh) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    hash_bytes(mesh.positions, hash);
    hash_bytes(mesh.faces, hash);
    hash_bytes(mesh.counters, hash);
    hash_bytes(mesh.features, hash);
    std::ostringstream line;
    line << run << ' ' << mesh.report.signals << ' ' << std::hex << hash << '\n';
    return line.str();
}

/// An open surface, and a closed one with stray points.
std::string runs_on_scans() {
    Settings settings = with_target(200);
    settings.select_by = kFeatureCounter;
    Cloud bowl;
    for (const vcg::Point3d& p : shapes::sphere_cloud(4000, 0.01))
        if (p[2] < 0.25) bowl.push_back(p);
    const NeuralMesh open = learn(bowl, settings);
    EXPECT_EQ(open.report.boundary_loops, 1);
    Cloud dusty = shapes::sphere_cloud(3000, 0.01);
    Random random(2);
    for (int i = 0; i < 60; ++i) dusty.push_back(shapes::in_cube(random) * 2);
    const NeuralMesh cleaned = learn(dusty, settings);
    EXPECT_GT(cleaned.report.outliers, 30);
    return line_for("bowl", open) + line_for("dusty", cleaned);
}

/// One line for each run on noisy, sharp and flat clouds with variants(), and those of runs_on_scans(). The
/// clouds need no function of the mathematics library, whose results may differ between machines.
std::string recorded_runs() {
    std::string lines;
    const std::pair<const char*, Cloud> clouds[] = {{"sphere", shapes::sphere_cloud(1500, 0.01)},
                                                    {"box", shapes::box_cloud(1500, {1, 0.7, 0.3})},
                                                    {"sheet", shapes::plane_cloud(1500)}};
    for (const auto& [name, cloud] : clouds) {
        int variant = 0;
        for (Settings settings : variants()) {
            settings.feature_measure = variant % 2 == 0 ? kCreaseMeasure : kFeatureCounter;
            settings.select_by = settings.feature_measure;
            lines += line_for(name + (' ' + std::to_string(variant++)), learn(cloud, settings));
        }
    }
    return lines + runs_on_scans();
}

/// For any compiler, optimisation and machine. NEURALMESH_RECORD=1 records the bytes after an intended
/// change.
TEST(Determinism, SameBytesAsRecorded) {
    const std::string runs = recorded_runs();
    if (std::getenv("NEURALMESH_RECORD") != nullptr) std::ofstream(NEURALMESH_RECORDED_BYTES) << runs;
    std::ostringstream recorded;
    recorded << std::ifstream(NEURALMESH_RECORDED_BYTES).rdbuf();
    EXPECT_EQ(runs, recorded.str())
        << "After an intended change of results, record them: see tests/README.md.";
}

}  // namespace neuralmesh::recorded_bytes_test
