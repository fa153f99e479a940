// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/preferences.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace mercury::window {
namespace {

using nlohmann::json;

template <class Value>
void read(const json& document, const char* name, Value& value) {
  const auto found = document.find(name);
  if (found == document.end()) return;
  try {
    value = found->get<Value>();
  } catch (const json::exception&) {
    // A value of another type: keep the default.
  }
}

}  // namespace

std::filesystem::path settings_folder() {
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder && *folder)
    return std::filesystem::path(folder) / "mercury";
  if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".config" / "mercury";
  return {};
}

void load(Preferences& preferences, const std::filesystem::path& file) {
  std::ifstream stream(file);
  const json document = json::parse(stream, nullptr, false);
  if (!document.is_object()) return;
  read(document, "width", preferences.size.width);
  read(document, "height", preferences.size.height);
  read(document, "text_scale", preferences.text_scale);
  read(document, "panels", preferences.panels);
  read(document, "left_open", preferences.left_open);
  read(document, "right_open", preferences.right_open);
  read(document, "left_width", preferences.left_width);
  read(document, "right_width", preferences.right_width);
  read(document, "left_panel", preferences.left_panel);
  read(document, "right_panel", preferences.right_panel);
  read(document, "folder", preferences.folder);
  read(document, "open_folder", preferences.open_folder);
  read(document, "save_folder", preferences.save_folder);
  read(document, "pause_on_explosion", preferences.pause_on_explosion);
  read(document, "timeline_megabytes", preferences.timeline_megabytes);
  read(document, "compared", preferences.compared);
  read(document, "gestures_used", preferences.gestures_used);
  std::string quality;
  read(document, "quality", quality);
  try {
    if (!quality.empty()) preferences.quality = render::quality_named(quality);
  } catch (const std::invalid_argument&) {
    // A quality that no longer exists: keep the default.
  }
  preferences.size.width = std::clamp(preferences.size.width, 640, 16384);
  preferences.size.height = std::clamp(preferences.size.height, 400, 16384);
  preferences.timeline_megabytes =
      std::clamp(preferences.timeline_megabytes, Preferences::least_timeline, Preferences::most_timeline);
  preferences.text_scale = std::clamp(preferences.text_scale, 0.6f, 3.0f);
  for (float* width : {&preferences.left_width, &preferences.right_width})
    *width = *width > 0 ? std::clamp(*width, 14.0f, 60.0f) : 0;
}

void save(const Preferences& preferences, const std::filesystem::path& file) {
  const json document{{"width", preferences.size.width},
                      {"height", preferences.size.height},
                      {"text_scale", preferences.text_scale},
                      {"panels", preferences.panels},
                      {"left_open", preferences.left_open},
                      {"right_open", preferences.right_open},
                      {"left_width", preferences.left_width},
                      {"right_width", preferences.right_width},
                      {"left_panel", preferences.left_panel},
                      {"right_panel", preferences.right_panel},
                      {"quality", name_of(preferences.quality)},
                      {"folder", preferences.folder},
                      {"open_folder", preferences.open_folder},
                      {"save_folder", preferences.save_folder},
                      {"pause_on_explosion", preferences.pause_on_explosion},
                      {"timeline_megabytes", preferences.timeline_megabytes},
                      {"compared", preferences.compared},
                      {"gestures_used", preferences.gestures_used}};
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  const std::filesystem::path temporary = file.string() + ".new";
  {
    std::ofstream stream(temporary);
    stream << document.dump(1) << '\n';
    if (!stream.flush()) return;
  }
  std::filesystem::rename(temporary, file, ignored);
}

}  // namespace mercury::window
