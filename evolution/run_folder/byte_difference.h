// SPDX-License-Identifier: Apache-2.0
// What differs between two strings of bytes that are alike at the same places.
#pragma once

#include <string>
#include <string_view>

namespace mercury {

// Turns `base` into `target`: pairs of (how many bytes to copy from the base, new bytes that replace as many of it);
// then the rest of the base follows, up to the target's length. Numbers are LEB128.
std::string difference_of(std::string_view base, std::string_view target);

// The target. Throws DamagedBytes for bytes that are no difference from this base.
std::string with_difference(std::string_view base, std::string_view difference);

}  // namespace mercury
