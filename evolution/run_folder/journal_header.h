// SPDX-License-Identifier: Apache-2.0
// The header of a journal: "mercury-genomes\n"; u32 version; u32 0; u64 fingerprint of the run's settings; u64 checksum
// of all that.
#pragma once

#include <cstddef>
#include <string_view>

namespace mercury {

inline constexpr std::string_view journal_mark = "mercury-genomes\n";
inline constexpr std::size_t journal_header_size = 40;  // bytes

}  // namespace mercury
