// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/video_panel.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/window/panels/key_hint.h"
#include "app/window/panels/video_recorder.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

void progress(const VideoStatus& status, const char* doing) {
  const bool finishing = status.state == VideoStatus::State::finishing;
  const float share = status.total > 0 ? static_cast<float>(status.frames) / static_cast<float>(status.total)
                      : finishing      ? 1.0f
                                       : 0.0f;
  const std::string frames =
      status.total > 0 ? fmt::format("{} of {}", status.frames, status.total) : fmt::format("{}", status.frames);
  ImGui::ProgressBar(share, {-1, 0}, finishing ? "finishing" : fmt::format("{}: {} frames", doing, frames).c_str());
  if (status.dropped > 0) note(fmt::format("{} frames dropped: the encoder is too slow", status.dropped).c_str());
}

void draw_recording(PanelContext& context) {
  heading("Video of the window");
  VideoRecorder& recorder = context.recorder;
  VideoSettings& settings = recorder.settings;
  if (const ScreenRecording* recording = recorder.recording()) {
    const PictureSize size = recording->size();
    ImGui::TextUnformatted(fmt::format("{:.1f} s, {} x {}", recorder.seconds(), size.width, size.height).c_str());
    progress(recording->status(), "recording");
    ImGui::BeginDisabled(recorder.ending());
    if (ImGui::Button("Stop", {-1, 0})) recorder.toggle(context);
    context.log.item("video.record");
    ImGui::EndDisabled();
    return;
  }
  combo("format", "of both kinds of video", settings.format, {"MP4", "WebM", "GIF"});
  row("frame rate", "frames per second");
  number_slider("##rate", settings.frames_per_second, 10, 60);
  settings.frames_per_second = std::clamp(settings.frames_per_second, 1, 120);
  ImGui::Checkbox("Without panels", &settings.hide_panels);
  tooltip("hide the panels until the recording stops");
  if (ImGui::Button("Record", {-1, 0})) recorder.toggle(context);
  context.log.item("video.record");
  tooltip(with_keys(context.keys, "record the window until you stop it", Action::record).c_str());
}

void draw_group_options(VideoSettings& settings) {
  combo("size", "of the video", settings.group_size, {"1280 x 720", "1920 x 1080", "2560 x 1440", "3840 x 2160"});
  auto length = static_cast<float>(settings.group_seconds), speed = static_cast<float>(settings.group_speed);
  if (slider("length", "simulated time", length, 10, {1, 120, "%.0f s", true}) && length > 0)
    settings.group_seconds = static_cast<double>(length);
  if (slider("speed", "simulated seconds per second of video", speed, 1, {0.1f, 10, "\xc3\x97 %.2f", true}) &&
      speed > 0)
    settings.group_speed = static_cast<double>(speed);
}

void draw_group(PanelContext& context) {
  heading("Clean video of the group");
  if (const GroupVideo* video = context.recorder.group_video()) {
    progress(video->status(), "filming");
    if (ImGui::Button("Cancel##group", {-1, 0})) context.recorder.cancel_group_video();
    return;
  }
  draw_group_options(context.recorder.settings);
  ImGui::BeginDisabled(context.scene.entries().empty());
  if (ImGui::Button("Make the video", {-1, 0})) context.recorder.start_group_video(context);
  context.log.item("video.group");
  ImGui::EndDisabled();
  tooltip("all robots from the start, seen as now but without panels, made in the background");
}

}  // namespace

void VideoPanel::draw(PanelContext& context) {
  draw_recording(context);
  draw_group(context);
  heading("Screenshot");
  if (ImGui::Button("Save a screenshot", {-1, 0})) context.screenshot_requested = true;
  context.log.item("video.screenshot");
  tooltip("key P or F2; press H first to leave out the panels");
  note(fmt::format("Videos and screenshots go to {}", picture_folder(context).string()).c_str());
}

}  // namespace mercury::window
