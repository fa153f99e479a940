// SPDX-License-Identifier: Apache-2.0
#include "app/options/video_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/options/option_values.h"
#include "app/video/contact_sheet.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

constexpr int sheet_gap = 4;        // between the moments of a contact sheet [pixels]
constexpr int most_moments = 1000;  // of a contact sheet in a row, or a column
constexpr double slowest = 1e-6;    // simulated seconds per second of video

PictureSize size_from(const std::string& option, const std::string& text) {
  static const std::map<std::string, PictureSize> names{{"480p", {854, 480}},
                                                        {"720p", {1280, 720}},
                                                        {"1080p", {1920, 1080}},
                                                        {"1440p", {2560, 1440}},
                                                        {"4k", {3840, 2160}}};
  if (const auto found = names.find(text); found != names.end()) return found->second;
  const auto sizes = sizes_from(option, text, 2, "WIDTHxHEIGHT, 720p, 1080p or 4k");
  return {sizes[0], sizes[1]};
}

}  // namespace

void VideoOptions::add_to(const Command& command) {
  const auto add = [](const Option& option) { option.in_group("Picture"); };
  add_text(command, "-o,--output", output_,
           "Video (.mp4, .webm, .gif, .apng), picture (.png, .svg, .pdf) or folder of frames", "FILE|FOLDER")
      .required();
  add(add_value(command, "--size", size_, "Size of the picture (default 1280x720)", "WxH|720p|1080p|4k", size_from)
          .on_first_screen());
  add(add_number(command, "--fps", frames_per_second_, "Frames per second of video (default 30; 25 for .gif)", "N")
          .on_first_screen());
  add(add_number(command, "--speed", speed_, "Simulated seconds per second of video (default 1)", "X"));
  add(add_number(command, "--still", still_, "One picture (.png) of this moment rather than a video", "S")
          .on_first_screen());
  add(add_value(command, "--contact-sheet", contact_sheet_,
                "Columns and rows of moments of --seconds in one picture (.png), as wide as --size", "CxR", grid_from));
  add(add_choice(command, "--style", style_, {"usual", "hero"},
                 "hero: a still of the first robot against the light (default usual)")
          .on_first_screen());
  add(add_number(command, "--aperture", aperture_,
                 "Of a still: blur what is nearer or farther than the robot that the camera follows; diameter of the "
                 "lens over its distance, as in 0.05 (default 0: all is sharp)",
                 "X"));
  add(add_number(command, "--dpi", dpi_, "How large a picture is on paper: pixels per inch, as in 300", "N"));
  add(command.add_flag("--tight", tight_, "With --background: cut the picture off around what it shows"));
  add(command.add_flag("--each", each_, "A video of each robot alone: FILE-ROBOT.mp4"));
  add(add_choice(command, "--quality", quality_, {"auto", "low", "medium", "high"},
                 "Quality of the drawing (default auto: high on a GPU, low without)"));
  add(add_choice(command, "--gl", gl_, {"auto", "egl", "mesa", "osmesa"},
                 "OpenGL: a GPU (egl) or the processor (mesa, osmesa); default auto, the first that works"));
  add(command.add_flag("--no-interop", no_interop_,
                       "Copy positions through the host even where CUDA and OpenGL can share them on the GPU"));
  add(add_number(command, "--crf", crf_,
                 "Of the encoding: lower is better and larger, 0 is lossless (default 18 .mp4, 30 .webm)", "N"));
  add(add_text(command, "--ffmpeg", ffmpeg_, "The encoder (default: MERCURY_FFMPEG, else ffmpeg)", "PROGRAM"));
}

void VideoOptions::validate() const {
  require_drawable(asked_size());
  if (frames_per_second_) require_positive("--fps", *frames_per_second_, " frames/s");
  if (!(speed_ >= slowest && speed_ <= 1 / slowest))
    throw InputError("--speed", fmt::format("{} is not accepted; give {} to {:.0f}", speed_, slowest, 1 / slowest));
  if (still_ && !(std::isfinite(*still_) && *still_ >= 0))
    throw InputError("--still", fmt::format("{} is not accepted; give a finite number >= 0 s", *still_));
  if (dpi_ && !(*dpi_ >= 1 && *dpi_ <= 100000))
    throw InputError("--dpi", fmt::format("{} is not accepted; give 1 to 100000 pixels per inch", *dpi_));
  if (!(aperture_ >= 0 && aperture_ <= 1))
    throw InputError("--aperture", fmt::format("{} is not accepted; give 0 to 1", aperture_));
  if (!still_ && hero()) throw InputError("--style", "hero is a picture; give --still, or -o FILE.png");
  if (!still_ && aperture_ > 0) throw InputError("--aperture", "is of a picture; give --still, or -o FILE.png");
  if (dpi_ && !single_picture()) throw InputError("--dpi", "is of a picture; give --still, or -o FILE.png");
  if (still_ && contact_sheet_) throw InputError("--still", "not together with --contact-sheet; give one of them");
  if (contact_sheet_ && std::max(contact_sheet_->columns, contact_sheet_->rows) > most_moments)
    throw InputError("--contact-sheet", fmt::format("{}x{} is not accepted; give up to {} columns and rows",
                                                    contact_sheet_->columns, contact_sheet_->rows, most_moments));
}

