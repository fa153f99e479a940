// SPDX-License-Identifier: Apache-2.0
// How a caller watches a function that may take long: making many robots, loading them into a batch.
#pragma once

#include <cstddef>
#include <functional>

namespace mercury {

// Called now and then by one thread at a time, not always the same: what is being done ("arranging robots"), and for
// how many of `total` it is done. It may throw: the function then gives up, and passes the exception on.
using WorkWatch = std::function<void(const char* what, std::size_t done, std::size_t total)>;

}  // namespace mercury
