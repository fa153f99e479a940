// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <thread>

namespace mercury::test {

// Between two looks at what another thread or process does. A loop without it would keep a core from the other.
inline void nap() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

}  // namespace mercury::test
