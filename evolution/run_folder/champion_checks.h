// SPDX-License-Identifier: Apache-2.0
// The champions of a run are checked beside the search: whether their results hold (mercury/confirmation.h). Those that
// are confirmed are in best/; checks.csv lists all of them, with the reason why one is not.
//
// A thread of its own checks on the CPU, whatever device the search uses, and changes nothing of it. A verdict depends
// on the robot and the run's settings alone. Champions that have none when the program ends get it when the run goes
// on.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "mercury/confirmation.h"
#include "mercury/run_folder.h"

namespace mercury {

inline constexpr std::string_view checks_name = "checks.csv";

// The ids of those who were the best of the living after a generation, with the first such generation, in their order.
std::vector<std::pair<std::uint64_t, int>> champions_of(const RunHistory& run);

// Of the robots that are in checks.csv, by id. Lines that cannot be read count as missing: they are made again.
using Checks = std::map<std::uint64_t, Confirmation>;
Checks read_checks(const std::filesystem::path& run);
void write_checks(const RunHistory& run, const Checks& checks);

// What a run's champions are checked with: its trials, with the jitters of a check and another seed than the search,
// which has chosen among results of its own jitters.
TrialSettings check_settings_of(const EvolutionSettings& settings);
std::uint64_t check_seed_of(const EvolutionSettings& settings);

class ChampionChecks {
 public:
  // The run must outlive it. `threads` = of the CPU.
  ChampionChecks(const RunFolder& run, int threads);
  // Gives up what is not checked yet.
  ~ChampionChecks();
  ChampionChecks(const ChampionChecks&) = delete;
  ChampionChecks& operator=(const ChampionChecks&) = delete;

  // Begins to check champions that are new, and writes what has become known: checks.csv and best/. To be called after
  // each generation, by the thread that appends generations.
  void update();
  // Waits until all champions are checked, and writes what is known. Returns false if `watch`, which is called with how
  // many are left, said to stop.
  bool finish(const std::function<bool(std::size_t left)>& watch);
  const Checks& checks() const { return checks_; }

 private:
  struct Waiting {
    std::uint64_t id = 0;
    std::shared_ptr<const Robot> robot;
  };

  void work();
  void take_results();

  const RunFolder& run_;
  Configuration configuration_;
  TrialSettings trials_;
  Objective objective_;
  std::uint64_t seed_;
  Checks checks_;
  std::size_t generations_ = 0;  // that were looked at
  std::map<std::uint64_t, bool> known_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Waiting> waiting_;
  Checks results_;        // not yet taken
  std::size_t left_ = 0;  // waiting, or being checked
  bool stopping_ = false;
  std::thread worker_;  // last: it uses the others
};

}  // namespace mercury
