// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/assessment_bytes.h"

namespace mercury {
namespace {

constexpr std::uint8_t last_fate = static_cast<std::uint8_t>(Fate::failed);
constexpr std::size_t smallest_assessment = 25;  // bytes

}  // namespace

void encode(ByteWriter& writer, const Assessment& assessment) {
  writer.add(static_cast<std::uint8_t>(assessment.fate));
  writer.text(assessment.problem);
  writer.numbers(assessment.scores);
  writer.numbers(assessment.values);
  writer.numbers(assessment.interim_scores);
  writer.add(assessment.hash);
}

Assessment decode_assessment(ByteReader& reader) {
  Assessment assessment;
  const auto fate = reader.read<std::uint8_t>();
  if (fate > last_fate) throw DamagedBytes("an individual has an unknown fate");
  assessment.fate = static_cast<Fate>(fate);
  assessment.problem = reader.text();
  assessment.scores = reader.numbers<double>();
  assessment.values = reader.numbers<double>();
  assessment.interim_scores = reader.numbers<double>();
  assessment.hash = reader.read<std::uint64_t>();
  return assessment;
}

void encode(ByteWriter& writer, const std::vector<Assessment>& assessments) {
  writer.count(assessments.size());
  for (const Assessment& assessment : assessments) encode(writer, assessment);
}

std::vector<Assessment> decode_assessments(ByteReader& reader) {
  std::vector<Assessment> assessments(reader.count(smallest_assessment));
  for (Assessment& assessment : assessments) assessment = decode_assessment(reader);
  return assessments;
}

}  // namespace mercury
