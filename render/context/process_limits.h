// SPDX-License-Identifier: Apache-2.0
// Limits of the process that end drawing on the processor by a crash or make it wait for ever.
#pragma once

namespace mercury::render {

// Throws ContextError if too little memory (ulimit -v, ulimit -d) or too few threads (ulimit -u) are left for Mesa.
void require_room_to_draw();

}  // namespace mercury::render
