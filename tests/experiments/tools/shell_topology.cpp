// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Compares components and genus of start meshes with the true ones:
//   shell_topology [FILE.ply:COMPONENTS:GENUS ...]
// Uses the given surfaces and three made in code. From each it draws clouds of 20,000 and 200,000 points at
// four noise levels, and takes the bare vertices without noise. Prints a Markdown table with a row per cloud,
// and how many surfaces were right for each number of points and noise level.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "tests/experiments/tools/ply_mesh.h"
#include "tests/unit/support/shell_shapes.h"
#include "tests/unit/support/targets.h"
#include "vcg_core/cloud/surface_survey.h"
#include "vcg_core/start/shell.h"

namespace {

using namespace neuralmesh;

struct Model {
    std::string name;
    int components = 1, genus = 0;
    shell_shapes::Shape surface;
};

Model model_from(const std::string& argument) {
    const std::size_t last = argument.rfind(':'), first = argument.rfind(':', last - 1);
    if (last == std::string::npos || first == std::string::npos)
        throw InputError("'" + argument + "' is not FILE.ply:COMPONENTS:GENUS.");
    const std::string file = argument.substr(0, first);
    PlyMesh mesh;
    read_ply(file, mesh);
    Model model{file.substr(file.rfind('/') + 1),
                std::atoi(argument.c_str() + first + 1),
                std::atoi(argument.c_str() + last + 1),
                {}};
    for (const PlyVertex& v : mesh.vert) model.surface.positions.push_back(v.cP());
    for (const PlyFace& f : mesh.face) {
        std::array<int, 3> corners{};
        for (int k = 0; k < 3; ++k)
            corners[static_cast<std::size_t>(k)] = static_cast<int>(vcg::tri::Index(mesh, f.cV(k)));
        model.surface.faces.push_back(corners);
    }
    return model;
}

std::vector<Model> own_models() {
    shell_shapes::Shape spheres = shell_shapes::sphere(1, 160);
    shell_shapes::append(spheres, shell_shapes::sphere(1, 160), {2.3, 0, 0});
    return {{"chain of four linked tori", 4, 4, shell_shapes::chain(4, 1, 0.2, 1.3)},
            {"two separate spheres", 2, 0, spheres},
            {"thin-walled cup", 1, 0, shell_shapes::cup(1, 2, 0.06)}};
}

double diagonal(const shell_shapes::Shape& shape) {
    vcg::Box3d box;
    for (const vcg::Point3d& p : shape.positions) box.Add(p);
    return box.Diag();
}

/// One row of the table. \p samples 0: the bare vertices, which have no noise.
bool measure(const Model& model, std::size_t samples, double noise_percent) {
    Random random(1);
    const double noise = noise_percent / 100 * diagonal(model.surface);
    const std::vector<vcg::Point3d> cloud =
        samples == 0 ? model.surface.positions : shell_shapes::sample(model.surface, samples, random, noise);
    const TargetSpace target = targets::target_of(cloud);
    NoProgress progress;
    const auto start = std::chrono::steady_clock::now();
    Surveys surveys(target.positions(), 0);
    const StartMesh mesh = Shell(target.positions(), surveys, ShellOptions(), progress).mesh(progress);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    const bool right = mesh.components == model.components && mesh.genus == model.genus;
    std::printf("| %s | %zu | %g | %d / %d | %d / %d | %s | %.2f | %.2f | %.2f | %zu | %.2f |\n",
                model.name.c_str(), cloud.size(), noise_percent, mesh.components, model.components,
                mesh.genus, model.genus, right ? "yes" : "**no**", mesh.confidence, 100 * mesh.resolution,
                100 * mesh.radius, mesh.positions.size(), seconds.count());
    return right;
}

int run(int argc, char** argv) {
    std::vector<Model> models;
    for (int i = 1; i < argc; ++i) models.push_back(model_from(argv[i]));
    for (const Model& model : own_models()) models.push_back(model);
    std::printf(
        "| model | points | noise %% | components / true | genus / true | right | confidence | lattice %% | "
        "radius %% | vertices | s |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    std::map<std::pair<double, std::size_t>, int> right;
    for (const Model& model : models)
        for (const std::size_t samples : {20000U, 200000U, 0U})
            for (const double noise : {0.0, 0.1, 0.3, 0.6})
                if (samples != 0 || noise == 0) right[{noise, samples}] += measure(model, samples, noise);
    std::printf("\nRight, of %zu:", models.size());
    for (const auto& [column, count] : right) {
        const std::string points = column.second == 0 ? "bare vertices" : std::to_string(column.second);
        std::printf(" %s, noise %g %%: %d.", points.c_str(), column.first, count);
    }
    std::printf("\n");
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
