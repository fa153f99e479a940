// SPDX-License-Identifier: Apache-2.0
// Tells a watching program what happens in the window: `mercury view --report FILE`.
//
// One JSON object a line, each with "event":
//   ready    the first picture is on the screen: seconds since the start
//   frame    a picture was shown: number, step, time [s], drawn ms; at most 5 a second
//   item     a button, tab or the picture has a (new) place: name, x, y (its middle), width, height in pixels
//   ...      and what panels say: "saved", "robots", "panel", "message"
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
  EventLog() = default;  // tells nothing
  // Throws InputError if the file cannot be written.
  explicit EventLog(const std::filesystem::path& file);

  explicit operator bool() const { return file_ != nullptr; }
  // `details` must be an object; it gets the event's name.
  void write(const char* event, nlohmann::json details);

  // The item that was just put into a panel can be found under that name.
  void item(const std::string& name);
  void item(const std::string& name, ImVec2 low, ImVec2 high);
  // At the end of a frame: items that are not there any more are forgotten, and told as "gone".
  void end_frame();

 private:
  struct Place {
    ImVec2 low, high;
    bool seen = false;
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::map<std::string, Place> places_;
};

}  // namespace mercury::window
