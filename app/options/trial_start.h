// SPDX-License-Identifier: Apache-2.0
// Where robots begin that are shown: at rest, or as the first trial of a run does (mercury/trials.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "app/options/command.h"
#include "app/scene/view_settings.h"
#include "mercury/simulation.h"
#include "mercury/trials.h"

namespace mercury {

struct TrialStart {
  TrialSettings trials = one_trial();
  std::uint64_t seed = 1;
  bool is_elsewhere() const { return begins_elsewhere(trials); }  // than at rest
  friend bool operator==(const TrialStart&, const TrialStart&) = default;
};

// Whether a parameter of trials says where they begin: target_radius and its siblings.
bool is_of_start(std::string_view parameter);
// The options of these parameters, for commands that show one trial. The seed is that of other options.
void add_start_options(const Command& command, TrialSettings& trials);
// Throws InputError if robots would begin elsewhere: what is shown is recorded, and begins where it did.
void require_start_of_recording(const TrialSettings& trials);

// The layout in which the window shows them: cells have no place for a target.
inline Layout usual_layout(const TrialStart& start) {
  return start.trials.target_radius > 0 ? Layout::grid : Layout::cells;
}

// Where the masses of a robot begin, on the floor if there is one [m].
std::vector<Vec3> start_of(const Robot& robot, const Environment& environment, const TrialStart& start);
// Puts all robots to where they begin, at time 0. Materials keep their changes.
void begin_at(Simulation& simulation, const TrialStart& start);
// The same for one robot that is at rest, bit for bit. Time goes on.
void begin_at(Simulation& simulation, std::size_t robot, const TrialStart& start);

}  // namespace mercury
