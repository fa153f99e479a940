// SPDX-License-Identifier: Apache-2.0
// Several backends as one: a batch is shared out over them in equal parts, and they step at the same time.
#pragma once

#include "sim/backend.h"

namespace mercury {

// At least one part. A robot's results are those of its part, so splitting changes no bit of them.
std::unique_ptr<Backend> make_split_backend(std::vector<std::unique_ptr<Backend>> parts);

}  // namespace mercury
