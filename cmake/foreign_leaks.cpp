// SPDX-License-Identifier: Apache-2.0
// A part of every program that is built with the address sanitizer: what its search for lost memory must know of
// libraries that are not ours.
#include <dlfcn.h>

// OSMesaDestroyContext keeps the picture that the context was made current with (Mesa 22.3).
extern "C" const char* __lsan_default_suppressions();
extern "C" [[gnu::weak]] const char* __lsan_default_suppressions() { return "leak:libOSMesa"; }
// What it passes over is not told, as stderr is ours.
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }

// OpenGL drivers are unloaded with the last context, and what their variables pointed to would then seem lost. So
// libraries stay loaded.
extern "C" int dlclose(void*) noexcept { return 0; }
