# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Finds the MeshLab source trees to build for, and the vcglib that the core is compiled with.

if(DEFINED ENV{XDG_CACHE_HOME} AND NOT "$ENV{XDG_CACHE_HOME}" STREQUAL "")
    set(neuralmesh_cache "$ENV{XDG_CACHE_HOME}/neural-mesh")
else()
    set(neuralmesh_cache "$ENV{HOME}/.cache/neural-mesh")
endif()
set(NEURALMESH_CACHE "${neuralmesh_cache}" CACHE PATH
    "Where filter_neuralmesh/sources/fetch_meshlab.sh keeps MeshLab's sources")

# Sets ${result} to the release of the MeshLab source tree in ${dir}, or to nothing if it is none.
function(meshlab_version_of dir result)
    set(version "")
    if(EXISTS "${dir}/ML_VERSION" AND EXISTS "${dir}/src/common")
        file(STRINGS "${dir}/ML_VERSION" version LIMIT_COUNT 1)
        string(STRIP "${version}" version)
    endif()
    set(${result} "${version}" PARENT_SCOPE)
endfunction()

# Sets ${result} to the vcglib in a MeshLab source tree; its place depends on the release.
function(vcglib_of dir result)
    if(EXISTS "${dir}/src/vcglib/vcg/complex/complex.h")
        set(${result} "${dir}/src/vcglib" PARENT_SCOPE)
    elseif(EXISTS "${dir}/vcglib/vcg/complex/complex.h")
        set(${result} "${dir}/vcglib" PARENT_SCOPE)
    else()
        message(FATAL_ERROR "The MeshLab sources in ${dir} lack vcglib. Clone MeshLab with its submodules "
                            "(git submodule update --init --recursive) or unpack vcglib into src/vcglib.")
    endif()
endfunction()

set(core_meshlab "${NEURALMESH_CACHE}/meshlab-2025.07")
if(MESHLAB_SOURCE_DIR)
    meshlab_version_of("${MESHLAB_SOURCE_DIR}" found_version)
    if(NOT found_version)
        message(FATAL_ERROR "MESHLAB_SOURCE_DIR is ${MESHLAB_SOURCE_DIR}, which holds no MeshLab sources: "
                            "it has no file ML_VERSION or no folder src/common.")
    endif()
    set(core_meshlab "${MESHLAB_SOURCE_DIR}")
elseif(NOT EXISTS "${core_meshlab}/ML_VERSION")
    message(FATAL_ERROR "There are no MeshLab sources in ${NEURALMESH_CACHE}. Run `./run.sh build`, which "
                        "fetches them, or pass -DMESHLAB_SOURCE_DIR=DIR with the sources of your MeshLab.")
endif()

vcglib_of("${core_meshlab}" core_vcglib)
# A plugin contains the core's vcglib and the host's, which may be another release: the same function names with
# other definitions (2025.07 passes Point3 in registers, earlier releases in memory). So the core's vcglib is
# compiled in a namespace of its own.
add_library(neuralmesh_vcglib INTERFACE)
target_compile_definitions(neuralmesh_vcglib INTERFACE vcg=neuralmesh_vcg)
target_include_directories(neuralmesh_vcglib SYSTEM INTERFACE "${core_vcglib}")
