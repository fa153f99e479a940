# SPDX-License-Identifier: Apache-2.0
# Flags of all targets of Mercury.
set(mercury_warnings -Wall -Wextra -Wconversion -Wshadow -Wno-missing-field-initializers)
list(JOIN mercury_warnings "," mercury_warnings_from_nvcc)

add_library(mercury_build_flags INTERFACE)
target_compile_features(mercury_build_flags INTERFACE cxx_std_20)
target_compile_options(mercury_build_flags INTERFACE
  "$<$<COMPILE_LANGUAGE:CXX>:${mercury_warnings}>"
  "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=${mercury_warnings_from_nvcc}>"
  # The same rounding on every machine: products and sums are fused only where the source says so.
  $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
  $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-ffp-contract=off>)
# GCC 13 reports every reference that a call with a temporary argument returns as dangling.
target_compile_options(mercury_build_flags INTERFACE
  $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>:-Wno-dangling-reference>)
# Sources that are compiled together see the names of each other's files.
if(MERCURY_UNITY)
  target_compile_options(mercury_build_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-shadow>
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wshadow=local> $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
endif()
if(MERCURY_WERROR)
  target_compile_options(mercury_build_flags INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-Werror>
    "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Werror;-Werror=all-warnings>")
endif()
if(MERCURY_SANITIZE)
  target_compile_options(mercury_build_flags INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${MERCURY_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all>)
  target_link_options(mercury_build_flags INTERFACE -fsanitize=${MERCURY_SANITIZE})
  # The compiler loses track of initialization in code that it has instrumented.
  target_compile_options(mercury_build_flags INTERFACE
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-maybe-uninitialized>)
endif()

# GCC finds overlaps and bounds in the standard library's texts where there are none (its bugs 105329, 105651), more of
# them with precompiled headers.
target_compile_options(mercury_build_flags INTERFACE
  "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")

# Precompiled headers of other people's libraries: without them, the standard library's are most of what the compiler
# reads. No header of ours is among them, so a change of ours rebuilds no more than it must. MERCURY_PCH=OFF shows
# includes that a file lacks.
set(mercury_standard_headers
  <algorithm> <array> <atomic> <charconv> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map>
  <memory> <mutex> <numeric> <optional> <random> <ranges> <set> <span> <sstream> <stdexcept> <string> <string_view>
  <thread> <tuple> <unordered_map> <utility> <variant> <vector>)

# mercury_precompile(NAME LIBRARY|PROGRAM header... [LIBRARIES...]): the target mercury_pch_NAME, whose precompiled
# headers others of its kind use by mercury_use_precompiled(TARGET NAME).
function(mercury_precompile name kind)
  if(NOT MERCURY_PCH)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "LIBRARIES")
  set(source ${PROJECT_BINARY_DIR}/precompiled/${name}.cpp)
  if(kind STREQUAL PROGRAM)
    file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
    add_executable(mercury_pch_${name} ${source})  # position-independent as programs are, not as libraries are
  else()
    file(CONFIGURE OUTPUT ${source} CONTENT "")
    add_library(mercury_pch_${name} OBJECT ${source})
  endif()
  target_link_libraries(mercury_pch_${name} PRIVATE mercury_build_flags ${arg_LIBRARIES})
  target_precompile_headers(mercury_pch_${name} PRIVATE ${mercury_standard_headers} ${arg_UNPARSED_ARGUMENTS})
endfunction()
function(mercury_use_precompiled target name)
  if(MERCURY_PCH)
    target_precompile_headers(${target} REUSE_FROM mercury_pch_${name})
  endif()
endfunction()

mercury_precompile(library LIBRARY)

# mercury_add_library(NAME source...): the static library mercury_NAME, also known as mercury::NAME.
function(mercury_add_library name)
  add_library(mercury_${name} STATIC ${ARGN})
  add_library(mercury::${name} ALIAS mercury_${name})
  set_target_properties(mercury_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(mercury_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_features(mercury_${name} PUBLIC cxx_std_20)
  target_link_libraries(mercury_${name} PRIVATE $<BUILD_INTERFACE:mercury_build_flags>)
  if(name MATCHES "^app_")
    mercury_use_precompiled(mercury_${name} app)
  else()
    mercury_use_precompiled(mercury_${name} library)
  endif()
endfunction()

# mercury_add_executable(NAME source...)
function(mercury_add_executable name)
  add_executable(${name} ${ARGN})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE mercury_build_flags)
  if(MERCURY_SANITIZE MATCHES "address|leak")
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/foreign_leaks.cpp)
  elseif(MERCURY_SANITIZE MATCHES "thread")
    target_sources(${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/foreign_races.cpp)
  endif()
endfunction()

# mercury_sanitized_python(VARIABLE): the environment in which an interpreter loads a sanitized module. The interpreter is not
# instrumented: it loads the sanitizer first, and keeps memory to its end.
function(mercury_sanitized_python variable)
  set(${variable} "" PARENT_SCOPE)
  if(NOT MERCURY_SANITIZE MATCHES "address")
    return()
  endif()
  foreach(library asan stdc++)
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=lib${library}.so
      OUTPUT_VARIABLE path OUTPUT_STRIP_TRAILING_WHITESPACE)
    list(APPEND libraries ${path})
  endforeach()
  list(JOIN libraries " " libraries)
  set(${variable} "LD_PRELOAD=${libraries}" ASAN_OPTIONS=detect_leaks=0 PARENT_SCOPE)
endfunction()

# mercury_embed_files(RESULT FILES HEADER NAMESPACE FUNCTION): a source with the contents of the files, for
# FUNCTION() of the header; its name is in RESULT.
function(mercury_embed_files result files header namespace function)
  list(JOIN files "|" joined)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
  add_custom_command(OUTPUT ${source}
    COMMAND ${CMAKE_COMMAND} -D "FILES=${joined}" -D HEADER=${header} -D NAMESPACE=${namespace} -D FUNCTION=${function}
      -D OUTPUT=${source} -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/EmbedFiles.cmake
    COMMENT "Embedding files for ${header}" VERBATIM)
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${files}")
  set(${result} ${source} PARENT_SCOPE)
endfunction()
