// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright the Neural Mesh authors

// run_library_host LIBMESHLAB_COMMON LIBRARY_HOST PLUGIN LAYER OUT [MODE]: lends the symbols of MeshLab's
// library to all that is loaded after it, as MeshLab's own program does, and starts library_host.cpp. Its
// operator new, from tests/memory, is everybody's, as the first one found.
#include <dlfcn.h>

#include <cstdio>

int main(int argc, char** argv) {
    if (argc < 6 || dlopen(argv[1], RTLD_NOW | RTLD_GLOBAL) == nullptr) {
        std::fprintf(stderr, "%s\n", argc < 6 ? "five files are needed" : dlerror());
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
