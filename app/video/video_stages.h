// SPDX-License-Identifier: Apache-2.0
// From a simulation to a video: three stages that run at the same time.
//
//   simulate               draw                      encode
//   a thread               the calling thread        a thread
//   steps the robots  -->  draws a snapshot,    -->  writes frames with
//   to each frame          reads the frame back      the FrameWriter
//              snapshots (4)             frames (6)
//                                  <-- spare frames (8)
//
// 1. Each stage has its own thread, so the slowest one sets the rate, not the sum of all three. OpenGL draws on the
//    calling thread because the context is current there.
// 2. The queues are short. A stage that is ahead waits, and memory does not grow with the length of the video.
// 3. Written frames go back as spare ones, so no memory is allocated per frame.
// 4. When a stage throws, it abandons all queues, the other stages end, and the caller gets the first exception.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "app/base/frame_places.h"
#include "app/video/frame_encoder.h"
#include "app/video/frame_writer.h"
#include "app/video/group_drawing.h"
#include "app/video/position_bridge.h"
#include "mercury/simulation.h"
#include "render/renderer.h"

namespace mercury {

// A video that is made in the background; other threads can watch and stop it.
struct VideoControl {
  std::atomic<std::int64_t> frames = 0;  // written so far
  std::atomic<bool> stop = false;        // end before the last frame, as when the user interrupts
};

// Frame k shows the time start + k interval, counted from the simulation's time when the video begins.
struct VideoTiming {
  std::int64_t frames = 0;
  double start = 0;     // [s]
  double interval = 0;  // simulated time between frames [s]
  double pace = 0;      // time between frames when the video plays [s]
};

// The frames of a video of `seconds` of simulated time; `speed`: simulated seconds per second of video. At least one.
// Throws ParameterError("seconds", ...), ("speed", ...) or ("fps", ...) for values that cannot be used.
VideoTiming video_timing(double seconds, double speed, double frames_per_second);

struct VideoResult {
  std::int64_t frames = 0;   // written
  bool interrupted = false;  // the user stopped it before the last frame
  double wall_seconds = 0;
};

// Where frame k is, in steps from the first one: at a step, or between two. It is computed from the first frame on, so
// rounding does not add up.
FramePlace place_of_frame(std::int64_t frame, const VideoTiming& timing, double dt);

// A simulation and how it is drawn.
struct VideoSide {
  Simulation& simulation;
  PositionBridge& bridge;
  GroupDrawing& drawing;  // of the simulation; the renderer has its bodies
  render::Renderer& renderer;
  float* share = nullptr;  // of playback(); other simulations are interpolated between two steps
};

// What the stages work with; the caller owns all of it.
struct VideoParts {
  // They show the same times with the camera and the colors' scale of the first. Several may share a simulation, and
  // those a renderer.
  std::vector<VideoSide> sides;
  FrameWriter& writer;
  render::PixelFormat pixels;     // of the sides
  FrameEncoder::Combine combine;  // makes a frame of several sides
};

// Simulates, draws and writes all frames; the caller finishes the writer. Draws on the calling thread, where the
// renderer's context must be current. When the user interrupts, the frames so far are written. Throws the first
// exception of any stage. `quiet`: shows no progress. `control` must outlive the call.
VideoResult run_video_stages(const VideoParts& parts, const VideoTiming& timing, bool quiet,
                             VideoControl* control = nullptr);

}  // namespace mercury
