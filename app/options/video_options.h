// SPDX-License-Identifier: Apache-2.0
// The options for pictures and videos: size, timing, quality, encoding.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/base/output_files.h"
#include "app/options/command.h"
#include "app/scene/group_layout.h"
#include "app/video/frame_writer.h"
#include "app/video/video_stages.h"
#include "render/context/context.h"
#include "render/renderer.h"

namespace mercury {

class VideoOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);

  // All of the following throw InputError that names the option that cannot be used.

  // The frames to make of `seconds` of simulated time.
  struct Plan {
    PictureSize size;                                       // of a frame
    render::PixelFormat pixels = render::PixelFormat::rgb;  // as drawn
    VideoTiming timing;
    std::optional<render::PixelFormat> written_pixels = {};  // of a figure, see VideoSettings::pixels
  };
  Plan plan(double seconds) const;
  // Changes a plan to that of a figure.
  void plan_figure(render::Color background, Plan& plan) const;
  // The writer of the frames. `name`: the robot that is filmed alone; empty = all robots. `may_replace`: see
  // VideoSettings::force.
  std::unique_ptr<FrameWriter> open(const Plan& plan, const std::string& name, bool may_replace,
                                    const std::string& comment) const;
  // The file or folder that open() writes.
  std::string output_of(const std::string& name) const;
  void add_output_to(OutputFiles& outputs, const std::string& name) const;

  // From now on: one picture, of this moment, unless the options ask for another kind of output [s].
  void set_usual_still(double seconds);

  double speed() const { return speed_; }
  bool each() const { return each_; }
  std::optional<double> still() const { return still_; }  // [s]
  std::optional<Grid> contact_sheet() const { return contact_sheet_; }
  bool hero() const { return style_ == "hero"; }
  float aperture() const { return aperture_; }
  bool tight() const { return tight_; }
  double dpi() const { return dpi_.value_or(0); }
  // Whether the picture is a document (.svg, .pdf), whose text is text.
  bool text_aside() const;
  bool single_picture() const { return still_ || contact_sheet_; }
  PictureSize asked_size() const;
  render::ContextKind context_kind() const { return render::context_kind_named(gl_); }
  bool interop() const { return !no_interop_; }
  render::Quality quality() const;

 private:
  void validate() const;
  Plan plan_pictures(double seconds) const;

  std::string output_;
  std::optional<PictureSize> size_;
  std::optional<double> frames_per_second_, still_;
  std::optional<Grid> contact_sheet_;
  double speed_ = 1;
  std::optional<int> crf_;
  std::optional<double> dpi_;
  bool each_ = false, no_interop_ = false, tight_ = false;
  float aperture_ = 0;
  std::string ffmpeg_, gl_ = "auto", quality_ = "auto", style_ = "usual";
};

}  // namespace mercury
