// SPDX-License-Identifier: Apache-2.0
// Assessments as bytes: in the journal, in the files of shards, and between ranks.
#pragma once

#include <vector>

#include "evolution/run_folder/record_bytes.h"
#include "mercury/individual.h"

namespace mercury {

void encode(RecordWriter& writer, const Assessment& assessment);
// Throws DamagedBytes.
Assessment decode_assessment(RecordReader& reader);

void encode(RecordWriter& writer, const std::vector<Assessment>& assessments);
std::vector<Assessment> decode_assessments(RecordReader& reader);

}  // namespace mercury
