// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// Point to surface distance through vcglib's static grid.
#include "distance.h"

#include <vcg/complex/algorithms/closest.h>
#include <vcg/complex/algorithms/update/bounding.h>
#include <vcg/complex/algorithms/update/flag.h>
#include <vcg/complex/algorithms/update/normal.h>
#include <vcg/complex/complex.h>
#include <vcg/space/index/grid_static_ptr.h>

#include <cmath>

namespace neuralmesh {

namespace {

class SurfaceVertex;
class SurfaceFace;
struct SurfaceTypes
    : vcg::UsedTypes<vcg::Use<SurfaceVertex>::AsVertexType, vcg::Use<SurfaceFace>::AsFaceType> {};
class SurfaceVertex : public vcg::Vertex<SurfaceTypes, vcg::vertex::Coord3f, vcg::vertex::BitFlags> {};
class SurfaceFace : public vcg::Face<SurfaceTypes, vcg::face::VertexRef, vcg::face::Normal3f, vcg::face::Mark,
                                     vcg::face::BitFlags> {};
class Surface : public vcg::tri::TriMesh<std::vector<SurfaceVertex>, std::vector<SurfaceFace>> {};

void fill(const Network& network, Surface& surface) {
    vcg::tri::Allocator<Surface>::AddVertices(surface, static_cast<std::size_t>(network.slot_count()));
    for (VertexId v = 0; v < network.slot_count(); ++v)
        surface.vert[static_cast<std::size_t>(v)].P() = network.position(v);
    for (const Triangle& f : network.faces())
        vcg::tri::Allocator<Surface>::AddFace(surface, &surface.vert[static_cast<std::size_t>(f[0])],
                                              &surface.vert[static_cast<std::size_t>(f[1])],
                                              &surface.vert[static_cast<std::size_t>(f[2])]);
    vcg::tri::UpdateBounding<Surface>::Box(surface);
    vcg::tri::UpdateNormal<Surface>::PerFaceNormalized(surface);
}

}  // namespace

double rms_distance(const TargetSpace& target, const Network& network, int samples, Random& random) {
    Surface surface;
    fill(network, surface);
    vcg::GridStaticPtr<SurfaceFace, float> grid;
    grid.Set(surface.face.begin(), surface.face.end());
    vcg::face::PointDistanceBaseFunctor<float> distance_to;
    vcg::tri::FaceTmark<Surface> marker;
    marker.SetMesh(&surface);
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        const vcg::Point3f p = target.sample(random);
        vcg::Point3f nearest;
        float distance = 2;
        grid.GetClosest(distance_to, marker, p, 2.0F, distance, nearest);
        sum += static_cast<double>(distance) * static_cast<double>(distance);
    }
    return std::sqrt(sum / samples);
}

}  // namespace neuralmesh