render::Quality VideoOptions::quality() const {
  const render::Quality quality = render::quality_named(quality_);
  return quality == render::Quality::automatic && hero() ? render::Quality::medium : quality;
}

void VideoOptions::set_usual_still(double seconds) {
  if (!single_picture() && (text_aside() || extension_of(output_) == ".png")) still_ = seconds;
}

PictureSize VideoOptions::asked_size() const {
  return size_.value_or(contact_sheet_ ? PictureSize{1920, 1080} : PictureSize{});
}

VideoOptions::Plan VideoOptions::plan(double seconds) const {
  validate();
  if (single_picture()) return plan_pictures(seconds);
  const VideoKind kind = video_kind_of(output_);
  const double rate = frames_per_second_.value_or(usual_frame_rate(kind));
  require_encodable(kind, rate, crf_);
  return {.size = encoded_size(kind, asked_size()),
          .pixels = pixel_format_of(kind),
          .timing = video_timing(seconds, speed_, rate)};
}

bool VideoOptions::text_aside() const {
  const std::string extension = extension_of(output_);
  return extension == ".svg" || extension == ".pdf";
}

void VideoOptions::plan_figure(render::Color background, Plan& plan) const {
  if (contact_sheet_) throw InputError("--background", "not together with --contact-sheet");
  plan.pixels = render::PixelFormat::rgb;
  if (!single_picture()) plan.written_pixels = figure_pixels(video_kind_of(output_), background);
}

VideoOptions::Plan VideoOptions::plan_pictures(double seconds) const {
  if (!still_ || !text_aside()) require_picture_name(output_);
  if (still_) return {.size = asked_size(), .timing = {.frames = 1, .start = *still_}};
  const PictureSize sheet = asked_size();
  const int width = (sheet.width + sheet_gap) / contact_sheet_->columns - sheet_gap;
  const PictureSize frame{width,
                          static_cast<int>(std::lround(static_cast<double>(width) * sheet.height / sheet.width))};
  if (frame.width < 16 || frame.height < 16)
    throw InputError("--contact-sheet", "the moments are too small to be drawn; give a larger --size or fewer moments");
  size_of_sheet(*contact_sheet_, frame, sheet_gap);
  const std::int64_t frames = static_cast<std::int64_t>(contact_sheet_->columns) * contact_sheet_->rows;
  const double interval = frames > 1 ? seconds / static_cast<double>(frames - 1) : 0;
  return {.size = frame, .timing = {.frames = frames, .interval = interval, .pace = interval}};
}

std::string VideoOptions::output_of(const std::string& name) const {
  if (name.empty()) return output_;
  std::filesystem::path path(output_);
  if (path.filename().empty()) path = path.parent_path();
  const bool is_folder = !single_picture() && video_kind_of(output_) == VideoKind::png_folder;
  const std::string extension = is_folder ? "/" : path.extension().string();  // a robot called v1.2 is no file type
  return (path.parent_path() / (path.stem().string() + "-" + name + extension)).string();
}

void VideoOptions::add_output_to(OutputFiles& outputs, const std::string& name) const {
  const std::string output = output_of(name);
  // With --each, the robot's name makes that of the file.
  std::filesystem::path inside;
  if (!name.empty()) inside = std::filesystem::path(output + "/").lexically_normal().parent_path().parent_path();
  if (!name.empty() && inside.empty()) inside = ".";
  if (single_picture())
    outputs.add_stream("-o", output, inside);
  else if (video_kind_of(output) == VideoKind::png_folder)
    outputs.add_new_folder("-o", output, inside);
  else
    outputs.add_file("-o", output, inside);
}

std::unique_ptr<FrameWriter> VideoOptions::open(const Plan& plan, const std::string& name, bool may_replace,
                                                const std::string& comment) const {
  const std::string output = output_of(name);
  if (single_picture())
    return std::make_unique<ContactSheet>(output, contact_sheet_.value_or(Grid{}), plan.size, sheet_gap, comment,
                                          dpi());
  return open_frame_writer(output, {.size = plan.size,
                                    .frames_per_second = 1 / plan.timing.pace,
                                    .expected_frames = plan.timing.frames,
                                    .crf = crf_,
                                    .comment = comment,
                                    .ffmpeg = ffmpeg_,
                                    .pixels = plan.written_pixels,
                                    .force = may_replace});
}

}  // namespace mercury
