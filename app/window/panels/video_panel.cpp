// SPDX-License-Identifier: Apache-2.0
// Videos of the window, clean videos of the group, screenshots.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

#include "app/base/progress.h"
#include "app/live/group_video.h"
#include "app/live/scene_exports.h"
#include "app/live/scene_robots.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/panels/video_recorder.h"
#include "app/window/toolkit/key_map.h"
#include "app/window/toolkit/screenshot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/stopwatch.h"

namespace mercury::window {

class VideoPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
};

namespace {

void report_end(PanelContext& context, const VideoStatus& status, const std::string& what = "video") {
  if (status.state == VideoStatus::State::failed) context.toasts.show(Tone::error, status.error);
  if (status.state == VideoStatus::State::canceled)
    context.toasts.show(Tone::info, "the " + what + " was canceled; no file was kept");
  if (status.state != VideoStatus::State::done) return;
  context.toasts.show(Tone::success, what + " saved: " + status.file);
  context.log.write("recorded", {{"file", status.file}, {"frames", status.frames}});
}

std::filesystem::path new_video_file(const PanelContext& context, const VideoSettings& settings) {
  return unused_path(picture_folder(context), VideoSettings::extensions[static_cast<std::size_t>(settings.format)]);
}

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
    ImGui::TextUnformatted(
        fmt::format("{:.1f} s, {} \xc3\x97 {}", recorder.seconds(), size.width, size.height).c_str());
    progress(recording->status(), "recording");
    ImGui::BeginDisabled(recorder.ending());
    if (ImGui::Button("Stop", {-1, 0})) recorder.toggle(context);
    context.log.item("video.record");
    ImGui::EndDisabled();
    return;
  }
  combo("format", "of both kinds of video", settings.format, {"MP4", "WebM", "GIF"});
  row("frame rate", "frames per second");
  number_slider("##rate", settings.frames_per_second, 10, 60, "%d frames/s");
  settings.frames_per_second = std::clamp(settings.frames_per_second, 1, 120);
  ImGui::Checkbox("Without panels", &settings.hide_panels);
  tooltip("hide the panels until the recording stops");
  if (primary_button("Record", {-1, 0})) recorder.toggle(context);
  context.log.item("video.record");
  tooltip(with_keys(context.keys, "record the window until you stop it", Action::record).c_str());
}

void draw_group_options(VideoSettings& settings) {
  auto length = static_cast<float>(settings.group_seconds), speed = static_cast<float>(settings.group_speed);
  if (slider("length", "simulated time", length, 10, {1, 120, "%.0f s", true}) && length > 0)
    settings.group_seconds = static_cast<double>(length);
  if (slider("speed", "simulated seconds per second of video", speed, 1, {0.1f, 10, "\xc3\x97 %.2f", true}) &&
      speed > 0)
    settings.group_speed = static_cast<double>(speed);
}

void draw_picture(PanelContext& context) {
  VideoSettings& settings = context.recorder.settings;
  int style = settings.hero ? 1 : 0;
  if (combo("style", "hero: the first robot against the light, the others or copies of it behind, out of focus", style,
            {"as in the window", "hero"}))
    settings.hero = style == 1;
  slider("lens",
         "blurs what is nearer or farther than what the camera follows: diameter of the lens over its distance; "
         "0: all is sharp, or as the style has it",
         settings.aperture, 0, {0, 0.3f, settings.aperture > 0 ? "%.3f" : "sharp", false});
  settings.aperture = std::clamp(settings.aperture, 0.0f, 1.0f);
  ImGui::BeginDisabled(context.scene.robots().entries().empty());
  if (ImGui::Button("Save a picture", {-1, 0})) context.recorder.start_group_picture(context);
  context.log.item("video.picture");
  ImGui::EndDisabled();
  tooltip("this moment of all robots, simulated from the start, as mercury render --still draws it");
}

void draw_group(PanelContext& context) {
  heading("Clean video and picture of the group");
  if (const GroupVideo* video = context.recorder.group_video()) {
    progress(video->status(), "filming");
    if (ImGui::Button("Cancel##group", {-1, 0})) context.recorder.cancel_group_video();
    return;
  }
  VideoSettings& settings = context.recorder.settings;
  combo("size", "of the video or picture", settings.group_size,
        {"1280 \xc3\x97 720", "1920 \xc3\x97 1080", "2560 \xc3\x97 1440", "3840 \xc3\x97 2160"});
  draw_group_options(settings);
  ImGui::BeginDisabled(context.scene.robots().entries().empty());
  if (primary_button("Make the video", {-1, 0})) context.recorder.start_group_video(context);
  context.log.item("video.group");
  ImGui::EndDisabled();
  tooltip("all robots from the start, seen as now but without panels, made in the background");
  draw_picture(context);
}

}  // namespace

