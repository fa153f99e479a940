// From a simulation to a video: simulating, drawing and encoding, each on a thread of its own.
#pragma once

#include <cstdint>

#include "app/frame_writer.h"
#include "app/group_camera.h"
#include "app/group_scene.h"
#include "app/position_bridge.h"
#include "render/renderer.h"
#include "sim/simulation.h"

namespace mercury {

struct FilmSettings {
  double frames_per_second = 30;
  double speed = 1;           // simulated seconds a second of video
  std::int64_t frames = 0;    // how many
  bool quiet = false;         // no progress
};

struct FilmResult {
  std::int64_t frames = 0;    // written
  bool interrupted = false;   // the user stopped it before the last frame
  double wall_seconds = 0;
};

// Time step at which frame k is taken: the one nearest to its time, counted from the first frame, so that nothing adds
// up and ten seconds are ten seconds. Throws nothing.
std::int64_t step_of_frame(std::int64_t frame, double frames_per_second, double speed, double dt);

// The parts of a film; all stay the caller's.
struct FilmSet {
  Simulation& simulation;
  PositionBridge& bridge;
  GroupScene& scene;
  GroupCamera& camera;
  render::Renderer& renderer;
  FrameWriter& writer;
  render::PixelFormat pixels;
};

// Runs the simulation and writes a frame for each moment; the writer is left to be finished by the caller. Draws on the
// calling thread, whose GL context must be the renderer's. When the user interrupts, the frames so far are written.
// Throws what any of the three stages threw first.
FilmResult film(const FilmSet& set, const FilmSettings& settings);

}  // namespace mercury
