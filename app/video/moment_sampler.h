// SPDX-License-Identifier: Apache-2.0
// What a frame shows of a simulation that somebody else steps: its state at a step, or, where the frame lies between
// two steps, a mix of both.
//
//     while (const auto step = sampler.next_step(place)) {
//       simulation.step(*step - simulation.steps());
//       sampler.observe(place);
//     }
//     show(sampler.moment(place));
#pragma once

#include <cstdint>
#include <optional>

#include "app/base/frame_places.h"
#include "app/video/group_drawing.h"
#include "app/video/position_bridge.h"
#include "mercury/simulation.h"

namespace mercury {

// Refers to all that it is made of. Places must not go back.
class MomentSampler {
 public:
  // `dense`: more than one frame may lie between the same two steps. `share`: of a simulation that can itself be
  // between two steps, see playback(); else nullptr.
  MomentSampler(const Simulation& simulation, GroupDrawing& drawing, PositionBridge& bridge, bool dense,
                float* share = nullptr)
      : simulation_(simulation), drawing_(drawing), bridge_(bridge), dense_(dense), share_(share) {}

  // The next step that a frame at this place needs, or nothing if moment() can be called.
  std::optional<std::int64_t> next_step(const FramePlace& place) const;
  // The simulation is at that step.
  void observe(const FramePlace& place);
  FrameSnapshot moment(const FramePlace& place);

 private:
  const Simulation& simulation_;
  GroupDrawing& drawing_;
  PositionBridge& bridge_;
  bool dense_;
  float* share_;
  std::optional<std::int64_t> step_;  // of earlier_
  FrameSnapshot earlier_;
  std::optional<FrameSnapshot> later_;
};

}  // namespace mercury
