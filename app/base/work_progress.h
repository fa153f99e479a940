// SPDX-License-Identifier: Apache-2.0
// Long functions of the libraries, watched by a command.
#pragma once

#include "mercury/work_watch.h"

namespace mercury {

// A watch that shows the progress on standard error, and throws Interrupted after the first Ctrl-C. Copies share what
// they show.
WorkWatch shown_work();

}  // namespace mercury
