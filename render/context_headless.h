// SPDX-License-Identifier: Apache-2.0
// The kinds of context without a window, in the order in which make_context() tries them. All throw ContextError.
#pragma once

#include <memory>

#include "render/context.h"

namespace mercury::render {

std::unique_ptr<Context> make_egl_gpu_context(const ContextOptions& options);
std::unique_ptr<Context> make_egl_mesa_context(const ContextOptions& options);
std::unique_ptr<Context> make_osmesa_context(const ContextOptions& options);

}  // namespace mercury::render
