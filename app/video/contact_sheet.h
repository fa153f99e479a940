// SPDX-License-Identifier: Apache-2.0
// Several frames side by side in one picture.
#pragma once

#include "app/scene/group_layout.h"
#include "app/video/frame_writer.h"

namespace mercury {

// A still picture is a sheet of one. Takes rgb frames and lays them out row by row; finish() writes them as one PNG.
// Cells without a frame stay empty.
class ContactSheet final : public FrameWriter {
 public:
  // `frame`: size of each frame; `gap` between them [pixels]. Throws InputError for a name that is not *.png, or a
  // sheet wider or higher than 32768 pixels.
  ContactSheet(const std::string& output, Grid grid, PictureSize frame, int gap);
  void write(const render::Image& frame) override;
  void finish() override;
  std::string description() const override;

 private:
  std::string output_;
  Grid grid_;
  PictureSize frame_;
  int gap_;
  int count_ = 0;
  render::Image sheet_;
};

}  // namespace mercury
