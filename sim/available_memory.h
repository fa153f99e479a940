// SPDX-License-Identifier: Apache-2.0
// Memory that this process may still take.
#pragma once

#include <cstddef>

namespace mercury {

// Of the host: what Linux calls available, or what the limit of the control group (container) leaves, if that is less
// [bytes].
std::size_t available_host_memory();

}  // namespace mercury
