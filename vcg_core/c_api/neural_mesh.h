/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Copyright the Neural Mesh authors */

/* The core as a shared library for C, and its manual: a triangle mesh learned from a point cloud, the
   counters of a given mesh, and the distances of points from it. Plain C (C89), without C++ in the interface,
   so that any language can call it.

   An example
   ----------
   example.c in this folder reads points and writes a mesh as OBJ. In short:

       neural_mesh_task* task = neural_mesh_new(NEURAL_MESH_RECONSTRUCTION);
       neural_mesh_set(task, "target_vertices", 1000);
       neural_mesh_set_points(task, &points);
       if (neural_mesh_run(task, NULL, NULL, &result) != NEURAL_MESH_OK) puts(neural_mesh_error(task));
       ... result->positions, result->faces ...
       neural_mesh_free_result(result);
       neural_mesh_free(task);

   Compile with this header, link with the library libneural_mesh (neural_mesh.dll on Windows).

   Units and ranges
   ----------------
   Coordinates are finite numbers in any unit; the result has the same unit and place. Lengths of parameters
   are in that unit, angles in degrees. Parameters have the names, ranges, defaults and meanings that they
   have in MeshLab's filters; neural_mesh_parameters() lists them.

   Errors
   ------
   Functions that can fail return a status. neural_mesh_error() then has a sentence for the user: what is
   wrong, and what to do. No exception leaves the library, and it ends no process, prints nothing and reads
   no files. Doubts are no errors: the result has a message for each thing that was left out, opened, closed
   or not trusted.

   Threads and determinism
   -----------------------
   Tasks share nothing: several threads may run a task each at the same time. One task is for one thread at
   a time. The same input and parameters give the same bytes with any value of "threads", on x86-64 and
   arm64, on Linux, Windows and macOS, and as the filter in MeshLab: but that the filter keeps parameters
   that are real numbers in single precision.

   Versions
   --------
   Code that was compiled with this header works with any library whose neural_mesh_abi() is
   NEURAL_MESH_ABI. Later versions may add functions, parameters, figures and, at the end of structures that
   the library fills, members; then the number stays. */
#ifndef NEURAL_MESH_H
#define NEURAL_MESH_H

#include <stddef.h>

#ifndef NEURAL_MESH_API /* the library's build defines it, to export the functions */
#define NEURAL_MESH_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define NEURAL_MESH_ABI 1

/* The NEURAL_MESH_ABI of the library. */
NEURAL_MESH_API int neural_mesh_abi(void);

/* The version of the library, such as "1.0.0". */
NEURAL_MESH_API const char* neural_mesh_version(void);

/* What a function that can fail returns. */
enum {
    NEURAL_MESH_OK = 0,
    NEURAL_MESH_WRONG_PARAMETER = 1, /* unknown, out of its range, or does not go with the cloud */
    NEURAL_MESH_WRONG_INPUT = 2, /* there is no surface to learn, or a given mesh is no oriented manifold */
    NEURAL_MESH_NO_MEMORY = 3,
    NEURAL_MESH_WRONG_CALL = 4, /* arrays do not fit each other, or a pointer is missing */
    NEURAL_MESH_UNEXPECTED = 5  /* a defect of the library */
};

/* What a task does. */
enum {
    NEURAL_MESH_RECONSTRUCTION = 0, /* a mesh of a cloud, or of faces */
    NEURAL_MESH_COUNTERS = 1        /* how much of a feature each vertex of a given mesh is */
};

/* Parameters
   ---------- */

/* What the values of a parameter are. */
enum {
    NEURAL_MESH_BOOLEAN = 0, /* 0 or 1 */
    NEURAL_MESH_INTEGER = 1,
    NEURAL_MESH_REAL = 2,
    NEURAL_MESH_LENGTH = 3, /* a real number in the unit of the coordinates */
    NEURAL_MESH_CHOICE = 4  /* an index of choices */
};

typedef struct neural_mesh_parameter {
    const char* name;  /* as in the filters and their scripts */
    const char* label; /* as in the dialogs */
    const char* help;  /* sentences, UTF-8 */
    int kind;
    double low, high; /* the closed range of its values */
    double value;     /* the default */
    size_t choices;   /* how many names choice has; 0 for other kinds */
    const char* const* choice;
} neural_mesh_parameter;

/* The parameters of what a task does, in the order of the dialog; \p count gets their number. They live as
   long as the library. NULL if \p kind is none of those above, or memory runs out. The parameters of the
   filters that name layers, or what is selected in them, are missing: here arrays say that. */
NEURAL_MESH_API const neural_mesh_parameter* neural_mesh_parameters(int kind, size_t* count);

/* Tasks
   ----- */

/* What to learn, and how. */
typedef struct neural_mesh_task neural_mesh_task;

/* A task with the defaults; neural_mesh_free() frees it. NULL if \p kind is none of those above, or memory
   runs out. */
NEURAL_MESH_API neural_mesh_task* neural_mesh_new(int kind);

/* NULL is allowed. */
NEURAL_MESH_API void neural_mesh_free(neural_mesh_task* task);

/* The sentence of the last error of \p task, UTF-8; empty if the last call succeeded. Valid until the next
   call with the task. */
NEURAL_MESH_API const char* neural_mesh_error(const neural_mesh_task* task);

/* Sets a parameter. NEURAL_MESH_WRONG_PARAMETER if there is none of that name, or the value is out of its
   range or no whole number; the parameter then stays as it was. */
NEURAL_MESH_API int neural_mesh_set(neural_mesh_task* task, const char* name, double value);

/* What the values of an array are. */
enum {
    NEURAL_MESH_FLOAT = 0,  /* 32 bits */
    NEURAL_MESH_DOUBLE = 1, /* 64 bits */
    NEURAL_MESH_BYTE = 2,   /* unsigned, 0 to 255 */
    NEURAL_MESH_INT32 = 3,
    NEURAL_MESH_INT64 = 4
};

