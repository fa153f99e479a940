// SPDX-License-Identifier: Apache-2.0
// A video of the scene's robots from time 0, made in the background; other threads can watch and cancel it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/live/snapshot.h"
#include "app/live/video_status.h"
#include "app/scene/view_settings.h"
#include "app/video/frame_writer.h"
#include "render/context.h"
#include "render/renderer.h"

namespace mercury {

struct GroupVideoOptions {
  std::string output;            // .mp4, .webm, .gif, or a folder for PNG pictures; an existing file is replaced
  PictureSize size{1920, 1080};  // rounded to even numbers where the format needs it
  double frames_per_second = 30;
  double seconds = 10;  // simulated
  double speed = 1;     // simulated seconds per second of video
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

}  // namespace mercury
