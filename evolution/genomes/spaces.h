// SPDX-License-Identifier: Apache-2.0
// What the genome spaces share.
#pragma once

#include <cstdint>
#include <memory>

#include "mercury/genome.h"
#include "robots/bytes.h"

namespace mercury {

// The first two bytes of every genome: its kind and the version of its encoding.
void write_head(ByteWriter& writer, std::uint8_t tag);
// Throws InputError unless the bytes are of this kind, and of a version that this program knows.
void read_head(ByteReader& reader, std::uint8_t tag);

// Genomes of the muscles of given bodies: robots of any kind, whose materials alone change.
std::unique_ptr<GenomeSpace> make_given_body_space(const GenomeSpaceRequest& request);

}  // namespace mercury
