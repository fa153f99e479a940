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
  foreach(file IN ITEMS man/man1/mercury.1 man/man1/mercury-run.1 man/man1/mercury-new-voxel.1
      bash-completion/completions/mercury zsh/site-functions/_mercury fish/vendor_completions.d/mercury.fish)
    set(size 0)
    if(EXISTS ${PREFIX}/share/${file})
      file(SIZE ${PREFIX}/share/${file} size)
    endif()
    if(size EQUAL 0)
      message(SEND_ERROR "share/${file} was not installed, or is empty")
    endif()
  endforeach()
  # The samples are those beside the program, not those of the sources.
  execute_process(COMMAND ${PREFIX}/bin/mercury run sample:eel --seconds 0 --device cpu --csv -
    OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  string(FIND "${text}" "${PREFIX}/share/mercury/robots/eel.json" place)
  if(place EQUAL -1)
    message(SEND_ERROR "mercury run sample:eel does not read the installed sample: ${text}")
  endif()
endif()
