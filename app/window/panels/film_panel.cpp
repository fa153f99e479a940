// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/film_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/window/picture/screenshot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

constexpr const char* kinds[] = {".mp4", ".webm", ".gif"};
constexpr std::array<PictureSize, 4> sizes{{{1280, 720}, {1920, 1080}, {2560, 1440}, {3840, 2160}}};

void progress(const FilmStatus& status, const char* doing) {
  const bool finishing = status.state == FilmStatus::State::finishing;
  const float share = status.total > 0 ? static_cast<float>(status.frames) / static_cast<float>(status.total)
                      : finishing      ? 1.0f
                                       : 0.0f;
  const std::string frames =
      status.total > 0 ? fmt::format("{} of {}", status.frames, status.total) : fmt::format("{}", status.frames);
  ImGui::ProgressBar(share, {-1, 0}, finishing ? "finishing" : fmt::format("{}: {} frames", doing, frames).c_str());
  if (status.dropped > 0) note(fmt::format("{} frames were left out: the encoder is behind", status.dropped).c_str());
}

void tell_end(Desk& desk, const FilmStatus& status) {
  if (status.state == FilmStatus::State::failed) desk.toasts.say(Tone::error, status.error);
  if (status.state == FilmStatus::State::cancelled)
    desk.toasts.say(Tone::news, "the video was given up; nothing was kept");
  if (status.state != FilmStatus::State::done) return;
  desk.toasts.say(Tone::success, "video saved: " + status.file);
  desk.observations.tell("recorded", {{"file", status.file}, {"frames", status.frames}});
}

}  // namespace

std::filesystem::path picture_folder(const Desk& desk) {
  const std::filesystem::path folder = desk.preferences.save_folder;
  std::error_code failure;
  if (!folder.empty() && std::filesystem::is_directory(folder, failure)) return folder;
  return std::filesystem::current_path(failure);
}

void FilmPanel::draw(Desk& desk, const std::function<void()>& screenshot) {
  draw_screen(desk);
  draw_group(desk);
  heading("Picture");
  if (ImGui::Button("Picture of the window", {-1, 0})) screenshot();
  desk.observations.item("film.picture");
  hint("key P or F2; hide the panels with H first if they should not be in it");
  note(fmt::format("Pictures and videos go into {}", picture_folder(desk).string()).c_str());
}

void FilmPanel::draw_screen(Desk& desk) {
  heading("Video of the window");
  if (!screen_) {
    choice("kind", "of file, for both kinds of video", kind_, {"MP4", "WebM", "GIF"});
    row("frames a second", nullptr);
    ImGui::SliderInt("##rate", &rate_, 10, 60);
    rate_ = std::clamp(rate_, 1, 120);
    ImGui::Checkbox("Without panels", &hide_panels_);
    hint("they come back when the video ends (key V)");
    if (ImGui::Button("Record", {-1, 0})) toggle(desk);
    desk.observations.item("film.record");
    hint("what is on the screen, until you end it (key V)");
    return;
  }
  ImGui::TextUnformatted(
      fmt::format("{:.1f} s, {} x {}", seconds(), screen_->size().width, screen_->size().height).c_str());
  progress(screen_->status(), "recording");
  ImGui::BeginDisabled(ending_);
  if (ImGui::Button("End the video", {-1, 0})) toggle(desk);
  desk.observations.item("film.record");
  ImGui::EndDisabled();
}

void FilmPanel::draw_group(Desk& desk) {
  heading("Clean video of the group");
  if (group_) {
    progress(group_->status(), "filming");
    if (ImGui::Button("Cancel##group", {-1, 0})) group_->cancel();
    return;
  }
  draw_group_options(desk);
  ImGui::BeginDisabled(desk.scene.entries().empty());
  if (ImGui::Button("Make the video", {-1, 0})) {
    options_.output = fresh_name(picture_folder(desk), kinds[kind_]).string();
    options_.size = sizes[static_cast<std::size_t>(size_)];
    options_.frames_per_second = rate_;
    options_.quality = desk.preferences.quality;
    as_seen(desk, [&] { group_ = desk.scene.film(options_); });
    desk.observations.tell("filming", {{"file", options_.output}});
  }
  desk.observations.item("film.group");
  ImGui::EndDisabled();
  hint("all robots from the start, as they are seen now but without panels, made beside the window");
}

void FilmPanel::draw_group_options(Desk&) {
  choice("size", "of the video", size_, {"1280 x 720", "1920 x 1080", "2560 x 1440", "3840 x 2160"});
  auto length = static_cast<float>(options_.seconds), speed = static_cast<float>(options_.speed);
  if (slider("length", "simulated time", length, 10, {1, 120, "%.0f s", true}) && length > 0)
    options_.seconds = static_cast<double>(length);
  if (slider("speed", "simulated seconds a second of video", speed, 1, {0.1f, 10, "\xc3\x97 %.2f", true}) && speed > 0)
    options_.speed = static_cast<double>(speed);
}

void FilmPanel::toggle(Desk& desk) {
  if (!screen_) {
    wanted_ = true;
    return;
  }
  if (ending_) return;
  ending_ = true;
  screen_->finish();
  if (hide_panels_) desk.preferences.panels = true;
}

double FilmPanel::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void FilmPanel::begin(Desk& desk, WindowSize pixels) {
  wanted_ = ending_ = false;
  const std::filesystem::path file = fresh_name(picture_folder(desk), kinds[kind_]);
  screen_ = std::make_unique<ScreenRecording>(file.string(), PictureSize{pixels.width, pixels.height}, rate_);
  start_ = std::chrono::steady_clock::now();
  if (hide_panels_) desk.preferences.panels = false;
  desk.toasts.say(Tone::news, "recording (V to end)");
  desk.observations.tell("recording", {{"file", file.string()}});
}

void FilmPanel::frame(Desk& desk, WindowSize pixels) {
  if (group_ && group_->status().over()) {
    tell_end(desk, group_->status());
    group_.reset();
  }
  if (wanted_) begin(desk, pixels);
  if (!screen_) return;
  const PictureSize size = screen_->size();
  // A video has one size: it ends when the window gets another.
  const bool resized = pixels.width / 2 != size.width / 2 || pixels.height / 2 != size.height / 2;
  if (!ending_ && resized) toggle(desk);
  if (!ending_ && screen_->wants(seconds())) screen_->offer(seconds(), read_window(pixels));
  if (!screen_->status().over()) return;
  tell_end(desk, screen_->status());
  if (hide_panels_ && !ending_) desk.preferences.panels = true;
  screen_.reset();
}

}  // namespace mercury::window
