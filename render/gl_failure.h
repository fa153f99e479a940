// SPDX-License-Identifier: Apache-2.0
// Failures that OpenGL reports only when it is asked.
#pragma once

namespace mercury::render {

// Throws ContextError, with one line, if the current context has run out of memory or has lost its GPU since the
// last call: what was drawn since then is wrong. Other errors are for Context::take_messages().
void throw_if_gl_failed();

}  // namespace mercury::render
