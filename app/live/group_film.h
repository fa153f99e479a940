// SPDX-License-Identifier: Apache-2.0
// A film of the scene's robots from time 0, made beside the window.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/live/film_status.h"
#include "app/live/moment.h"
#include "app/scene/view_settings.h"
#include "app/video/frame_writer.h"
#include "render/context.h"
#include "render/renderer.h"

namespace mercury {

struct GroupFilmOptions {
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
class GroupFilm {
 public:
  GroupFilm(std::vector<LiveRobot> robots, const Configuration& configuration, const ViewSettings& view,
            const GroupFilmOptions& options);
  ~GroupFilm();  // cancels, and waits until it has

  FilmStatus status() const;
  void cancel();  // nothing is left behind
  void wait();    // until it is over

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
