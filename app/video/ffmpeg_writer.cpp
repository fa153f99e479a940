// SPDX-License-Identifier: Apache-2.0
#include "app/video/ffmpeg_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

#include <sys/wait.h>
#include <cerrno>
#include <csignal>
#include <cstring>

#include "mercury/error.h"
#include "mercury/file_links.h"

namespace mercury {
namespace {

// One palette for the whole GIF needs all frames in memory. Above this size, each frame gets a palette of its own.
constexpr double palette_memory = 1.5e9;  // [bytes]

std::vector<std::string> codec_arguments(VideoKind kind, const VideoSettings& settings) {
  const std::vector<std::string> color{"-colorspace", "bt709", "-color_primaries", "bt709",
                                       "-color_trc",  "bt709", "-color_range",     "tv"};
  std::vector<std::string> arguments;
  switch (kind) {
    case VideoKind::mp4:
      arguments = {"-c:v",      "libx264",   "-preset", "veryfast", "-crf", fmt::to_string(settings.crf.value_or(18)),
                   "-movflags", "+faststart"};
      // Lossless video has a profile of its own, which x264 chooses.
      if (settings.crf != 0) arguments.insert(arguments.end(), {"-profile:v", "high"});
      break;
    case VideoKind::webm:
      arguments = {"-c:v",      "libvpx-vp9", "-b:v",      "0", "-crf",    fmt::to_string(settings.crf.value_or(30)),
                   "-deadline", "good",       "-cpu-used", "5", "-row-mt", "1"};
      if (settings.crf == 0) arguments.insert(arguments.end(), {"-lossless", "1"});
      if (settings.pixels == render::PixelFormat::rgba) arguments.insert(arguments.end(), {"-auto-alt-ref", "0"});
      break;
    case VideoKind::gif: {
      const double bytes = 4.0 * settings.size.width * settings.size.height;
      const bool own_palettes = bytes * static_cast<double>(settings.expected_frames) > palette_memory;
      return {"-filter_complex",
              fmt::format("split[a][b];[a]palettegen=stats_mode={}[p];[b][p]paletteuse=dither=bayer:bayer_scale=4{}",
                          own_palettes ? "single" : "full", own_palettes ? ":new=1" : ":diff_mode=rectangle"),
              "-loop",
              "0",
              "-f",
              "gif"};
    }
    case VideoKind::apng:
      return {"-plays", "0", "-f", "apng"};
    case VideoKind::png_folder:
      break;
  }
  // Frames of figures are not converted by the GPU, since their opacities are not known there.
  if (settings.pixels)
    arguments.insert(arguments.end(),
                     {"-vf", fmt::format("scale=out_color_matrix=bt709:out_range=tv,format={}",
                                         settings.pixels == render::PixelFormat::rgba ? "yuva420p" : "yuv420p")});
  arguments.insert(arguments.end(), color.begin(), color.end());
  arguments.insert(arguments.end(), {"-f", kind == VideoKind::mp4 ? "mp4" : "webm"});
  return arguments;
}

// Creates the file at once, so that an unusable name is reported before anything is computed.
void create(const std::string& output, const UnfinishedFile& file) {
  if (is_device_or_pipe(output))
    throw ParameterError("output", output + " is a device or pipe; give the name of a file");
  const int descriptor = ::open(file.path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) throw ParameterError("output", output + " cannot be written: " + std::strerror(errno));
  ::close(descriptor);
}

}  // namespace

std::vector<std::string> ffmpeg_arguments(VideoKind kind, const VideoSettings& settings, const std::string& file) {
  const render::PixelFormat pixels = settings.pixels.value_or(pixel_format_of(kind));
  const bool yuv = pixels == render::PixelFormat::yuv420;
  std::vector<std::string> arguments{"-hide_banner",
                                     "-loglevel",
                                     "error",
                                     "-nostdin",
                                     "-y",
                                     "-f",
                                     "rawvideo",
                                     "-pixel_format",
                                     yuv                                   ? "yuv420p"
                                     : pixels == render::PixelFormat::rgba ? "rgba"
                                                                           : "rgb24",
                                     "-video_size",
                                     fmt::format("{}x{}", settings.size.width, settings.size.height),
                                     "-framerate",
                                     fmt::format("{}", settings.frames_per_second)};
  if (yuv) arguments.insert(arguments.end(), {"-colorspace", "bt709", "-color_range", "tv"});
  arguments.insert(arguments.end(), {"-i", "pipe:0", "-an"});
  const std::vector<std::string> codec = codec_arguments(kind, settings);
  arguments.insert(arguments.end(), codec.begin(), codec.end());
  if (!settings.comment.empty()) arguments.insert(arguments.end(), {"-metadata", "comment=" + settings.comment});
  // "file:" keeps ffmpeg from interpreting a colon or a leading dash in the name.
  arguments.push_back("file:" + file);
  return arguments;
}

std::string failure_line(const std::string& messages) {
  std::string last, guess;
  for (std::size_t start = 0; start < messages.size();) {
    std::size_t end = messages.find_first_of("\r\n", start);
    if (end == std::string::npos) end = messages.size();
    const std::string line = messages.substr(start, end - start);
    start = end + 1;
    const bool is_noise = line.find_first_not_of(" \t") == std::string::npos || line == "Conversion failed!" ||
                          line.find("Last message repeated") != std::string::npos;
    if (is_noise) continue;
    // ffmpeg guesses at rate and size after the encoder has said what is wrong.
    const bool is_guess = line.find("maybe incorrect parameters") != std::string::npos;
    (is_guess ? guess : last) = line.substr(line.find_first_not_of(" \t"));
  }
  if (last.empty()) last = guess;
  constexpr std::size_t longest = 300;
  return last.size() > longest ? last.substr(0, longest) + "..." : last;
}

FfmpegWriter::FfmpegWriter(const std::string& output, VideoKind kind, const VideoSettings& settings)
    : output_(output), kind_(kind), program_(encoder_program(settings.ffmpeg)), file_(output) {
  create(output, file_);
  try {
    encoder_.emplace(program_, ffmpeg_arguments(kind, settings, file_.path().string()));
  } catch (const CannotStart& error) {
    if (error.is_limit())
      throw VideoError(program_ +
                       " could not be started: the memory or the number of processes is limited (ulimit -v, "
                       "ulimit -u)");
    if (!settings.ffmpeg.empty()) throw ParameterError("ffmpeg", program_ + " cannot be started: " + error.what());
    if (program_ != "ffmpeg") throw InputError("MERCURY_FFMPEG", program_ + " cannot be started: " + error.what());
    throw VideoError(
        "ffmpeg was not found: install the package ffmpeg (apt install ffmpeg), name the program with --ffmpeg, or "
        "write PNG pictures into a folder (-o FOLDER)");
  }
}

void FfmpegWriter::write(const render::Image& frame) {
  if (!encoder_->write(frame.bytes)) fail(encoder_->finish());
  frames_.begin();
}

void FfmpegWriter::finish() {
  const int status = encoder_->finish();
  std::error_code error;
  if (status != 0 || std::filesystem::file_size(file_.path(), error) == 0 || error) fail(status);
  try {
    file_.keep();
  } catch (const std::filesystem::filesystem_error& failure) {
    throw VideoError(output_ + ": cannot be given its name: " + failure.code().message());
  }
}

void FfmpegWriter::abandon() { encoder_->signal(SIGKILL); }

void FfmpegWriter::fail(int status) {
  const std::string messages = encoder_->messages();
  if (messages.find("No space left on device") != std::string::npos)
    throw VideoError(output_ + ": " + reason_of(ENOSPC) + "; nothing was kept");
  if ((WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ) || messages.find("File too large") != std::string::npos)
    throw VideoError(output_ + ": " + reason_of(EFBIG) + "; nothing was kept");
  const std::string end = status == 0 ? "wrote nothing" : describe_exit(status);
  const std::string line = failure_line(messages);
  throw VideoError(output_ + ": the encoder " + program_ + " " + end + (line.empty() ? "" : ": " + line));
}

std::string FfmpegWriter::description() const {
  const char* codec = kind_ == VideoKind::mp4    ? "H.264"
                      : kind_ == VideoKind::webm ? "VP9"
                      : kind_ == VideoKind::apng ? "an animated PNG"
                                                 : "GIF";
  return fmt::format("{} by {}", codec, program_);
}

}  // namespace mercury
