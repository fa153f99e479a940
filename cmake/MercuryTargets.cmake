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

# mercury_add_library(NAME source...): the static library mercury_NAME, also known as mercury::NAME.
function(mercury_add_library name)
  add_library(mercury_${name} STATIC ${ARGN})
  add_library(mercury::${name} ALIAS mercury_${name})
  set_target_properties(mercury_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(mercury_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_features(mercury_${name} PUBLIC cxx_std_20)
  target_link_libraries(mercury_${name} PRIVATE $<BUILD_INTERFACE:mercury_build_flags>)
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
