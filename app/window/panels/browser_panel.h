// SPDX-License-Identifier: Apache-2.0
// The robots of a folder, each with a picture and its size.
#pragma once

#include <memory>
#include <vector>

#include "app/window/panels/panel.h"
#include "app/window/panels/robot_folder_reader.h"
#include "app/window/viewport/thumbnails.h"

namespace mercury::window {

class BrowserPanel : public Panel {
 public:
  explicit BrowserPanel(PanelContext& context) : thumbnails_(context.window.gl_context()) {}
  void draw(PanelContext& context) override;
  // Draws missing thumbnails of cards on the screen.
  void work(PanelContext& context, double seconds) override;
  bool busy() const override { return !wanted_.empty(); }

 private:
  void show_folder(const std::filesystem::path& folder);
  void draw_bar(PanelContext& context);
  void draw_card(PanelContext& context, std::size_t index, float width);

  Thumbnails thumbnails_;
  std::unique_ptr<RobotFolderReader> reader_;
  std::vector<RobotFolderEntry> entries_;
  std::vector<std::size_t> wanted_;  // entries on the screen that lack a picture, the next one last
  std::string folder_text_;
};

}  // namespace mercury::window
