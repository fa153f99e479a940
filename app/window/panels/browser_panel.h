// SPDX-License-Identifier: Apache-2.0
// The robots of a folder, each with a view and its size.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/window/panels/panel.h"
#include "app/window/viewport/thumbnails.h"
#include "mercury/inspect.h"
#include "mercury/robot.h"

namespace mercury::window {

// A robot file, or the reason why it cannot be used.
struct RobotFolderEntry {
  std::filesystem::path path;
  std::shared_ptr<const Robot> robot;  // null if the file cannot be used
  Inspection figures;
  std::string error;
};

class RobotFolderReader {
 public:
  // Starts to read at max_files `max_files` files. The destructor stops early.
  explicit RobotFolderReader(const std::filesystem::path& folder, std::size_t max_files = 500);

  const std::filesystem::path& folder() const { return folder_; }
  // The parent folder, then the folders inside, sorted by name.
  const std::vector<std::filesystem::path>& folders() const { return folders_; }
  // How many files look like robots.
  std::size_t files() const { return files_.size(); }
  // The robots read since the last call.
  std::vector<RobotFolderEntry> take();
  // Why the folder cannot be read; empty = no error.
  const std::string& error() const { return error_; }

 private:
  void list();
  void read(std::stop_token stop);

  std::filesystem::path folder_;
  std::size_t max_files_;
  std::vector<std::filesystem::path> folders_, files_;
  std::string error_;
  std::mutex mutex_;
  std::vector<RobotFolderEntry> read_;
  std::jthread thread_;
};

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
  std::vector<std::size_t> wanted_;  // entries on the screen that lack a view, the next one last
  std::string folder_text_;
};

}  // namespace mercury::window
