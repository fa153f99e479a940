// SPDX-License-Identifier: Apache-2.0
// Videos of what is shown, clean group videos, pictures.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "app/live/group_video.h"
#include "app/live/screen_recording.h"
#include "app/window/panels/panel_context.h"

namespace mercury::window {

class VideoPanel {
 public:
  // `screenshot` is called when a picture of the window is asked for.
  void draw(PanelContext& context, const std::function<void()>& screenshot);
  // Starts or ends the video of the window.
  void toggle(PanelContext& context);
  // Gives the window's picture to the video; once a frame, before it is shown.
  void frame(PanelContext& context, WindowSize pixels);
  bool busy() const { return wanted_ || screen_ || group_; }

 private:
  void begin(PanelContext& context, WindowSize pixels);
  void draw_screen(PanelContext& context);
  void draw_group(PanelContext& context);
  void draw_group_options(PanelContext& context);
  double seconds() const;

  std::unique_ptr<ScreenRecording> screen_;
  bool ending_ = false;  // no more pictures are given
  bool wanted_ = false;  // begins with the next frame
  std::chrono::steady_clock::time_point start_;
  int rate_ = 30;  // frames a second
  int kind_ = 0;   // of file: mp4, webm, gif
  bool hide_panels_ = false;

  std::unique_ptr<GroupVideo> group_;
  GroupVideoOptions options_;
  int size_ = 1;
};

// Where pictures and videos go.
std::filesystem::path picture_folder(const PanelContext& context);

}  // namespace mercury::window
