// SPDX-License-Identifier: Apache-2.0
#include "app/video/frame_writer.h"

#include <fmt/format.h>

#include <cstdlib>

#include "app/base/output_files.h"
#include "app/base/version.h"
#include "app/video/ffmpeg_writer.h"
#include "app/video/png_folder.h"
#include "mercury/error.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

void require_usable(const std::string& output, VideoKind kind, const VideoSettings& settings) {
  require_drawable(settings.size);
  require_encodable(kind, settings.frames_per_second, settings.crf);
  if (settings.size != encoded_size(kind, settings.size))
    throw InputError(output, "this format needs an even width and height");
}

const char* name_of(VideoKind kind) {
  switch (kind) {
    case VideoKind::mp4:
      return ".mp4";
    case VideoKind::webm:
      return ".webm";
    case VideoKind::gif:
      return ".gif";
    case VideoKind::apng:
      return ".apng";
    case VideoKind::png_folder:
      break;
  }
  return "a folder of PNG pictures";
}

}  // namespace

void require_drawable(PictureSize size) {
  const auto [width, height] = size;
  if (width < 1 || height < 1 || width > 16384 || height > 16384)
    throw ParameterError("size", std::to_string(width) + "x" + std::to_string(height) +
                                     " is not accepted; give WIDTHxHEIGHT from 1x1 to 16384x16384");
}

void require_encodable(VideoKind kind, double frames_per_second, std::optional<int> crf) {
  // Slower than one frame in 1000 s, formats round the rate to 0.
  if (!(frames_per_second >= 0.001 && frames_per_second <= 1000))
    throw ParameterError("fps", fmt::format("{} is not accepted; give 0.001 to 1000 frames/s", frames_per_second));
  if (kind == VideoKind::gif && frames_per_second > 50)
    throw ParameterError("fps", "a GIF shows at most 50 frames/s; give 50 or less, or another format");
  if (kind == VideoKind::gif && frames_per_second < 0.002)
    throw ParameterError("fps", "a GIF shows a frame for at most 500 s; give 0.002 or more, or another format");
  if (!crf) return;
  const int worst = kind == VideoKind::mp4 ? 51 : kind == VideoKind::webm ? 63 : -1;
  if (worst < 0) throw ParameterError("crf", fmt::format("{} has no such quality; leave it out", name_of(kind)));
  if (*crf < 0 || *crf > worst)
    throw ParameterError("crf", fmt::format("{} is not accepted; give 0 to {} for {}", *crf, worst, name_of(kind)));
}

void make_parent_folder(const fs::path& output) {
  const fs::path parent = output.parent_path();
  std::error_code error;
  if (!parent.empty()) fs::create_directories(parent, error);
  if (error) throw ParameterError("output", "cannot make the folder " + parent.string() + ": " + error.message());
}

VideoKind video_kind_of(const std::string& output) {
  const fs::path path(output);
  if (output.empty())
    throw ParameterError("output", "give a file (.mp4, .webm, .gif or .apng) or a folder for PNG pictures");
  if (is_standard_output(output))
    throw ParameterError("output", "videos and pictures are not written to standard output; give a file or a folder");
  if (fs::is_directory(path) || path.filename().empty()) return VideoKind::png_folder;
  const std::string extension = extension_of(path);
  if (extension == ".mp4") return VideoKind::mp4;
  if (extension == ".webm") return VideoKind::webm;
  if (extension == ".gif") return VideoKind::gif;
  if (extension == ".apng") return VideoKind::apng;
  if (extension.empty()) return VideoKind::png_folder;
  if (extension == ".png")
    throw ParameterError("output",
                         output + " is one picture; add --still SECONDS or --contact-sheet 5x2, or give a folder");
  throw ParameterError(
      "output", output + ": \"" + extension +
                    "\" is not a format written here; give .mp4, .webm, .gif, .apng, or a folder for PNG pictures");
}

std::string comment_of(const Robot& robot, const Configuration& configuration) {
  return fmt::format("{}, {} physics, {}, {} solver, dt {} s", program_version, name_of(physics_of(robot)),
                     name_of(configuration.environment), name_of(configuration.solver), configuration.dt);
}

double usual_frame_rate(VideoKind kind) { return kind == VideoKind::gif ? 25 : 30; }

PictureSize encoded_size(VideoKind kind, PictureSize size) {
  if (pixel_format_of(kind) != render::PixelFormat::yuv420) return size;
  return {size.width + size.width % 2, size.height + size.height % 2};
}

render::PixelFormat pixel_format_of(VideoKind kind) {
  return kind == VideoKind::mp4 || kind == VideoKind::webm ? render::PixelFormat::yuv420 : render::PixelFormat::rgb;
}

render::PixelFormat figure_pixels(VideoKind kind, render::Color background) {
  if (background.a != 0) return render::PixelFormat::rgb;
  if (kind == VideoKind::mp4)
    throw ParameterError("background", ".mp4 has no transparency; give .webm, .gif, .apng or a folder, or a color");
  return render::PixelFormat::rgba;
}

std::string encoder_program(const std::string& ffmpeg_option) {
  if (!ffmpeg_option.empty()) return ffmpeg_option;
  const char* named = std::getenv("MERCURY_FFMPEG");
  return named && *named ? named : "ffmpeg";
}

std::unique_ptr<FrameWriter> open_frame_writer(const std::string& output, const VideoSettings& settings) {
  const VideoKind kind = video_kind_of(output);
  require_usable(output, kind, settings);
  if (kind == VideoKind::png_folder) {
    const fs::path path(output);
    const fs::path folder = path.filename().empty() && path.has_parent_path() ? path.parent_path() : path;
    make_parent_folder(folder);
    return std::make_unique<PngFolder>(folder, settings.force, settings.comment);
  }
  make_parent_folder(output);
  return std::make_unique<FfmpegWriter>(output, kind, settings);
}

}  // namespace mercury
