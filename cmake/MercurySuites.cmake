# SPDX-License-Identifier: Apache-2.0
# One test of ctest per suite of a program of GoogleTest. One process per test would take longer to start than most tests
# take. Tests on a CUDA device are a test of ctest of their own, SUITE/cuda, which is skipped where there is no device.
#
# mercury_discover_suites(TARGET LABEL): tests LABEL.SUITE, found by ctest when it starts.
function(mercury_discover_suites target label)
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites.cmake)
  file(GENERATE OUTPUT ${script} CONTENT
"set(program [[$<TARGET_FILE:${target}>]])
set(launcher [[${MERCURY_TEST_LAUNCHER}]])
set(label [[${label}]])
include([[${CMAKE_CURRENT_FUNCTION_LIST_FILE}]])
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()

if(DEFINED CMAKE_PROJECT_NAME)
  return()
endif()

# The rest is read by ctest.
if(NOT EXISTS ${program})
  add_test(${label}_NOT_BUILT ${program})
  return()
endif()
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "#[^\n]*" "" listing "${listing}")  # values of parameters, in which anything can stand
string(REGEX MATCHALL "[^\n]+" lines "${listing}")
set(suites)
foreach(line IN LISTS lines)
  if(line MATCHES "^([^ ]+)\\. *$")
    set(suite ${CMAKE_MATCH_1})
  elseif(line MATCHES "^  [^ ]+/cuda")
    list(APPEND suites ${suite}/cuda)
  elseif(line MATCHES "^  ")
    list(APPEND suites ${suite})
  endif()
endforeach()
list(REMOVE_DUPLICATES suites)
if(NOT suites)
  message(FATAL_ERROR "${program} lists no tests")
endif()
foreach(suite IN LISTS suites)
  if(suite MATCHES "^(.*)/cuda$")
    set(filter "${CMAKE_MATCH_1}.*/cuda*")
  else()
    set(filter "${suite}.*-*/cuda*")
  endif()
  set(test ${label}.${suite})
  add_test(${test} ${launcher} ${program} --gtest_filter=${filter})
  # Skipped means that every test of the suite was. A filter without tests is a mistake, and so is a test that ends the
  # program, whatever its exit status.
  set_tests_properties(${test} PROPERTIES LABELS ${label}
    SKIP_REGULAR_EXPRESSION "PASSED  \\] 0 tests\\.\n\\[  SKIPPED \\] [0-9]+ tests?, listed below:\n(\\[  SKIPPED \\][^\n]*\n)*$"
    FAIL_REGULAR_EXPRESSION "Running 0 tests;\\[ RUN      \\] [^\n]*\n([^[\n][^\n]*\n|\n)*$")
endforeach()
