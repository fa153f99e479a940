// SPDX-License-Identifier: Apache-2.0
// Several frames side by side in one picture.
#pragma once

#include "app/scene/group_layout.h"
#include "app/video/frame_writer.h"

namespace mercury {

// The size of a sheet of frames of this size, with `gap` pixels between them. Throws ParameterError("size", ...) for
// one wider or higher than 32768 pixels.
PictureSize size_of_sheet(Grid grid, PictureSize frame, int gap);

// Throws ParameterError("output", ...) for a name that is not *.png.
void require_picture_name(const std::string& output);

// A still picture is a sheet of one. Takes rgb frames and lays them out row by row; finish() writes them as one PNG.
// Cells without a frame stay empty.
class ContactSheet final : public FrameWriter {
 public:
  // Throws as require_picture_name() and size_of_sheet().
  ContactSheet(const std::string& output, Grid grid, PictureSize frame, int gap, std::string comment = {},
               double dpi = 0);
  void write(const render::Image& frame) override;
  void finish() override;
  std::string description() const override;

 private:
  std::string output_, comment_;
  Grid grid_;
  PictureSize frame_;
  int gap_;
  double dpi_;
  int count_ = 0;
  render::Image sheet_;
};

}  // namespace mercury
