// SPDX-License-Identifier: Apache-2.0
// A folder of robots as pictures with key figures.
#pragma once

#include <memory>
#include <vector>

#include "app/window/dialogs/folder_reader.h"
#include "app/window/picture/desk.h"
#include "app/window/picture/thumbnails.h"

namespace mercury::window {

class BrowserPanel {
 public:
  explicit BrowserPanel(render::Context& context) : thumbnails_(context) {}
  void draw(Desk& desk);
  // Draws thumbnails that are missing, for at most so long [s].
  void work(double seconds, render::Theme theme);
  bool busy() const { return waiting_ < entries_.size(); }

 private:
  void show_folder(const std::filesystem::path& folder);
  void draw_bar(Desk& desk);
  void draw_card(Desk& desk, std::size_t index, float width);

  Thumbnails thumbnails_;
  std::unique_ptr<FolderReader> reader_;
  std::vector<FolderEntry> entries_;
  std::size_t waiting_ = 0;  // the first without a picture
  std::string typed_;
  render::Theme theme_ = render::Theme::dark;
};

}  // namespace mercury::window
