// SPDX-License-Identifier: Apache-2.0
// Part of every program that is built with the address sanitizer. It informs the leak check about libraries of others.
#include <dlfcn.h>

// OSMesaDestroyContext does not free the picture that the context was made current with (Mesa 22.3). Open MPI keeps
// what it allocated (4.1); of texts that it formats only the C library's function is known. HDF5 1.10 keeps parts of
// files that it refuses.
extern "C" const char* __lsan_default_suppressions();
extern "C" [[gnu::weak]] const char* __lsan_default_suppressions() {
  return "leak:libOSMesa\n"
         "leak:libhdf5\n"
         "leak:libmpi\n"
         "leak:libopen-\n"
         "leak:openmpi\n"
         "leak:libpmix\n"
         "leak:libhwloc\n"
         "leak:__vasprintf_internal\n";
}
// Do not list suppressed leaks: tests compare stderr.
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }

// OpenGL drivers are unloaded with the last context. Memory that only their variables point to would then look leaked,
// so libraries stay loaded.
extern "C" int dlclose(void*) noexcept { return 0; }
