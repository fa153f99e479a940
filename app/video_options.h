// The options of every command that makes pictures without a window.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

#include "app/frame_writer.h"
#include "app/group_layout.h"
#include "render/context.h"
#include "render/renderer.h"

namespace mercury {

struct VideoOptions {
  std::string output;
  PictureSize size;
  std::optional<double> frames_per_second;
  double speed = 1;
  int crf = -1;
  std::string ffmpeg;
  std::string gl = "auto", quality = "auto", theme = "dark";
  std::optional<Grid> grid;

  // Adds the options to a command. The object must outlive it.
  void add_to(CLI::App& command);

  // Frames/s: as given, else 30, and 25 for GIF, whose frame times are whole hundredths of a second.
  double rate(VideoKind kind) const;
  // Throws InputError naming the option that cannot be used.
  void validate() const;
  render::ContextKind context_kind() const;
  render::Quality draw_quality() const;
};

}  // namespace mercury
