// SPDX-License-Identifier: Apache-2.0
// Assessments as bytes: in the journal, in the files of shards, and between ranks.
#pragma once

#include <vector>

#include "evolution/bytes.h"
#include "mercury/individual.h"

namespace mercury {

void encode(ByteWriter& writer, const Assessment& assessment);
// Throws DamagedBytes.
Assessment decode_assessment(ByteReader& reader);

void encode(ByteWriter& writer, const std::vector<Assessment>& assessments);
std::vector<Assessment> decode_assessments(ByteReader& reader);

}  // namespace mercury
