// SPDX-License-Identifier: Apache-2.0
// The log of what happens in the window, for programs that watch it: `mercury view --report FILE`.
//
// One JSON object per line, each with the name of its event under "event":
//   ready    the first frame is on the screen: seconds since the start
//   frame    a frame was shown: number, step, time [s] and more; at most 5 per second
//   item     a button, tab or the view has a (new) position: name, x, y (its middle), width, height in pixels
//   gone     an item is no longer shown
//   ...      and what panels write: "saved", "robots", "panel", "message" (docs/window.md lists them)
#pragma once

#include <imgui.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace mercury::window {

class EventLog {
 public:
  EventLog() = default;  // writes nothing
  // Throws InputError if the file cannot be written.
  explicit EventLog(const std::filesystem::path& file);

  explicit operator bool() const { return file_ != nullptr; }
  // Writes one line. `details` must be a JSON object.
  void write(const char* event, nlohmann::json details);

  // Gives the ImGui item that was just drawn a name, and logs its position when that is new.
  void item(const std::string& name);
  void item(const std::string& name, ImVec2 low, ImVec2 high);
  // Call at the end of each frame. Logs the items that are no longer shown as "gone".
  void end_frame();

 private:
  struct Bounds {
    ImVec2 low, high;
    bool shown = false;
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::map<std::string, Bounds> items_;
};

}  // namespace mercury::window
