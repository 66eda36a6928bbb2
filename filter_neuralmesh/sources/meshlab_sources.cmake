# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Which MeshLab source trees there are, and the vcglib the core is compiled against.

if(DEFINED ENV{XDG_CACHE_HOME} AND NOT "$ENV{XDG_CACHE_HOME}" STREQUAL "")
    set(neuralmesh_cache "$ENV{XDG_CACHE_HOME}/neural-mesh")
else()
    set(neuralmesh_cache "$ENV{HOME}/.cache/neural-mesh")
endif()
set(NEURALMESH_CACHE "${neuralmesh_cache}" CACHE PATH
    "Where filter_neuralmesh/fetch_meshlab.sh keeps MeshLab's sources")

# Sets ${result} to the release of the MeshLab source tree in ${dir}, empty if it is none.
function(meshlab_version_of dir result)
    set(version "")
    if(EXISTS "${dir}/ML_VERSION" AND EXISTS "${dir}/src/common")
        file(STRINGS "${dir}/ML_VERSION" version LIMIT_COUNT 1)
        string(STRIP "${version}" version)
    endif()
    set(${result} "${version}" PARENT_SCOPE)
endfunction()

# Sets ${result} to the vcglib inside a MeshLab source tree; releases keep it in two places.
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
                            "a file ML_VERSION and a folder src/common are expected there.")
    endif()
    set(core_meshlab "${MESHLAB_SOURCE_DIR}")
elseif(NOT EXISTS "${core_meshlab}/ML_VERSION")
    message(FATAL_ERROR "There are no MeshLab sources in ${NEURALMESH_CACHE}. Run `./run.sh build`, which "
                        "fetches them, or pass -DMESHLAB_SOURCE_DIR=DIR with the sources of your MeshLab.")
endif()

vcglib_of("${core_meshlab}" core_vcglib)
# In a plugin the core meets the host's vcglib, another release with the same names for functions that differ
# (Point3 is passed in registers by 2025.07, in memory by its elders): so the core's goes by another name.
add_library(neuralmesh_vcglib INTERFACE)
target_compile_definitions(neuralmesh_vcglib INTERFACE vcg=neuralmesh_vcg)
target_include_directories(neuralmesh_vcglib SYSTEM INTERFACE "${core_vcglib}")
