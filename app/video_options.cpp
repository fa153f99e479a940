#include "app/video_options.h"

#include <map>

#include "app/option_values.h"

namespace mercury {
namespace {

PictureSize size_from(const std::string& option, const std::string& text) {
  static const std::map<std::string, PictureSize> names{
      {"480p", {854, 480}}, {"720p", {1280, 720}}, {"1080p", {1920, 1080}}, {"1440p", {2560, 1440}}, {"4k", {3840, 2160}}};
  if (const auto found = names.find(text); found != names.end()) return found->second;
  const auto sizes = sizes_from(option, text, 2, "WIDTHxHEIGHT, 720p, 1080p or 4k");
  return {sizes[0], sizes[1]};
}

Grid grid_from(const std::string& option, const std::string& text) {
  const auto sizes = sizes_from(option, text, 2, "COLUMNSxROWS");
  return {sizes[0], sizes[1]};
}

}  // namespace

void VideoOptions::add_to(CLI::App& command) {
  add_text(command, "-o,--output", output, "Video (.mp4, .webm, .gif), or a folder for PNG pictures", "FILE|FOLDER")
      ->required();
  add_value(command, "--size", size, "Size of the picture (default 1280x720)", "WxH|720p|1080p|4k", size_from)
      ->group("Picture");
  add_number(command, "--fps", frames_per_second, "Frames a second of video (default 30; 25 for .gif)", "N")
      ->group("Picture");
  add_number(command, "--speed", speed, "Simulated seconds a second of video (default 1)", "X")->group("Picture");
  add_value(command, "--grid", grid, "Columns and rows of the group (default: what fills the picture)", "CxR", grid_from)
      ->group("Picture");
  add_choice(command, "--quality", quality, {"auto", "low", "medium", "high"},
             "How well it is drawn (default auto: high on a GPU, low without)")
      ->group("Picture");
  add_choice(command, "--theme", theme, {"dark", "light"}, "Colours of the surroundings (default dark)")->group("Picture");
  add_choice(command, "--gl", gl, {"auto", "egl", "mesa", "osmesa"},
             "OpenGL: a card (egl) or the processor (mesa, osmesa); default auto, the first that works")
      ->group("Picture");
  add_number(command, "--crf", crf, "Quality of the encoding, lower is better and larger (default 18 .mp4, 30 .webm)", "N")
      ->group("Picture");
  add_text(command, "--ffmpeg", ffmpeg, "The encoder (default: MERCURY_FFMPEG, else ffmpeg)", "PROGRAM")->group("Picture");
}

double VideoOptions::rate(VideoKind kind) const {
  return frames_per_second.value_or(kind == VideoKind::gif ? 25 : 30);
}

void VideoOptions::validate() const {
  if (frames_per_second) require_positive("--fps", *frames_per_second, " frames/s");
  require_positive("--speed", speed, "");
  if (crf < -1 || crf > 63) throw InputError("--crf", std::to_string(crf) + " is not accepted; give 0 to 51 (.mp4) or 63 (.webm)");
}

render::ContextKind VideoOptions::context_kind() const { return render::context_kind_named(gl); }
render::Quality VideoOptions::draw_quality() const { return render::quality_named(quality); }

}  // namespace mercury
