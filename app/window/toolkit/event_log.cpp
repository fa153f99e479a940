// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/event_log.h"

#include <nlohmann/json.hpp>

#include "mercury/error.h"

namespace mercury::window {

EventLog::EventLog(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "w")) {
  if (!file_) throw InputError("--report", file.string() + " cannot be written");
}

void EventLog::write(const char* event, nlohmann::json details) {
  if (!file_) return;
  details["event"] = event;
  const std::string line = details.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  std::fwrite(line.data(), 1, line.size(), file_.get());
  std::fflush(file_.get());
}

void EventLog::item(const std::string& name) { item(name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax()); }

void EventLog::item(const std::string& name, ImVec2 low, ImVec2 high) {
  if (!file_) return;
  Bounds& bounds = items_[name];
  const bool same =
      bounds.low.x == low.x && bounds.low.y == low.y && bounds.high.x == high.x && bounds.high.y == high.y;
  bounds = {low, high, true};
  if (same) return;
  write("item", {{"name", name},
                 {"x", (low.x + high.x) / 2},
                 {"y", (low.y + high.y) / 2},
                 {"width", high.x - low.x},
                 {"height", high.y - low.y}});
}

void EventLog::end_frame() {
  if (!file_) return;
  for (auto item = items_.begin(); item != items_.end();) {
    if (item->second.shown) {
      item->second.shown = false;
      ++item;
    } else {
      write("gone", {{"name", item->first}});
      item = items_.erase(item);
    }
  }
}

}  // namespace mercury::window
