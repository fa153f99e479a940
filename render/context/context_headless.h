// SPDX-License-Identifier: Apache-2.0
// The kinds of context without a window, in the order in which make_context() tries them. All throw ContextError.
#pragma once

#include <memory>
#include <span>

#include "render/context/context.h"

namespace mercury::render {

std::unique_ptr<Context> make_egl_gpu_context(const ContextOptions& options);
std::unique_ptr<Context> make_egl_mesa_context(const ContextOptions& options);
std::unique_ptr<Context> make_osmesa_context(const ContextOptions& options);

// libepoxy's table of OpenGL functions, redirected for a context that libepoxy does not support.
struct GlPointer {
  const char* name;  // "glClear"
  void** pointer;    // where libepoxy keeps it
};

// Every function of epoxy/gl.h. The build generates the definition.
std::span<const GlPointer> gl_pointers();

}  // namespace mercury::render
