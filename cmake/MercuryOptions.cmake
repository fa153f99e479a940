# SPDX-License-Identifier: Apache-2.0
include(GNUInstallDirs)

option(MERCURY_APP "Build the program mercury (needs OpenGL headers, CLI11, fmt, ...)" ON)
option(MERCURY_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(MERCURY_BENCH "Build the benchmarks" ${PROJECT_IS_TOP_LEVEL})
option(MERCURY_NN "Network robots; their exact geometry needs CGAL (its parts under the LGPL), GMP and MPFR" ON)
option(MERCURY_PYTHON "Build the Python package mercurysim (needs the Python package nanobind)" OFF)
option(MERCURY_MPI "Evolution on several hosts by MPI, if it is found" ON)
option(MERCURY_WERROR "Treat warnings in Mercury's own code as errors" ${PROJECT_IS_TOP_LEVEL})
set(MERCURY_CUDA "AUTO" CACHE STRING "CUDA backend: AUTO (if nvcc is found), ON (required), OFF")
set_property(CACHE MERCURY_CUDA PROPERTY STRINGS AUTO ON OFF)
set(MERCURY_SANITIZE "" CACHE STRING "Sanitizers for every target, for example address,undefined or thread")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
