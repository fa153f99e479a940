// SPDX-License-Identifier: Apache-2.0
// Small runs of mercury evolve in a folder of the test.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <exception>
#include <string>
#include <vector>

#include "mercury/run_folder.h"
#include "tests/app/program.h"
#include "tests/nap.h"

namespace mercury::test {

class EvolveCommand : public FolderTest {
 protected:
  // Small robots, short trials.
  static Arguments small(const std::string& generations = "4") {
    return {"--from", "voxel:3x2x2", "--population", "8",   "--generations", generations, "--seconds",
            "0.3",    "--quiet",     "--device",     "cpu", "--seed",        "5"};
  }
  // Brains that grow in changing bodies, and their species.
  static Arguments growing(const std::string& generations) {
    return joined(small(generations), {"--genes", "body,brain", "--brain-growth", "--new-neurons", "0.3",
                                       "--new-connections", "0.3", "--algorithm", "neat", "--crossover", "0.75",
                                       "--target", "1,0.5,0", "--objective", "target_approach"});
  }
  Outcome evolve(const std::string& name, const Arguments& options) const {
    return mercury(joined({"evolve", path(name)}, options));
  }
  std::string lineage(const std::string& run) const { return read(run + "/lineage.csv"); }
  // What an uninterrupted run gives.
  std::string expected_lineage(const std::string& generations = "4") const {
    const Outcome outcome = evolve("expected", joined(small(generations), {"--force"}));
    EXPECT_EQ(outcome.status, 0) << outcome.messages;
    return lineage("expected");
  }
  std::size_t generations_in(const std::string& run) const {
    try {
      return RunHistory(path(run)).generations().size();
    } catch (const std::exception&) {
      return 0;  // not yet made
    }
  }
  // Waits until that many generations are on the disk. Gives up after a minute.
  void wait_for_generations(const std::string& run, std::size_t count) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (generations_in(run) < count && std::chrono::steady_clock::now() < deadline) nap();
  }
};

}  // namespace mercury::test
