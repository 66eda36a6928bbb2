# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

# Compiles for other systems with clang, libc++ and system headers as PyPI's `ziglang` packs them. NEURALMESH_ZIG is its
# program, NEURALMESH_ZIG_TARGET the target as zig names it, such as aarch64-linux-gnu.2.17. libc++ is linked statically.
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES NEURALMESH_ZIG NEURALMESH_ZIG_TARGET)
string(REGEX MATCH "^[^-]+" CMAKE_SYSTEM_PROCESSOR "${NEURALMESH_ZIG_TARGET}")
if(NEURALMESH_ZIG_TARGET MATCHES "-linux-")
    set(CMAKE_SYSTEM_NAME Linux)
elseif(NEURALMESH_ZIG_TARGET MATCHES "-windows-")
    set(CMAKE_SYSTEM_NAME Windows)
else()
    set(CMAKE_SYSTEM_NAME Darwin)
    set(CMAKE_OSX_SYSROOT "")  # zig has one of its own
endif()
set(CMAKE_C_COMPILER ${NEURALMESH_ZIG} cc -target ${NEURALMESH_ZIG_TARGET})
set(CMAKE_CXX_COMPILER ${NEURALMESH_ZIG} c++ -target ${NEURALMESH_ZIG_TARGET})
foreach(language C CXX)
    set(CMAKE_${language}_ARCHIVE_CREATE "\"${NEURALMESH_ZIG}\" ar qc <TARGET> <LINK_FLAGS> <OBJECTS>")
    set(CMAKE_${language}_ARCHIVE_FINISH "\"${NEURALMESH_ZIG}\" ranlib <TARGET>")
endforeach()
set(CMAKE_SHARED_LINKER_FLAGS_INIT "-s")  # without symbols of its own
# A program would be linked with a libc++ that is compiled for it, which takes minutes.
set(CMAKE_CXX_COMPILER_ID_TEST_FLAGS_FIRST -c)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
