// SPDX-License-Identifier: Apache-2.0
// A trajectory as a simulation, so that videos and the window can show a recording.
#pragma once

#include <memory>

#include "app/recording/trajectory_reader.h"
#include "mercury/simulation.h"

namespace mercury {

// A simulation that reads its states instead of computing them. It starts at the first frame, and its time counts from
// there. Between two frames it interpolates linearly; after the last frame it stays. Robots that exploded are marked
// from that step on. Materials, energies and strains are available as usual; perturbations and changed parameters have
// no effect. add() and keep() throw std::logic_error.
// `share`: states are this share of a step later than the simulation's step (FramePlace::share); may change between
// two calls of the simulation's members. None = 0.
Simulation playback(std::shared_ptr<TrajectoryReader> trajectory, std::shared_ptr<const float> share = nullptr);

}  // namespace mercury
