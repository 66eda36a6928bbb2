// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// check_mesh MESH [REFERENCE]: prints vcglib's measures of a mesh file as one JSON object: size, topology,
// volume. With a reference (a surface or a cloud) also the RMS and largest distance in both directions, in %
// of the reference's diagonal.
#include <vcg/complex/algorithms/clean.h>
#include <vcg/complex/algorithms/closest.h>
#include <vcg/complex/algorithms/point_sampling.h>
#include <vcg/complex/complex.h>
#include <vcg/space/distance3.h>
#include <vcg/space/index/grid_static_ptr.h>
#include <wrap/io_trimesh/import.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <stdexcept>
#include <string>

namespace {

class Vertex;
class Face;
struct Types : vcg::UsedTypes<vcg::Use<Vertex>::AsVertexType, vcg::Use<Face>::AsFaceType> {};
class Vertex
    : public vcg::Vertex<Types, vcg::vertex::Coord3d, vcg::vertex::Normal3d, vcg::vertex::Qualityd,
                         vcg::vertex::Color4b, vcg::vertex::VFAdj, vcg::vertex::Mark, vcg::vertex::BitFlags> {
};
class Face : public vcg::Face<Types, vcg::face::VertexRef, vcg::face::Normal3d, vcg::face::FFAdj,
                              vcg::face::VFAdj, vcg::face::Mark, vcg::face::BitFlags> {};
class Mesh : public vcg::tri::TriMesh<std::vector<Vertex>, std::vector<Face>> {};

using Point = vcg::Point3d;
using Clean = vcg::tri::Clean<Mesh>;
using Mask = vcg::tri::io::Mask;

int load(Mesh& mesh, const std::string& path) {
    int mask = 0;
    const int error = vcg::tri::io::Importer<Mesh>::Open(mesh, path.c_str(), mask);
    if (error != 0 && vcg::tri::io::Importer<Mesh>::ErrorCritical(error))
        throw std::runtime_error(path + ": " + vcg::tri::io::Importer<Mesh>::ErrorMsg(error));
    vcg::tri::UpdateBounding<Mesh>::Box(mesh);
    return mask;
}

template <class Value>
void print(const char* key, const Value& value) {
    std::cout << ", \"" << key << "\": " << value;
}

void print(const char* key, bool value) {
    std::cout << ", \"" << key << "\": " << (value ? "true" : "false");
}

void print_topology(Mesh& mesh) {
    vcg::tri::UpdateTopology<Mesh>::FaceFace(mesh);
    print("watertight", Clean::IsWaterTight(mesh));
    print("non_manifold_edges", Clean::CountNonManifoldEdgeFF(mesh));
    print("non_manifold_vertices", Clean::CountNonManifoldVertexFF(mesh));
    print("oriented", Clean::IsCoherentlyOrientedMesh(mesh));
    print("genus", Clean::MeshGenus(mesh));
    print("components", Clean::CountConnectedComponents(mesh));
    print("boundary_loops", Clean::CountHoles(mesh));
    print("unreferenced_vertices", Clean::CountUnreferencedVertex(mesh));
    print("volume", vcg::tri::Stat<Mesh>::ComputeMeshVolume(mesh));
}

/// The exact distance of a point from a face, for vcglib's grids. That of vcglib's HausdorffSampler is too
/// large beside an obtuse corner, as it takes the first edge that the point lies beyond for the nearest.
struct FaceDistance {
    using QueryType = Point;
    static const Point& Pos(const Point& point) { return point; }
    bool operator()(const Face& face, const Point& point, double& least, Point& nearest) const {
        if (vcg::DoubleArea(face) == 0) return false;  // its edges are those of neighbours
        double distance = 0;
        Point foot;
        vcg::TrianglePointDistance(vcg::Triangle3<double>(face.cP(0), face.cP(1), face.cP(2)), point,
                                   distance, foot);
        if (distance >= least) return false;
        least = distance;
        nearest = foot;
        return true;
    }
};

/// The distances of points from a surface, or from a cloud if it has no faces. A sampler of vcglib.
class Distances {
public:
    Distances(Mesh& to, double far) : to_(to), far_(far), marker_(&to) {
        if (to.fn == 0)
            points_.Set(to.vert.begin(), to.vert.end());
        else
            faces_.Set(to.face.begin(), to.face.end());
    }
    void AddVert(const Vertex& vertex) { add(vertex.cP()); }
    void AddFace(const Face& face, const Point& weights) {
        add(face.cP(0) * weights[0] + face.cP(1) * weights[1] + face.cP(2) * weights[2]);
    }
    double rms() const { return std::sqrt(squares_ / static_cast<double>(count_)); }
    double largest() const { return largest_; }

private:
    void add(const Point& point) {
        double distance = far_;
        if (to_.fn == 0) {
            vcg::tri::GetClosestVertex(to_, points_, point, far_, distance);
        } else {
            FaceDistance to_face;
            Point foot;
            faces_.GetClosest(to_face, marker_, point, far_, distance, foot);
        }
        squares_ += distance * distance;
        largest_ = std::max(largest_, distance);
        ++count_;
    }

    Mesh& to_;
    double far_;  ///< more than any distance
    vcg::tri::FaceTmark<Mesh> marker_;
    vcg::GridStaticPtr<Face, double> faces_;
    vcg::GridStaticPtr<Vertex, double> points_;
    double squares_ = 0;
    double largest_ = 0;
    long count_ = 0;
};

/// Distances from \p from (its surface, or its points if it has no faces) to \p to.
void print_distance(const std::string& name, Mesh& from, Mesh& to, double unit) {
    Distances distances(to, 2 * (to.bbox.Diag() + from.bbox.Diag()));
    using Sampling = vcg::tri::SurfaceSampling<Mesh, Distances>;
    constexpr int kSamples = 200000;
    if (from.fn == 0)
        Sampling::AllVertex(from, distances);
    else
        Sampling::Montecarlo(from, distances, kSamples);
    print(("rms_" + name).c_str(), 100.0 * distances.rms() / unit);
    print(("max_" + name).c_str(), 100.0 * distances.largest() / unit);
}

void check(const std::string& path, const std::string& reference_path) {
    Mesh mesh;
    const int mask = load(mesh, path);
    std::cout.precision(9);
    std::cout << "{\"vertices\": " << mesh.vn;
    print("faces", mesh.fn);
    print("quality", (mask & Mask::IOM_VERTQUALITY) != 0);
    print("color", (mask & Mask::IOM_VERTCOLOR) != 0);
    print("selected", vcg::tri::UpdateSelection<Mesh>::VertexCount(mesh));
    if (mesh.fn > 0) print_topology(mesh);
    if (!reference_path.empty()) {
        Mesh reference;
        load(reference, reference_path);
        const double unit = reference.bbox.Diag();
        print_distance("to_mesh", reference, mesh, unit);
        print_distance("to_reference", mesh, reference, unit);
    }
    std::cout << "}\n";
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) {
        std::cerr << "Usage: check_mesh MESH [REFERENCE]\n";
        return 2;
    }
    try {
        check(argv[1], argc == 3 ? argv[2] : "");
        return 0;
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
