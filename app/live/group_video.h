// SPDX-License-Identifier: Apache-2.0
// The videos and pictures that the window makes: of the scene's robots from time 0, and of its own frames. All are made
// in the background; other threads can watch and cancel them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live/snapshot.h"
#include "app/scene/view_settings.h"
#include "app/video/frame_writer.h"
#include "render/context/context.h"
#include "render/readback.h"
#include "render/renderer.h"

namespace mercury {

// The progress of a video that is made in the background.
struct VideoStatus {
  enum class State { running, finishing, done, canceled, failed } state = State::running;
  std::int64_t frames = 0;   // written
  std::int64_t total = 0;    // to write; 0 = unknown
  std::int64_t dropped = 0;  // because the encoder was too slow
  std::string file;
  std::string error;  // one line, if failed
  bool over() const { return state != State::running && state != State::finishing; }
};

struct GroupVideoOptions {
  std::string output;            // .mp4, .webm, .gif, or a folder for PNG pictures; an existing file is replaced
  PictureSize size{1920, 1080};  // rounded to even numbers where the format needs it
  double frames_per_second = 30;
  double seconds = 10;          // simulated
  double speed = 1;             // simulated seconds per second of video
  std::optional<double> still;  // a picture (.png) of this moment rather than a video [s]
  bool hero = false;            // the style of a still, see hero_style.h
  float aperture = 0;           // of its lens, see ViewSettings
  TrialStart start;             // where robots begin
  render::Quality quality = render::Quality::automatic;
  render::ContextKind context = render::ContextKind::automatic;
};

// Simulates its own copy of the robots, draws in its own OpenGL context and encodes, all on its own threads. No member
// throws; status() reports errors.
class GroupVideo {
 public:
  GroupVideo(std::vector<LiveRobot> robots, const Configuration& configuration, const ViewSettings& view,
             const GroupVideoOptions& options);
  ~GroupVideo();  // cancels and waits

  VideoStatus status() const;
  void cancel();  // removes the unfinished file
  void wait();    // until it is done, canceled or failed

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Records the window's frames as a video. Encodes on its own thread. The video runs in real time: a frame stays until
// the next one. If the encoder is too slow, frames are dropped; only the destructor waits. No member throws; status()
// reports errors. An existing file is replaced; unused_name() (robot_saving.h) finds a new name.
class ScreenRecording {
 public:
  // `output`: .mp4, .webm, .gif, or a folder for PNG pictures. `size`: of the frames in pixels; where the format needs
  // even numbers, the last row or column is cut off.
  ScreenRecording(const std::string& output, PictureSize size, double frames_per_second = 30);
  ~ScreenRecording();  // finishes and waits

  // Whether the video needs a frame at this time. Ask before reading the frame back. `time` is in seconds from an
  // arbitrary origin and must not go back.
  bool wants(double time) const;
  // Adds a frame: RGB, upper row first, of the size given to the constructor. Returns false if it was dropped.
  bool offer(double time, render::Image frame);
  // No more frames follow. Does not wait.
  void finish();
  // Stops and removes the unfinished file.
  void cancel();
  VideoStatus status() const;
  PictureSize size() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Converts an RGB frame to planes Y, U, V (BT.709, limited range). Cuts off an odd last row or column.
render::Image yuv420_of(const render::Image& rgb);

}  // namespace mercury
