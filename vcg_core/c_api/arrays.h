// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The caller's arrays as what the core learns.
#pragma once

#include <vcg/space/point3.h>

#include <cstddef>
#include <initializer_list>

#include "vcg_core/base/error.h"
#include "vcg_core/c_api/neural_mesh.h"
#include "vcg_core/cloud/target_space.h"
#include "vcg_core/mesh/indexed_mesh.h"
#include "vcg_core/settings.h"

namespace neuralmesh::c_api {

/// The library was called in a wrong way.
class CallError : public Error {
public:
    using Error::Error;
};

/// A copy of \p given, or an array without rows for null. \param name what the sentence calls it \throws
/// CallError if its data are missing, or its type is none of \p types
neural_mesh_array checked(const neural_mesh_array* given, const char* name, std::initializer_list<int> types);

bool is_finite(const vcg::Point3d& p);
/// A row of an array of floats or doubles.
vcg::Point3d point(const neural_mesh_array& array, std::size_t row);

/// A cloud, or the faces between its points. Its arrays are checked(); those without rows were not given.
struct Cloud {
    neural_mesh_array points{}, colors{}, normals{}, faces{};
};

/// The same target space that a filter learns if a layer holds the same. \throws CallError if there is no row
/// of colours or normals for each point, InputError as TargetSpace does, and if a face names no point.
/// O(points + faces)
TargetSpace target_space_of(const Cloud& cloud, const Settings& settings);

/// \throws InputError if a face names no vertex, or one whose coordinates are not finite. O(vertices + faces)
IndexedMesh<double> indexed_mesh_of(const neural_mesh_array& positions, const neural_mesh_array& faces);

}  // namespace neuralmesh::c_api
