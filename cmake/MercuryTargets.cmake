# What every target of Mercury's own shares.
add_library(mercury_build_flags INTERFACE)
target_compile_features(mercury_build_flags INTERFACE cxx_std_20)
target_compile_options(mercury_build_flags INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow -Wno-missing-field-initializers>
  # One rounding for an equation on every machine: products and sums are fused only where the source says so.
  $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
  $<$<AND:$<BOOL:${MERCURY_WERROR}>,$<COMPILE_LANGUAGE:CXX>>:-Werror>)
if(MERCURY_SANITIZE)
  target_compile_options(mercury_build_flags INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${MERCURY_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all>)
  target_link_options(mercury_build_flags INTERFACE -fsanitize=${MERCURY_SANITIZE})
endif()

# mercury_add_library(NAME source...): the static library mercury_NAME, also known as mercury::NAME.
function(mercury_add_library name)
  add_library(mercury_${name} STATIC ${ARGN})
  add_library(mercury::${name} ALIAS mercury_${name})
  set_target_properties(mercury_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(mercury_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/mercury>)
  target_link_libraries(mercury_${name} PRIVATE $<BUILD_INTERFACE:mercury_build_flags>)
endfunction()

# mercury_add_executable(NAME source...)
function(mercury_add_executable name)
  add_executable(${name} ${ARGN})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE mercury_build_flags)
endfunction()
