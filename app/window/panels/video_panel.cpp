// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/video_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/window/toolkit/screenshot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

constexpr const char* kinds[] = {".mp4", ".webm", ".gif"};
constexpr std::array<PictureSize, 4> sizes{{{1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}};

void progress(const VideoStatus& status, const char* doing) {
  const bool finishing = status.state == VideoStatus::State::finishing;
  const float share = status.total > 0 ? static_cast<float>(status.frames) / static_cast<float>(status.total)
                      : finishing      ? 1.0f
                                       : 0.0f;
  const std::string frames =
      status.total > 0 ? fmt::format("{} of {}", status.frames, status.total) : fmt::format("{}", status.frames);
  ImGui::ProgressBar(share, {-1, 0}, finishing ? "finishing" : fmt::format("{}: {} frames", doing, frames).c_str());
  if (status.dropped > 0) note(fmt::format("{} frames were left out: the encoder is behind", status.dropped).c_str());
}

void tell_end(PanelContext& context, const VideoStatus& status) {
  if (status.state == VideoStatus::State::failed) context.toasts.show(Tone::error, status.error);
  if (status.state == VideoStatus::State::cancelled)
    context.toasts.show(Tone::info, "the video was given up; nothing was kept");
  if (status.state != VideoStatus::State::done) return;
  context.toasts.show(Tone::success, "video saved: " + status.file);
  context.log.write("recorded", {{"file", status.file}, {"frames", status.frames}});
}

}  // namespace

std::filesystem::path picture_folder(const PanelContext& context) {
  const std::filesystem::path folder = context.preferences.save_folder;
  std::error_code failure;
  if (!folder.empty() && std::filesystem::is_directory(folder, failure)) return folder;
  return std::filesystem::current_path(failure);
}

void VideoPanel::draw(PanelContext& context, const std::function<void()>& screenshot) {
  draw_screen(context);
  draw_group(context);
  heading("Picture");
  if (ImGui::Button("Picture of the window", {-1, 0})) screenshot();
  context.log.item("video.picture");
  tooltip("key P or F2; hide the panels with H first if they should not be in it");
  note(fmt::format("Pictures and videos go into {}", picture_folder(context).string()).c_str());
}

void VideoPanel::draw_screen(PanelContext& context) {
  heading("Video of the window");
  if (!screen_) {
    combo("kind", "of file, for both kinds of video", kind_, {"MP4", "WebM", "GIF"});
    row("frames a second", nullptr);
    ImGui::SliderInt("##rate", &rate_, 10, 60);
    rate_ = std::clamp(rate_, 1, 120);
    ImGui::Checkbox("Without panels", &hide_panels_);
    tooltip("they come back when the video ends (key V)");
    if (ImGui::Button("Record", {-1, 0})) toggle(context);
    context.log.item("video.record");
    tooltip("what is on the screen, until you end it (key V)");
    return;
  }
  ImGui::TextUnformatted(
      fmt::format("{:.1f} s, {} x {}", seconds(), screen_->size().width, screen_->size().height).c_str());
  progress(screen_->status(), "recording");
  ImGui::BeginDisabled(ending_);
  if (ImGui::Button("End the video", {-1, 0})) toggle(context);
  context.log.item("video.record");
  ImGui::EndDisabled();
}

void VideoPanel::draw_group(PanelContext& context) {
  heading("Clean video of the group");
  if (group_) {
    progress(group_->status(), "filming");
    if (ImGui::Button("Cancel##group", {-1, 0})) group_->cancel();
    return;
  }
  draw_group_options(context);
  ImGui::BeginDisabled(context.scene.entries().empty());
  if (ImGui::Button("Make the video", {-1, 0})) {
    options_.output = unused_path(picture_folder(context), kinds[kind_]).string();
    options_.size = sizes[static_cast<std::size_t>(size_)];
    options_.frames_per_second = rate_;
    options_.quality = context.preferences.quality;
    with_window_camera(context, [&] { group_ = context.scene.export_video(options_); });
    context.log.write("filming", {{"file", options_.output}});
  }
  context.log.item("video.group");
  ImGui::EndDisabled();
  tooltip("all robots from the start, as they are seen now but without panels, made beside the window");
}

void VideoPanel::draw_group_options(PanelContext&) {
  combo("size", "of the video", size_, {"1280 x 720", "1920 x 1080", "2560 x 1440", "3840 x 2160"});
  auto length = static_cast<float>(options_.seconds), speed = static_cast<float>(options_.speed);
  if (slider("length", "simulated time", length, 10, {1, 120, "%.0f s", true}) && length > 0)
    options_.seconds = static_cast<double>(length);
  if (slider("speed", "simulated seconds a second of video", speed, 1, {0.1f, 10, "\xc3\x97 %.2f", true}) && speed > 0)
    options_.speed = static_cast<double>(speed);
}

void VideoPanel::toggle(PanelContext& context) {
  if (!screen_) {
    wanted_ = true;
    return;
  }
  if (ending_) return;
  ending_ = true;
  screen_->finish();
  if (hide_panels_) context.preferences.panels = true;
}

double VideoPanel::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void VideoPanel::begin(PanelContext& context, WindowSize pixels) {
  wanted_ = ending_ = false;
  const std::filesystem::path file = unused_path(picture_folder(context), kinds[kind_]);
  screen_ = std::make_unique<ScreenRecording>(file.string(), PictureSize{pixels.width, pixels.height}, rate_);
  start_ = std::chrono::steady_clock::now();
  if (hide_panels_) context.preferences.panels = false;
  context.toasts.show(Tone::info, "recording (V to end)");
  context.log.write("recording", {{"file", file.string()}});
}

void VideoPanel::frame(PanelContext& context, WindowSize pixels) {
  if (group_ && group_->status().over()) {
    tell_end(context, group_->status());
    group_.reset();
  }
  if (wanted_) begin(context, pixels);
  if (!screen_) return;
  const PictureSize size = screen_->size();
  // A video has one size: it ends when the window gets another.
  const bool resized = pixels.width / 2 != size.width / 2 || pixels.height / 2 != size.height / 2;
  if (!ending_ && resized) toggle(context);
  if (!ending_ && screen_->wants(seconds())) screen_->offer(seconds(), read_window(pixels));
  if (!screen_->status().over()) return;
  tell_end(context, screen_->status());
  if (hide_panels_ && !ending_) context.preferences.panels = true;
  screen_.reset();
}

}  // namespace mercury::window
