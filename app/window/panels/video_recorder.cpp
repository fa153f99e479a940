// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/video_recorder.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/window/panels/scene_commands.h"
#include "app/window/toolkit/screenshot.h"
#include "app/window/toolkit/theme.h"

namespace mercury::window {
namespace {

void report_end(PanelContext& context, const VideoStatus& status) {
  if (status.state == VideoStatus::State::failed) context.toasts.show(Tone::error, status.error);
  if (status.state == VideoStatus::State::canceled)
    context.toasts.show(Tone::info, "the video was canceled; no file was kept");
  if (status.state != VideoStatus::State::done) return;
  context.toasts.show(Tone::success, "video saved: " + status.file);
  context.log.write("recorded", {{"file", status.file}, {"frames", status.frames}});
}

std::filesystem::path new_video_file(const PanelContext& context, const VideoSettings& settings) {
  return unused_path(picture_folder(context), VideoSettings::extensions[static_cast<std::size_t>(settings.format)]);
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

double VideoRecorder::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_time_).count();
}

void VideoRecorder::start(PanelContext& context, WindowSize pixels) {
  start_requested_ = ending_ = false;
  const std::filesystem::path file = new_video_file(context, settings);
  screen_ = std::make_unique<ScreenRecording>(file.string(), PictureSize{pixels.width, pixels.height},
                                              settings.frames_per_second);
  start_time_ = std::chrono::steady_clock::now();
  if (settings.hide_panels) context.preferences.panels = false;
  context.toasts.show(Tone::info, "recording (V to stop)");
  context.log.write("recording", {{"file", file.string()}});
}

void VideoRecorder::capture_frame(PanelContext& context, WindowSize pixels) {
  if (group_ && group_->status().over()) {
    report_end(context, group_->status());
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

void VideoRecorder::start_group_video(PanelContext& context) {
  GroupVideoOptions options;
  options.output = new_video_file(context, settings).string();
  options.size = VideoSettings::group_sizes[static_cast<std::size_t>(settings.group_size)];
  options.frames_per_second = settings.frames_per_second;
  options.seconds = settings.group_seconds;
  options.speed = settings.group_speed;
  options.quality = context.preferences.quality;
  with_window_camera(context, [&] { group_ = context.scene.export_video(options); });
  context.log.write("filming", {{"file", options.output}});
}

void draw_recording_sign(ImDrawList& list, PanelContext& context, const ViewportArea& area) {
  const auto seconds = static_cast<long>(context.recorder.seconds());
  const std::string time = fmt::format("{}:{:02}", seconds / 60, seconds % 60);
  const float text = ImGui::GetFontSize();
  const ImVec2 low{area.low.x + 1.2f * text, area.low.y + 0.8f * text};
  const ImVec2 high{low.x + 1.9f * text + ImGui::CalcTextSize(time.c_str()).x, low.y + 1.5f * text};
  const float middle = (low.y + high.y) / 2;
  list.AddRectFilled(low, high, palette().on_picture, 0.4f * text);
  list.AddCircleFilled({low.x + 0.8f * text, middle}, 0.4f * text, IM_COL32(235, 40, 40, 255));
  list.AddText(ImGui::GetFont(), text, {low.x + 1.5f * text, middle - 0.5f * text}, ImGui::GetColorU32(ImGuiCol_Text),
               time.c_str());
  context.log.item("recording.sign", low, high);
}

}  // namespace mercury::window
