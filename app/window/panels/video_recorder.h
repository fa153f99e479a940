// SPDX-License-Identifier: Apache-2.0
// Videos of the window, clean videos and pictures of the group, screenshots.
#pragma once

#include <array>
#include <filesystem>
#include <memory>

#include "app/live/group_video.h"
#include "app/window/panels/panel.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// Records the window, and makes clean videos of the group beside it. The Video panel and the key V control it.
struct VideoSettings {
  static constexpr std::array<const char*, 3> extensions{".mp4", ".webm", ".gif"};
  static constexpr std::array<PictureSize, 4> group_sizes{{{1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}};

  int format = 0;  // index into extensions
  int frames_per_second = 30;
  bool hide_panels = false;   // while the window is recorded
  int group_size = 1;         // index into group_sizes
  double group_seconds = 10;  // simulated time of a group video [s]
  double group_speed = 1;     // simulated seconds per second of the group video
  bool hero = false;          // the style of pictures of the group
  float aperture = 0;         // of their lens; 0 = all is sharp, or that of the style
};

class VideoRecorder {
 public:
  VideoSettings settings;

  // Starts or ends a recording of the window.
  void toggle(PanelContext& context);
  // Call once per frame, before the buffers are swapped: passes the window's view to the recording. A recording ends
  // when the window is resized, since a video has one size.
  void capture_frame(PanelContext& context, WindowSize pixels);
  const ScreenRecording* recording() const { return screen_.get(); }  // null = the window is not recorded
  bool ending() const { return ending_; }                             // no more frames are taken
  double seconds() const;                                             // since the recording started

  // Simulates all robots from their start and films them without panels, in the background.
  void start_group_video(PanelContext& context);
  // The same, a picture of the moment that the window shows.
  void start_group_picture(PanelContext& context);
  const GroupVideo* group_video() const { return group_.get(); }  // null = none is being made
  void cancel_group_video() { group_->cancel(); }

  bool busy() const { return start_requested_ || screen_ || group_; }

 private:
  void start_group(PanelContext& context, const GroupVideoOptions& options);
  void start(PanelContext& context, WindowSize pixels);

  std::unique_ptr<ScreenRecording> screen_;
  std::unique_ptr<GroupVideo> group_;
  bool group_is_picture_ = false;
  bool start_requested_ = false;  // starts in the next frame
  bool ending_ = false;
  double start_time_ = 0;  // wall time [s]
};

// The folder for videos and screenshots: the last one saved to, or the working directory.
std::filesystem::path picture_folder(const PanelContext& context);

// Draws a red dot and the time of the recording in the upper left corner of the view.
void draw_recording_sign(ImDrawList& list, PanelContext& context, const ViewportArea& area);

}  // namespace mercury::window
