// SPDX-License-Identifier: Apache-2.0
// A trajectory as a simulation: everything that looks at a simulation, such as a film, can look at a recording.
#pragma once

#include <memory>

#include "app/recording/trajectory_reader.h"
#include "mercury/simulation.h"

namespace mercury {

// A simulation whose steps are read rather than computed: it stands at the first frame, and n steps on it is where the
// recorded one was then, between two frames on the line between them, after the last frame at the last. Its time counts
// from the first frame. Robots that exploded are marked from then on. Materials, energies and strains are told as ever;
// pulls and changed parameters change nothing.
Simulation playback(std::shared_ptr<TrajectoryReader> trajectory);

}  // namespace mercury
