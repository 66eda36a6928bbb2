// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// run_library_host LIBMESHLAB_COMMON LIBRARY_HOST PLUGIN OUT [MODE]: loads MeshLab's library with
// global symbols, as MeshLab's program does, then library_host.cpp, and starts it. The operator new of this
// program, from tests/memory, is found first and so replaces that of all libraries.
#include <dlfcn.h>

#include <cstdio>

int main(int argc, char** argv) {
    if (argc < 5 || dlopen(argv[1], RTLD_NOW | RTLD_GLOBAL) == nullptr) {
        std::fprintf(stderr, "%s\n",
                     argc < 5 ? "usage: run_library_host LIBMESHLAB_COMMON LIBRARY_HOST PLUGIN OUT [MODE]"
                              : dlerror());
        return 2;
    }
    void* host = dlopen(argv[2], RTLD_NOW | RTLD_GLOBAL);
    void* start = host == nullptr ? nullptr : dlsym(host, "library_host");
    if (start == nullptr) {
        std::fprintf(stderr, "%s\n", dlerror());
        return 2;
    }
    return reinterpret_cast<int (*)(int, char**)>(start)(argc, argv);
}
