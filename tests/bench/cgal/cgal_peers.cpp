// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Reconstructs a mesh of about N vertices from a cloud with CGAL, for comparison with the neural mesh:
//   cgal_peers advancing-front|alpha-wrap CLOUD.ply OUT.ply target_vertices=N
// writes the mesh and prints the seconds of the clock and of the processor, without reading and writing
// files. Advancing Front meshes all points, then CGAL's edge collapse reduces the mesh. The number of
// vertices of Alpha Wrap depends on alpha; the search for alpha is not timed.
#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/read_points.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Points = std::vector<Kernel::Point_3>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

void reduce(Mesh& mesh, std::size_t vertices) {
    namespace Simplification = CGAL::Surface_mesh_simplification;
    // A closed mesh has about three edges per vertex.
    const Simplification::Count_stop_predicate<Mesh> stop(3 * vertices);
    Simplification::edge_collapse(mesh, stop);
    mesh.collect_garbage();
}

Mesh advancing_front(Points points, std::size_t vertices) {
    std::vector<std::array<std::size_t, 3>> faces;
    CGAL::advancing_front_surface_reconstruction(points.begin(), points.end(), std::back_inserter(faces));
    CGAL::Polygon_mesh_processing::orient_polygon_soup(points, faces);
    Mesh mesh;
    CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, faces, mesh);
    for (const Mesh::Vertex_index v : mesh.vertices())
        if (mesh.is_isolated(v)) mesh.remove_vertex(v);
    mesh.collect_garbage();
    reduce(mesh, vertices);
    return mesh;
}

/// The offset is a twentieth of alpha, as in CGAL's manual.
Mesh wrap(const Points& points, double alpha) {
    Mesh mesh;
    CGAL::alpha_wrap_3(points, alpha, alpha / 20, mesh);
    return mesh;
}

/// The alpha whose wrap has about \p vertices vertices. Their number is nearly proportional to 1 / alpha^2.
double alpha_for(const Points& points, std::size_t vertices) {
    const CGAL::Bbox_3 box = CGAL::bbox_3(points.begin(), points.end());
    double alpha = std::hypot(box.x_span(), box.y_span(), box.z_span()) / 50;
    for (int i = 0; i < 4; ++i)
        alpha *= std::sqrt(static_cast<double>(wrap(points, alpha).number_of_vertices()) /
                           static_cast<double>(vertices));
    return alpha;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string method = argc > 4 ? argv[1] : "";
    const std::string wanted = argc > 4 ? argv[4] : "";
    const std::string key = "target_vertices=";
    if ((method != "advancing-front" && method != "alpha-wrap") || wanted.rfind(key, 0) != 0) {
        std::fprintf(stderr, "cgal_peers advancing-front|alpha-wrap CLOUD.ply OUT.ply target_vertices=N\n");
        return 2;
    }
    const auto vertices = static_cast<std::size_t>(std::stoul(wanted.substr(key.size())));
    Points points;
    if (!CGAL::IO::read_points(argv[2], std::back_inserter(points)) || points.empty()) {
        std::fprintf(stderr, "No points could be read from %s.\n", argv[2]);
        return 1;
    }
    const double alpha = method == "alpha-wrap" ? alpha_for(points, vertices) : 0;
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t begin_cpu = std::clock();
    const Mesh mesh = alpha > 0 ? wrap(points, alpha) : advancing_front(points, vertices);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    const double cpu_seconds = static_cast<double>(std::clock() - begin_cpu) / CLOCKS_PER_SEC;
    std::printf("{\"vertices\": %zu, \"seconds\": %.3f, \"cpu_seconds\": %.3f}\n",
                static_cast<std::size_t>(mesh.number_of_vertices()), seconds.count(), cpu_seconds);
    return CGAL::IO::write_polygon_mesh(argv[3], mesh) ? 0 : 1;
}
