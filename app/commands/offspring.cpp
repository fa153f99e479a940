// SPDX-License-Identifier: Apache-2.0
#include "app/commands/offspring.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/progress.h"
#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/inspect.h"
#include "mercury/random.h"

namespace mercury {
namespace {

constexpr std::uint64_t at_once = 64;  // children made together, then written
constexpr std::uint64_t draws = 30;    // of one child

// The first draw takes the child's own seed.
std::uint64_t seed_of_draw(std::uint64_t seed, std::uint64_t index, std::uint64_t draw) {
  const std::uint64_t own = seed_of(seed, index);
  return draw == 0 ? own : seed_of(own, draw);
}

}  // namespace

std::vector<Robot> load_parents_of(const RobotInputs& files, const std::function<void(const Robot&)>& handmade) {
  if (files.empty()) throw InputError("no robots given; name files or folders");
  return robots_of(files.load([&handmade](const Robot& parent) {
    const Generator* generator = generator_of(parent);
    if (!generator) return handmade(parent);
    try {
      generator->regrow(parent);
    } catch (const InputError& error) {
      throw InputError(parent.name, error.what());
    }
  }));
}

std::vector<Robot> load_parents(const RobotInputs& files, const char* verb) {
  return load_parents_of(files, [verb](const Robot& parent) {
    throw InputError(parent.name,
                     fmt::format("cannot be {}; only {} robots know how they were made", verb, generator_kinds()));
  });
}

int write_children(const RobotOutput& output, RobotFiles files, std::uint64_t count, const std::vector<Robot>& parents,
                   const MakeChild& make) {
  std::unordered_set<std::uint64_t> bodies;
  for (const Robot& parent : parents) bodies.insert(body_hash(parent));
  Progress progress("making robots", "robots", static_cast<std::int64_t>(count));
  const MakeRobot first_draw = [&](std::uint64_t seed, std::uint64_t index) {
    return make(index, seed_of_draw(seed, index, 0));
  };
  bool all = true;
  for (std::uint64_t first = 0; first < count; first += at_once) {
    const auto portion = static_cast<std::size_t>(std::min(at_once, count - first));
    std::vector<MadeRobot> made = make_robots(first_draw, output.seed(), first, portion);
    for (std::size_t i = 0; i < portion; ++i) {
      MadeRobot& child = made[i];
      const auto is_new = [&] { return child.robot && bodies.insert(body_hash(*child.robot)).second; };
      bool found = is_new();
      for (std::uint64_t draw = 1; draw < draws && !found && !interrupted(); ++draw) {
        child = {};
        try {
          child.robot = make(first + i, seed_of_draw(output.seed(), first + i, draw));
        } catch (const InputError& error) {
          child.failure = error.what();
        }
        found = is_new();
      }
      if (interrupted()) {
        say("stopped; the files so far are whole");
        return 1;
      }
      if (found) {
        files.write(*child.robot);
      } else {
        all = false;
        warn(fmt::format("child {} was left out: {}", first + i,
                         child.robot ? fmt::format("the bodies of {} draws are there already", draws) : child.failure));
      }
    }
    progress.update(static_cast<std::int64_t>(first + portion));
  }
  return all && !files.renamed() ? 0 : 1;
}

}  // namespace mercury
