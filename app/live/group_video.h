// SPDX-License-Identifier: Apache-2.0
// A film of the scene's robots from time 0, made beside the window.
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
  std::string output;            // .mp4, .webm, .gif, or a folder for PNG pictures; replaced if it exists
  PictureSize size{1920, 1080};  // made even where the format needs it
  double frames_per_second = 30;
  double seconds = 10;  // simulated
  double speed = 1;     // simulated seconds a second of video
  render::Quality quality = render::Quality::automatic;
  render::ContextKind context = render::ContextKind::automatic;
};

// Simulates, draws in an OpenGL context of its own, and encodes, all on threads of its own. Nothing throws; what fails
// is in the status.
class GroupVideo {
 public:
  GroupVideo(std::vector<LiveRobot> robots, const Configuration& configuration, const ViewSettings& view,
             const GroupVideoOptions& options);
  ~GroupVideo();  // cancels, and waits until it has

  VideoStatus status() const;
  void cancel();  // nothing is left behind
  void wait();    // until it is over

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
