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
void take(const json& document, const char* name, Value& value) {
  const auto found = document.find(name);
  if (found == document.end()) return;
  try {
    value = found->get<Value>();
  } catch (const json::exception&) {
    // Something else's value: the default stays.
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
  take(document, "width", preferences.size.width);
  take(document, "height", preferences.size.height);
  take(document, "text_scale", preferences.text_scale);
  take(document, "panels", preferences.panels);
  take(document, "left_width", preferences.left_width);
  take(document, "right_width", preferences.right_width);
  take(document, "left_panel", preferences.left_panel);
  take(document, "right_panel", preferences.right_panel);
  take(document, "folder", preferences.folder);
  take(document, "open_folder", preferences.open_folder);
  take(document, "save_folder", preferences.save_folder);
  take(document, "pause_on_explosion", preferences.pause_on_explosion);
  std::string quality;
  take(document, "quality", quality);
  try {
    if (!quality.empty()) preferences.quality = render::quality_named(quality);
  } catch (const std::invalid_argument&) {
    // A level that there is no more.
  }
  preferences.size.width = std::clamp(preferences.size.width, 640, 16384);
  preferences.size.height = std::clamp(preferences.size.height, 400, 16384);
  preferences.text_scale = std::clamp(preferences.text_scale, 0.6f, 3.0f);
  for (float* width : {&preferences.left_width, &preferences.right_width})
    *width = *width > 0 ? std::clamp(*width, 14.0f, 60.0f) : 0;
}

void save(const Preferences& preferences, const std::filesystem::path& file) {
  const json document{{"width", preferences.size.width},
                      {"height", preferences.size.height},
                      {"text_scale", preferences.text_scale},
                      {"panels", preferences.panels},
                      {"left_width", preferences.left_width},
                      {"right_width", preferences.right_width},
                      {"left_panel", preferences.left_panel},
                      {"right_panel", preferences.right_panel},
                      {"quality", name_of(preferences.quality)},
                      {"folder", preferences.folder},
                      {"open_folder", preferences.open_folder},
                      {"save_folder", preferences.save_folder},
                      {"pause_on_explosion", preferences.pause_on_explosion}};
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
