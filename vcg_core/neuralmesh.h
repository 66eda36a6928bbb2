// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// The core in one include, and its manual: a library that learns a triangle mesh from a point cloud, in
// C++17 on Eigen and vcglib, without Qt, MeshLab headers, files or output.
//
// An example
// ----------
// Reads points, three numbers each, and writes a mesh of 1,000 vertices as OBJ:
//
// ```cpp
// void mesh_of_points(std::istream& in, std::ostream& out) {
//     std::vector<vcg::Point3d> cloud;
//     for (vcg::Point3d p; in >> p[0] >> p[1] >> p[2];) cloud.push_back(p);
//     neuralmesh::Settings settings;
//     settings.target_vertices = 1000;
//     const auto points = neuralmesh::TargetSpace::points(cloud.size(), [&](auto i) { return cloud[i]; });
//     neuralmesh::NoProgress progress;
//     const neuralmesh::NeuralMesh mesh = neuralmesh::reconstruct(points, settings, progress);
//     for (const auto& p : mesh.positions) out << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
//     for (const auto& [a, b, c] : mesh.faces) out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
// }
// ```
//
// In CMake, with the project in the folder neural-mesh; vcglib is that of the MeshLab sources which
// MESHLAB_SOURCE_DIR names, or which `./run.sh build` has fetched:
//
//     set(NEURALMESH_PLUGINS OFF)
//     set(NEURALMESH_TESTS OFF)
//     add_subdirectory(neural-mesh EXCLUDE_FROM_ALL)
//     target_link_libraries(program PRIVATE neuralmesh_core neuralmesh_vcglib)
//
// neuralmesh_vcglib are the headers of that vcglib. A caller with a vcglib of its own leaves it out and
// converts its meshes by mesh_io.h alone.
//
// What it does
// ------------
// reconstruct() makes an oriented manifold mesh of what a TargetSpace draws. It has exactly
// settings.target_vertices vertices, unless report.stop_reason says otherwise: dense where the surface bends,
// sparse where it is flat, with boundaries where the points end. The points need no normals.
// mesh_counters() measures how much of a feature each vertex of a given mesh is.
//
// Input, one of these:
//   TargetSpace::points()     a cloud
//   TargetSpace::triangles()  faces; points are drawn from their area
//   TargetSpace::drawn_by()   a function of the caller's that draws points, say of an implicit surface
//   target_space_of()         a vcg mesh of any type with its matrix, as mesh_io.h says; write_mesh() and
//                             write_creases() fill such meshes with the result
//
// Output: NeuralMesh of result.h. Positions, and faces that are counter-clockwise seen from outside; for
// each vertex its counter, whether it is a feature, and a colour; the creases, if settings.crease_lines is
// on; and a Report with the figures of the run.
//
// Units and ranges
// ----------------
// Coordinates are finite doubles in any unit; the result has the same unit and place. Only their ratios
// matter: the core computes in a frame of its own, whose bounding box has the diagonal 1, in single
// precision. Lengths in Settings are in the unit of the input, angles are in degrees, Report::rms_error is
// in % of the diagonal of the learned points. setting_table() has the range and the meaning of each
// parameter, which reconstruct() checks; counter_table() has those of mesh_counters(). A caller needs
// target_vertices or target_error, and perhaps surface, close_holes_up_to and remove_outliers.
//
// Errors
// ------
// Each is an Error whose what() can be shown to the user: what is wrong with which input, and what to do.
//   SettingError    a parameter is out of its range, or does not go with the cloud
//   InputError      there is no surface to learn: coordinates are not finite, fewer than four points are
//                   distinct, or all lie on a line; or a given mesh is no oriented manifold
// Besides these std::bad_alloc. Doubts are no errors: Report::warnings has a sentence for each thing that
// was left out, opened, closed or not trusted.
//
// Progress
// --------
// A Progress is called on the caller's thread with the fraction done and the current activity. If it returns
// false, the run ends early and returns the valid mesh it has.
//
// Cost
// ----
// Time grows in proportion to the vertices from 5,000 on, and with the points for the survey of the cloud
// and the fit: on one thread 10,000 vertices of 100,000 points take 3 s, on two a million vertices of ten
// million points 4 minutes. reconstruct.h and mesh_counters.h say what memory they take.
//
// Threads and determinism
// -----------------------
// settings.threads threads work on a run, 0: one per core. The same target and settings give the same bytes
// with any number of them, on x86-64 and arm64, on Linux and Windows. Runs share nothing: several threads
// may call reconstruct() at the same time, each with a TargetSpace and a Progress of its own.
#pragma once

#include "vcg_core/base/error.h"
#include "vcg_core/base/progress.h"
#include "vcg_core/mesh_counters.h"
#include "vcg_core/mesh_io.h"
#include "vcg_core/reconstruct.h"
#include "vcg_core/result.h"
#include "vcg_core/settings.h"
