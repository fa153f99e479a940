// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mercury/run_folder.h"

namespace mercury {

// Writes the champion of each generation that has another one than the previous generation, unless its file is there:
// best/GENERATION-ID.json. A champion that cannot be grown has none.
void write_champions(const RunHistory& run);

}  // namespace mercury
