/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Copyright the Neural Mesh authors */

/* Learns the cloud in a file of library_clouds.py by the shared library, for systems on which Python cannot be run here:
       run_cloud CLOUD RESULT
   CLOUD:  the number of parameters, and of each a name of 32 bytes and a double; then points, colours, normals and faces,
           of each the type and the number of rows, and the rows without gaps.
   RESULT: of each array of the mesh its size in bytes, -1 if there is none, and its bytes. Numbers are of 32 bits. */
#include <neural_mesh.h>
#include <stdio.h>
#include <stdlib.h>

static void fail(const char* sentence) {
    fprintf(stderr, "%s\n", sentence);
    exit(1);
}

static void read_bytes(FILE* file, void* bytes, size_t size) {
    if (size > 0 && fread(bytes, size, 1, file) != 1) fail("The cloud is cut short.");
}

static int read_int(FILE* file) {
    int value;
    read_bytes(file, &value, sizeof value);
    return value;
}

static void set_parameters(FILE* file, neural_mesh_task* task) {
    int left;
    for (left = read_int(file); left > 0; --left) {
        char name[32];
        double value;
        read_bytes(file, name, sizeof name);
        read_bytes(file, &value, sizeof value);
        if (neural_mesh_set(task, name, value) != NEURAL_MESH_OK) fail(neural_mesh_error(task));
    }
}

/* Its memory is freed by the system. */
static void set_array(FILE* file, neural_mesh_task* task,
                      int (*set)(neural_mesh_task*, const neural_mesh_array*)) {
    neural_mesh_array array;
    size_t size;
    void* data;
    array.type = read_int(file);
    array.rows = (size_t)read_int(file);
    size = array.type == NEURAL_MESH_BYTE                                    ? 1
           : array.type == NEURAL_MESH_FLOAT || array.type == NEURAL_MESH_INT32 ? 4
                                                                                : 8;
    data = malloc(3 * size * array.rows + 1);
    if (data == NULL) fail("There is not enough memory.");
    read_bytes(file, data, 3 * size * array.rows);
    array.data = data;
    array.value_step = (ptrdiff_t)size;
    array.row_step = 3 * array.value_step;
    if (array.rows > 0 && set(task, &array) != NEURAL_MESH_OK) fail(neural_mesh_error(task));
}

static void write_array(FILE* file, const void* data, size_t size) {
    const int head = data == NULL ? -1 : (int)size;
    if (fwrite(&head, sizeof head, 1, file) != 1) fail("The result cannot be written.");
    if (data != NULL && fwrite(data, size, 1, file) != 1) fail("The result cannot be written.");
}

static void write_result(FILE* file, const neural_mesh_result* mesh) {
    write_array(file, mesh->positions, mesh->vertex_count * 24);
    write_array(file, mesh->faces, mesh->face_count * 12);
    write_array(file, mesh->quality, mesh->vertex_count * 4);
    write_array(file, mesh->features, mesh->vertex_count);
    write_array(file, mesh->colors, mesh->vertex_count * 3);
    write_array(file, mesh->crease_positions, mesh->crease_vertex_count * 24);
    write_array(file, mesh->crease_edges, mesh->crease_edge_count * 8);
    write_array(file, mesh->crease_quality, mesh->crease_vertex_count * 4);
}

int main(int argc, char** argv) {
    const neural_mesh_result* mesh;
    neural_mesh_task* task = neural_mesh_new(NEURAL_MESH_RECONSTRUCTION);
    FILE* cloud = argc == 3 ? fopen(argv[1], "rb") : NULL;
    FILE* result = argc == 3 ? fopen(argv[2], "wb") : NULL;
    if (cloud == NULL || result == NULL || task == NULL) fail("Usage: run_cloud CLOUD RESULT");
    if (neural_mesh_abi() != NEURAL_MESH_ABI) fail("The library has another interface.");
    set_parameters(cloud, task);
    set_array(cloud, task, neural_mesh_set_points);
    set_array(cloud, task, neural_mesh_set_colors);
    set_array(cloud, task, neural_mesh_set_normals);
    set_array(cloud, task, neural_mesh_set_faces);
    if (neural_mesh_run(task, NULL, NULL, &mesh) != NEURAL_MESH_OK) fail(neural_mesh_error(task));
    write_result(result, mesh);
    neural_mesh_free_result(mesh);
    neural_mesh_free(task);
    return fclose(result) == 0 ? 0 : 1;
}
