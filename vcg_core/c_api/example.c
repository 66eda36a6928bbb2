/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Copyright the Neural Mesh authors */

/* Reads points, three numbers each, and writes a mesh of them as OBJ:
       example 1000 < points.xyz > mesh.obj
   It is the example of neural_mesh.h, in C89. */
#include <neural_mesh.h>
#include <stdio.h>
#include <stdlib.h>

/* Shows what the run does. It could stop it by returning 0. */
static int show_progress(void* context, double fraction, const char* activity) {
    (void)context;
    fprintf(stderr, "\r%3.0f %%  %-60.60s", 100 * fraction, activity);
    return 1;
}

/* The coordinates in a file, three for each of *count points. The caller frees them. */
static double* read_points(FILE* file, size_t* count) {
    double* points = NULL;
    double p[3];
    for (*count = 0; fscanf(file, "%lf %lf %lf", &p[0], &p[1], &p[2]) == 3; ++*count) {
        double* more = points;
        if ((*count & (*count - 1)) == 0) /* a power of 2: as many again */
            more = (double*)realloc(points, (*count == 0 ? 1 : 2 * *count) * sizeof p);
        if (more == NULL) {
            free(points);
            return NULL;
        }
        points = more;
        points[3 * *count] = p[0];
        points[3 * *count + 1] = p[1];
        points[3 * *count + 2] = p[2];
    }
    return points;
}

static void write_obj(FILE* file, const neural_mesh_result* mesh) {
    size_t i;
    for (i = 0; i < mesh->vertex_count; ++i) {
        const double* p = mesh->positions + 3 * i;
        fprintf(file, "v %.9g %.9g %.9g\n", p[0], p[1], p[2]);
    }
    for (i = 0; i < mesh->face_count; ++i) {
        const int* face = mesh->faces + 3 * i;
        fprintf(file, "f %d %d %d\n", face[0] + 1, face[1] + 1, face[2] + 1);
    }
}

/* What a run tells besides the mesh. */
static void write_report(FILE* file, const neural_mesh_result* mesh) {
    size_t i;
    fputc('\n', file);
    for (i = 0; i < mesh->figure_count; ++i)
        fprintf(file, "%s=%.6g ", mesh->figures[i].name, mesh->figures[i].value);
    fputc('\n', file);
    for (i = 0; i < mesh->message_count; ++i)
        fprintf(file, "%s%s\n", mesh->messages[i].kind == NEURAL_MESH_WARNING ? "warning: " : "",
                mesh->messages[i].text);
}

int main(int argc, char** argv) {
    neural_mesh_array points;
    const neural_mesh_result* mesh = NULL;
    double* coordinates = read_points(stdin, &points.rows);
    neural_mesh_task* task = neural_mesh_new(NEURAL_MESH_RECONSTRUCTION);
    int status = neural_mesh_set(task, "target_vertices", argc > 1 ? atof(argv[1]) : 1000);

    points.data = coordinates;
    points.type = NEURAL_MESH_DOUBLE;
    points.row_step = 3 * sizeof(double);
    points.value_step = sizeof(double);
    if (status == NEURAL_MESH_OK) status = neural_mesh_set_points(task, &points);
    if (status == NEURAL_MESH_OK) status = neural_mesh_run(task, show_progress, NULL, &mesh);
    if (status == NEURAL_MESH_OK) {
        write_obj(stdout, mesh);
        write_report(stderr, mesh);
    } else {
        fprintf(stderr, "%s\n", neural_mesh_error(task));
    }
    neural_mesh_free_result(mesh);
    neural_mesh_free(task);
    free(coordinates);
    return status == NEURAL_MESH_OK ? 0 : 1;
}
