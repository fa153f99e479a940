// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/preferences.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

namespace mercury::window {
namespace {

using nlohmann::json;

// Calls visit(name, value) for each member of the file but the quality, which is a word in it.
void for_each_member(auto& preferences, auto visit) {
  visit("width", preferences.size.width);
  visit("height", preferences.size.height);
  visit("text_scale", preferences.text_scale);
  visit("panels", preferences.panels);
  visit("left_open", preferences.left_open);
  visit("right_open", preferences.right_open);
  visit("left_width", preferences.left_width);
  visit("right_width", preferences.right_width);
  visit("left_panel", preferences.left_panel);
  visit("right_panel", preferences.right_panel);
  visit("folder", preferences.folder);
  visit("open_folder", preferences.open_folder);
  visit("save_folder", preferences.save_folder);
  visit("pause_on_explosion", preferences.pause_on_explosion);
  visit("timeline_megabytes", preferences.timeline_megabytes);
  visit("compared", preferences.compared);
  visit("gestures_used", preferences.gestures_used);
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
  const auto read = [&]<class Value>(const char* name, Value& value) {
    const auto found = document.find(name);
    if (found == document.end()) return;
    try {
      value = found->get<Value>();
    } catch (const json::exception&) {
      // A value of another type: keep the default.
    }
  };
  for_each_member(preferences, read);
  std::string quality;
  read("quality", quality);
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
  json document{{"quality", name_of(preferences.quality)}};
  for_each_member(preferences, [&](const char* name, const auto& value) { document[name] = value; });
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