/* An array of rows of three values, in the caller's memory, at any alignment. */
typedef struct neural_mesh_array {
    const void* data; /* the first value of the first row */
    size_t rows;
    int type;
    ptrdiff_t row_step;   /* bytes from row to row, for rows without gaps three times the size of a value; may
                             be negative */
    ptrdiff_t value_step; /* bytes from value to value of a row; without gaps the size of a value */
} neural_mesh_array;

/* Each of these borrows memory: it must stay, unchanged, until neural_mesh_run() has returned or the array is
   set anew. NULL takes an array away. NEURAL_MESH_WRONG_CALL if the type is another than those named. */

/* The cloud: coordinates, float or double. With faces: their corners. */
NEURAL_MESH_API int neural_mesh_set_points(neural_mesh_task* task, const neural_mesh_array* points);

/* A colour for each point: red, green and blue as bytes. The mesh gets the colours of the cloud. */
NEURAL_MESH_API int neural_mesh_set_colors(neural_mesh_task* task, const neural_mesh_array* colors);

/* A normal for each point, of any length, float or double; zero vectors are none. They say which side of an
   open surface faces out. */
NEURAL_MESH_API int neural_mesh_set_normals(neural_mesh_task* task, const neural_mesh_array* normals);

/* Faces: three indices of points each, counting from 0. Points to learn are drawn from their area, unless the
   parameter draw_from_faces is 0. */
NEURAL_MESH_API int neural_mesh_set_faces(neural_mesh_task* task, const neural_mesh_array* faces);

/* A mesh, as positions and faces: of a reconstruction the one that learning starts from, if the parameter
   start_mesh is 2; of counters the one whose vertices get them. Faces are counter-clockwise seen from
   outside. Counters without points learn the faces of this mesh. */
NEURAL_MESH_API int neural_mesh_set_mesh(neural_mesh_task* task, const neural_mesh_array* positions,
                                         const neural_mesh_array* faces);

/* Results
   ------- */

/* One number about a run, such as "rms_error"; the names are those of the filters' results. */
typedef struct neural_mesh_figure {
    const char* name;
    double value;
    int is_count; /* 1: a whole number */
} neural_mesh_figure;

enum {
    NEURAL_MESH_NOTE = 0,
    NEURAL_MESH_WARNING = 1 /* a reason to look at the result */
};

/* A full sentence about a run, UTF-8. */
typedef struct neural_mesh_message {
    int kind;
    const char* text;
} neural_mesh_message;

/* A mesh, counter-clockwise seen from outside, and its report. Everything lives until
   neural_mesh_free_result(). Counters have no positions, faces, colours and creases: NULL. */
typedef struct neural_mesh_result {
    size_t vertex_count;
    size_t face_count;
    const double* positions; /* three per vertex, in the coordinates of the input */
    const int* faces;        /* three indices of vertices per face, counting from 0 */
    const float* quality;    /* per vertex, >= 0: the measure that the parameter feature_measure names */
    const unsigned char*
        features; /* per vertex: 1 if it is a feature, as select_by and feature_threshold say */
    const unsigned char* colors; /* three per vertex; NULL if the parameter vertex_color is 2 */

    /* The polylines of creases; none unless the parameter crease_lines is 1. */
    size_t crease_vertex_count;
    size_t crease_edge_count;
    const double* crease_positions; /* three per vertex of a crease */
    const int* crease_edges;        /* two indices of these vertices per edge */
    const float* crease_quality;    /* per vertex of a crease: the crease measure */

    size_t figure_count;
    const neural_mesh_figure* figures;
    size_t message_count;
    const neural_mesh_message* messages;
} neural_mesh_result;

/* Called on the thread that runs the task, about every thousand signals and at each stage: \p fraction of the
   run that is done, 0 to 1, never decreasing, and the current activity. Returns 1 to go on. If it returns 0,
   the run ends early with the valid mesh that it has; its figure "stop_reason" is 2. It must return: no
   exception and no longjmp may leave it. */
typedef int (*neural_mesh_progress)(void* context, double fraction, const char* activity);

/* Does what the task is for. \p progress may be NULL; \p context is passed to it. On success \p result gets
   what neural_mesh_free_result() frees, else NULL. The task can be changed and run again.

   Cost: on one thread 10,000 vertices of 100,000 points take some seconds, a million vertices of ten million
   points minutes. Points are copied, 12 bytes each; colours and normals take 3 bytes each. */
NEURAL_MESH_API int neural_mesh_run(neural_mesh_task* task, neural_mesh_progress progress, void* context,
                                    const neural_mesh_result** result);

/* NULL is allowed. */
NEURAL_MESH_API void neural_mesh_free_result(const neural_mesh_result* result);

/* Writes the distance of each of \p points, float or double, from the nearest face of the mesh that
   neural_mesh_set_mesh() has given; NaN if its coordinates are not finite. Of the parameters "threads" alone
   counts. The faces may be any triangles. \p distances has a value for each row, in the unit of the
   coordinates. The points may have any distance, and the mesh any place: the nearest face is found in single
   precision relative to the mesh, the distance from it is computed in double.

   Cost: the first call for a mesh copies and sorts it, for a million vertices in a second and to 270 MB; its
   arrays may be freed then. On one thread a million points take .3 s for 10,000 vertices, 2 s for a million,
   and up to 30 MB meanwhile. */
NEURAL_MESH_API int neural_mesh_distances(neural_mesh_task* task, const neural_mesh_array* points,
                                          double* distances);

#ifdef __cplusplus
}
#endif

#endif /* NEURAL_MESH_H */