std::filesystem::path picture_folder(const PanelContext& context) {
  const std::filesystem::path folder = context.preferences.save_folder;
  std::error_code failure;
  if (!folder.empty() && std::filesystem::is_directory(folder, failure)) return folder;
  return std::filesystem::current_path(failure);
}

void VideoRecorder::toggle(PanelContext& context) {
  if (!screen_) {
    start_requested_ = true;
    return;
  }
  if (ending_) return;
  ending_ = true;
  screen_->finish();
  if (settings.hide_panels) context.preferences.panels = true;
}

double VideoRecorder::seconds() const { return wall_now() - start_time_; }

void VideoRecorder::start(PanelContext& context, WindowSize pixels) {
  start_requested_ = ending_ = false;
  const std::filesystem::path file = new_video_file(context, settings);
  screen_ = std::make_unique<ScreenRecording>(file.string(), PictureSize{pixels.width, pixels.height},
                                              settings.frames_per_second);
  start_time_ = wall_now();
  if (settings.hide_panels) context.preferences.panels = false;
  context.toasts.show(Tone::info, "recording (V to stop)");
  context.log.write("recording", {{"file", file.string()}});
}

void VideoRecorder::capture_frame(PanelContext& context, WindowSize pixels) {
  if (group_ && group_->status().over()) {
    report_end(context, group_->status(), group_is_picture_ ? "picture" : "video");
    group_.reset();
  }
  if (start_requested_) start(context, pixels);
  if (!screen_) return;
  const PictureSize size = screen_->size();
  const bool resized = pixels.width / 2 != size.width / 2 || pixels.height / 2 != size.height / 2;
  if (!ending_ && resized) toggle(context);
  if (!ending_ && screen_->wants(seconds())) screen_->offer(seconds(), read_window(pixels));
  if (!screen_->status().over()) return;
  report_end(context, screen_->status());
  if (settings.hide_panels && !ending_) context.preferences.panels = true;
  screen_.reset();
}

void VideoRecorder::start_group(PanelContext& context, const GroupVideoOptions& options) {
  group_is_picture_ = options.still.has_value();
  with_window_camera(context, [&] { group_ = context.scene.exports().video(options); });
  context.log.write("filming", {{"file", options.output}});
}

void VideoRecorder::start_group_video(PanelContext& context) {
  start_group(context, {.output = new_video_file(context, settings).string(),
                        .size = VideoSettings::group_sizes[static_cast<std::size_t>(settings.group_size)],
                        .frames_per_second = static_cast<double>(settings.frames_per_second),
                        .seconds = settings.group_seconds,
                        .speed = settings.group_speed,
                        .quality = context.preferences.quality});
}

void VideoRecorder::start_group_picture(PanelContext& context) {
  start_group(context, {.output = unused_path(picture_folder(context), ".png").string(),
                        .size = VideoSettings::group_sizes[static_cast<std::size_t>(settings.group_size)],
                        .still = context.scene.snapshot().time,
                        .hero = settings.hero,
                        .aperture = settings.aperture,
                        .quality = context.preferences.quality});
}

void draw_recording_sign(ImDrawList& list, PanelContext& context, const ViewportArea& area) {
  const std::string time = clock_text(std::floor(context.recorder.seconds()));
  const float text = ImGui::GetFontSize();
  // Below the caption.
  const float top = std::max(area.low.y, context.caption.high.y);
  const ImVec2 low{area.low.x + 0.6f * text, top + 0.8f * text};
  const ImVec2 high{low.x + 1.9f * text + ImGui::CalcTextSize(time.c_str()).x, low.y + 1.5f * text};
  const float middle = (low.y + high.y) / 2;
  list.AddRectFilled(low, high, palette().on_view, 0.4f * text);
  list.AddCircleFilled({low.x + 0.8f * text, middle}, 0.4f * text, IM_COL32(235, 40, 40, 255));
  list.AddText(ImGui::GetFont(), text, {low.x + 1.5f * text, middle - 0.5f * text}, ImGui::GetColorU32(ImGuiCol_Text),
               time.c_str());
  context.log.item("recording.sign", low, high);
}

void VideoPanel::draw(PanelContext& context) {
  draw_recording(context);
  draw_group(context);
  heading("Screenshot");
  if (ImGui::Button("Save a screenshot", {-1, 0})) context.screenshot_requested = true;
  context.log.item("video.screenshot");
  tooltip("key P or F2; press H first to leave out the panels");
  note(fmt::format("Videos and screenshots go to {}", picture_folder(context).string()).c_str());
}

std::unique_ptr<Panel> make_video_panel(PanelContext&) { return std::make_unique<VideoPanel>(); }

}  // namespace mercury::window
