# SPDX-License-Identifier: Apache-2.0
# Installs BUILD into an empty PREFIX and looks for what must be there; PROGRAM says whether the program was built.
file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

foreach(file IN ITEMS include/mercury/simulation.h include/mercury/voxel.h)
  if(NOT EXISTS ${PREFIX}/${file})
    message(SEND_ERROR "${file} was not installed")
  endif()
endforeach()
file(GLOB_RECURSE sources ${PREFIX}/*.cpp ${PREFIX}/*.cu ${PREFIX}/*_test*)
if(sources)
  message(SEND_ERROR "these do not belong in an installation: ${sources}")
endif()

if(PROGRAM)
  execute_process(COMMAND ${PREFIX}/bin/mercury --version COMMAND_ERROR_IS_FATAL ANY)
endif()
