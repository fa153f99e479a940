// SPDX-License-Identifier: Apache-2.0
// The first two bytes of every genome: its kind and the version of its encoding.
#pragma once

#include "evolution/bytes.h"

namespace mercury {

void write_head(ByteWriter& writer, std::uint8_t tag);
// Throws InputError unless the bytes are of this kind, and of a version that this program knows.
void read_head(ByteReader& reader, std::uint8_t tag);

}  // namespace mercury
