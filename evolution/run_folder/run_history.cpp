// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "evolution/run_folder/history_parts.h"
#include "evolution/run_folder/run_robot.h"
#include "mercury/error.h"

namespace mercury {

RunHistory::RunHistory(const std::filesystem::path& folder, GenomeSpaceMaker make_space)
    : parts_(std::make_unique<Parts>(folder, std::move(make_space))) {}
RunHistory::~RunHistory() = default;
RunHistory::RunHistory(RunHistory&&) noexcept = default;
RunHistory& RunHistory::operator=(RunHistory&&) noexcept = default;

bool RunHistory::refresh() { return parts_->refresh(); }

const std::filesystem::path& RunHistory::folder() const { return parts_->folder; }
const RunSettings& RunHistory::settings() const { return parts_->file.settings; }
std::span<const GenerationSummary> RunHistory::generations() const { return parts_->generations; }
const GenomeSpace& RunHistory::space() const { return parts_->space(); }
std::span<const Individual> RunHistory::individuals() const { return parts_->individuals; }
std::span<const std::uint64_t> RunHistory::living() const { return parts_->living; }

std::optional<int> RunHistory::died(std::uint64_t id) const {
  parts_->check(id);
  return parts_->died[id] < 0 ? std::nullopt : std::optional(parts_->died[id]);
}

GenomePointer RunHistory::genome(std::uint64_t id) const { return parts_->genome(id); }

Robot RunHistory::grow(std::uint64_t id) const { return run_robot(*this, id); }

std::vector<std::uint64_t> RunHistory::line_of(std::uint64_t id) const {
  parts_->check(id);
  std::vector<std::uint64_t> line{id};
  while (!parts_->individuals[line.back()].parents.empty())
    line.push_back(parts_->individuals[line.back()].parents.front());
  std::ranges::reverse(line);
  return line;
}

std::uint64_t RunHistory::champion(int generation) const {
  if (generation < 0 || generation >= static_cast<int>(parts_->generations.size()))
    throw InputError(parts_->folder.string(), "there is no generation " + std::to_string(generation) +
                                                  "; the run has " + std::to_string(parts_->generations.size()));
  return parts_->generations[static_cast<std::size_t>(generation)].best;
}

bool is_run_folder(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::exists(folder / run_file_name, error);
}

}  // namespace mercury
