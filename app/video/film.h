// SPDX-License-Identifier: Apache-2.0
// From a simulation to pictures: simulating, drawing and encoding, each on a thread of its own.
#pragma once

#include <atomic>
#include <cstdint>

#include "app/scene/cameraman.h"
#include "app/scene/group_scene.h"
#include "app/scene/scene_details.h"
#include "app/video/frame_writer.h"
#include "app/video/position_bridge.h"
#include "mercury/simulation.h"
#include "render/renderer.h"

namespace mercury {

// A film that is made in the background, as others see and stop it.
struct FilmControl {
  std::atomic<std::int64_t> frames = 0;  // written so far
  std::atomic<bool> stop = false;        // end before the last frame, as when the user interrupts
};

// Which moments are filmed: frame k shows the time start + k interval, the simulation's time at the beginning being 0.
struct FilmTiming {
  std::int64_t frames = 0;
  double start = 0;     // [s]
  double interval = 0;  // simulated time between frames [s]
  double pace = 0;      // time between frames when the film is shown [s]
};

struct FilmResult {
  std::int64_t frames = 0;   // written
  bool interrupted = false;  // the user stopped it before the last frame
  double wall_seconds = 0;
};

// The step at which frame k is taken: the one nearest to its time, counted from the first frame, so that nothing adds
// up and ten seconds are ten seconds.
std::int64_t step_of_frame(std::int64_t frame, const FilmTiming& timing, double dt);

// The parts of a film; all stay the caller's.
struct FilmSet {
  Simulation& simulation;
  PositionBridge& bridge;
  DetailObserver& details;
  GroupScene& scene;
  Cameraman& camera;
  render::Renderer& renderer;
  FrameWriter& writer;
  render::PixelFormat pixels;
};

// Runs the simulation and writes a frame for each moment; the writer is left to be finished by the caller. Draws on the
// calling thread, whose GL context must be the renderer's. When the user interrupts, the frames so far are written.
// Throws what any of the three stages threw first. A quiet film shows no progress.
// `control` outlives the call.
FilmResult film(const FilmSet& set, const FilmTiming& timing, bool quiet, FilmControl* control = nullptr);

}  // namespace mercury
