// SPDX-License-Identifier: Apache-2.0
// A folder of robots as pictures with key figures.
#pragma once

#include <memory>
#include <vector>

#include "app/window/panels/panel_context.h"
#include "app/window/panels/robot_folder_reader.h"
#include "app/window/viewport/thumbnails.h"

namespace mercury::window {

class BrowserPanel {
 public:
  explicit BrowserPanel(render::Context& gl_context) : thumbnails_(gl_context) {}
  void draw(PanelContext& context);
  // Draws thumbnails that are missing, for at most so long [s].
  void work(double seconds, render::Theme theme);
  bool busy() const { return waiting_ < entries_.size(); }

 private:
  void show_folder(const std::filesystem::path& folder);
  void draw_bar(PanelContext& context);
  void draw_card(PanelContext& context, std::size_t index, float width);

  Thumbnails thumbnails_;
  std::unique_ptr<RobotFolderReader> reader_;
  std::vector<RobotFolderEntry> entries_;
  std::size_t waiting_ = 0;  // the first without a picture
  std::string typed_;
  render::Theme theme_ = render::Theme::dark;
};

}  // namespace mercury::window
