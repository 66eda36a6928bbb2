// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// How far points are from a mesh.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>

#include "vcg_core/base/thread_team.h"
#include "vcg_core/c_api/neural_mesh.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/face_tree.h"
#include "vcg_core/mesh/indexed_mesh.h"

namespace neuralmesh::c_api {

/// A mesh, which need not be a manifold, for any number of points. The nearest face is found in single
/// precision, in the frame of the mesh; the distance from it is computed in double.
class DistanceSearch {
public:
    /// \throws InputError if the mesh has no faces, or is too large or too small for double precision.
    /// O(faces log faces)
    DistanceSearch(IndexedMesh<double> mesh, ThreadTeam& team);

    /// Writes the distance of each point to \p distances, NaN if its coordinates are not finite. Does not
    /// depend on the number of threads. Memory: up to 30 MB, however many the points. O(points x log faces)
    void measure(const neural_mesh_array& points, ThreadTeam& team, double* distances) const;

private:
    void measure_block(const neural_mesh_array& points, std::size_t begin, std::size_t end, ThreadTeam& team,
                       double* distances) const;
    /// \p p is in the frame.
    double distance_from(int face, const vcg::Point3d& p) const;

    Frame frame_;
    IndexedMesh<double> mesh_;  ///< in the frame
    FaceTree tree_;
};

}  // namespace neuralmesh::c_api
