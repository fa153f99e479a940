// SPDX-License-Identifier: Apache-2.0
// A shard is a file "shards/GENERATION-SHARD-of-COUNT": magic, version, fingerprint of the generation, the assessments
// of every COUNT-th child, checksum.
#include <algorithm>
#include <charconv>
#include <map>

#include "evolution/run_folder/generation_record.h"
#include "mercury/error.h"
#include "mercury/shards.h"
#include "robots/bytes.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "MERCSHRD";
constexpr std::uint32_t version = record_version;

fs::path folder_of_shards(const fs::path& run) { return run / "shards"; }

std::string name_of(int generation, std::size_t shard, std::size_t count) {
  return std::to_string(generation) + "-" + std::to_string(shard) + "-of-" + std::to_string(count);
}

struct Name {
  std::size_t generation = 0, shard = 0, count = 0;
};

// Nothing for other files.
std::optional<Name> parsed(std::string_view text) {
  Name name;
  const auto take = [&](std::size_t& number, std::string_view after) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.starts_with(after)) return false;
    text.remove_prefix(after.size());
    return true;
  };
  if (!take(name.generation, "-") || !take(name.shard, "-of-") || !take(name.count, "") || !text.empty())
    return std::nullopt;
  return name;
}

// Equal for the same children, assessed in the same way.
std::uint64_t fingerprint(const Evolution& evolution, std::span<const Individual> children) {
  ByteWriter writer;
  for (const std::string& objective : evolution.settings().objectives) writer.text(objective);
  writer.numbers(evolution.interim_limits());
  for (const Individual& child : children) {
    writer.add(child.id);
    writer.add(child.seed);
    writer.add(child.genome->identity());
  }
  return checksum_of(writer.bytes());
}

std::vector<Assessment> read(const fs::path& file, std::uint64_t wanted_fingerprint, std::size_t wanted_count) {
  const std::string bytes = read_whole_file(file);
  const auto refuse = [&](const std::string& why) -> InputError {
    return InputError(file.string(), why + "; remove it and run this shard again");
  };
  try {
    ByteReader reader(bytes);
    if (reader.take(magic.size()) != magic) throw refuse("is not a shard");
    const auto written = reader.read<std::uint32_t>();
    if (written > version) throw refuse("is of a newer version of Mercury");
    if (bytes.size() < sizeof(std::uint64_t) ||
        ByteReader(std::string_view(bytes).substr(bytes.size() - sizeof(std::uint64_t))).read<std::uint64_t>() !=
            checksum_of(std::string_view(bytes).substr(0, bytes.size() - sizeof(std::uint64_t))))
      throw refuse("is damaged");
    if (reader.read<std::uint64_t>() != wanted_fingerprint) throw refuse("belongs to another run");
    std::vector<Assessment> assessments = decode_assessments(reader, written);
    if (assessments.size() != wanted_count) throw refuse("has another number of robots");
    return assessments;
  } catch (const DamagedBytes& error) {
    throw refuse(std::string("is damaged: ") + error.what());
  }
}

// The files of a generation's shards by their number. All have one count.
std::map<std::size_t, fs::path> shards_of(const fs::path& run, int generation, std::size_t& count) {
  std::map<std::size_t, fs::path> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_of_shards(run), error)) {
    const std::optional<Name> name = parsed(entry.path().filename().string());
    if (!name || name->generation != static_cast<std::size_t>(generation)) continue;
    if (count != 0 && count != name->count)
      throw InputError(entry.path().string(), "is one of " + std::to_string(name->count) + " shards, others are of " +
                                                  std::to_string(count) + "; remove those of one kind");
    count = name->count;
    found[name->shard] = entry.path();
  }
  return found;
}

std::size_t children_in(std::size_t children, std::size_t shard, std::size_t count) {
  return children / count + (shard - 1 < children % count ? 1 : 0);
}

}  // namespace

std::optional<fs::path> assess_shard(const fs::path& folder, const Evolution& evolution, Assessor& assessor,
                                     std::size_t shard, std::size_t count, const Watch& watch) {
  const std::vector<Individual> children = evolution.children();
  std::vector<GenomePointer> mine;
  for (std::size_t i = shard - 1; i < children.size(); i += count) mine.push_back(children[i].genome);
  const std::optional<std::vector<Assessment>> assessments = assessor.assess(mine, evolution.interim_limits(), watch);
  if (!assessments) return std::nullopt;
  ByteWriter writer;
  writer.append(magic);
  writer.add(version);
  writer.add(fingerprint(evolution, children));
  encode(writer, *assessments);
  writer.add(checksum_of(writer.bytes()));
  fs::create_directories(folder_of_shards(folder));
  const fs::path file = folder_of_shards(folder) / name_of(evolution.next_generation(), shard, count);
  write_whole_file(file, writer.bytes());
  return file;
}

Generation merge_shards(const fs::path& folder, Evolution& evolution) {
  const int generation = evolution.next_generation();
  std::size_t count = 0;
  const std::map<std::size_t, fs::path> files = shards_of(folder, generation, count);
  if (files.empty())
    throw InputError(folder_of_shards(folder).string(),
                     "has no shard of generation " + std::to_string(generation) + "; make them by --shard I/N");
  for (std::size_t shard = 1; shard <= count; ++shard)
    if (!files.contains(shard))
      throw InputError(folder_of_shards(folder).string(), "shard " + std::to_string(shard) + " of " +
                                                              std::to_string(count) + " of generation " +
                                                              std::to_string(generation) + " is missing");
  std::vector<Individual> children = evolution.children();
  const std::uint64_t print = fingerprint(evolution, children);
  for (const auto& [shard, file] : files) {
    std::vector<Assessment> assessments = read(file, print, children_in(children.size(), shard, count));
    for (std::size_t k = 0; k < assessments.size(); ++k)
      children[shard - 1 + k * count].assessment = std::move(assessments[k]);
  }
  return evolution.select(std::move(children));
}

void remove_shards(const fs::path& folder, int generation) {
  std::error_code error;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder_of_shards(folder), error))
    if (const auto name = parsed(entry.path().filename().string());
        name && name->generation < static_cast<std::size_t>(generation))
      old.push_back(entry.path());
  for (const fs::path& file : old) fs::remove(file, error);
  fs::remove(folder_of_shards(folder), error);  // if it is empty
}

}  // namespace mercury
