// SPDX-License-Identifier: Apache-2.0
#include "app/scene/camera_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "mercury/robot_file.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::pair<CameraMode, std::string_view>, 5> modes{{{CameraMode::group, "group"},
                                                                        {CameraMode::follow, "follow"},
                                                                        {CameraMode::turntable, "turntable"},
                                                                        {CameraMode::top, "top"},
                                                                        {CameraMode::still, "still"}}};

std::optional<CameraMode> mode_named(std::string_view name) {
  for (const auto& [mode, known] : modes)
    if (name == known) return mode;
  return std::nullopt;
}

std::string mode_names() {
  std::vector<std::string_view> names;
  for (const auto& [mode, name] : modes) names.push_back(name);
  return fmt::format("{}", fmt::join(names, ", "));
}

// Reads the members of a camera file. Errors name the member.
class Reader {
 public:
  Reader(std::string path, const Json& json) : path_(std::move(path)), json_(json) {}

  const Json* find(const char* key) const {
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  float number(const Json& value, const std::string& key) const {
    if (!value.is_number() || !std::isfinite(value.get<float>())) fail(key, "is not a number");
    return value.get<float>();
  }
  std::optional<float> number(const char* key) const {
    const Json* value = find(key);
    return value ? std::optional(number(*value, key)) : std::nullopt;
  }
  std::optional<float> positive(const char* key) const {
    const auto value = number(key);
    if (value && *value <= 0) fail(key, "must be above 0");
    return value;
  }
  std::optional<std::string> text(const char* key) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (!value->is_string()) fail(key, "is not text");
    return value->get<std::string>();
  }
  std::optional<render::Vector3> vector(const char* key) const {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (!value->is_array() || value->size() != 3) fail(key, "is not a list of three numbers");
    return render::Vector3(number((*value)[0], key), number((*value)[1], key), number((*value)[2], key));
  }
  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    if (path_.empty()) throw ParameterError("camera", fmt::format("/{} {}", key, what));
    throw InputError(path_, fmt::format("/{} {}", key, what));
  }

 private:
  std::string path_;
  const Json& json_;
};

}  // namespace

std::string_view name_of(CameraMode mode) {
  for (const auto& [known, name] : modes)
    if (mode == known) return name;
  return {};
}

namespace {

CameraPlan plan_from(const Reader& read) {
  CameraPlan plan;
  if (const auto name = read.text("mode")) {
    const auto mode = mode_named(*name);
    if (!mode) read.fail("mode", "must be one of " + mode_names());
    plan.mode = *mode;
  }
  plan.robot = read.text("robot").value_or("");
  plan.azimuth = read.number("azimuth");
  plan.elevation = read.number("elevation");
  plan.zoom = read.positive("zoom").value_or(plan.zoom);
  plan.field_of_view = read.positive("field_of_view").value_or(plan.field_of_view);
  plan.period = read.positive("period").value_or(static_cast<float>(plan.period));
  plan.target = read.vector("target");
  plan.distance = read.positive("distance");
  return plan;
}

}  // namespace

bool is_camera_file(const std::string& text) { return extension_of(text) == ".json"; }

CameraPlan camera_named(const std::string& text) {
  if (text.starts_with("{")) {
    const Json json = Json::parse(text, nullptr, false);
    if (!json.is_object()) throw ParameterError("camera", "is not valid JSON");
    return plan_from(Reader("", json));
  }
  if (is_camera_file(text)) return load_camera(text);
  const std::size_t colon = text.find(':');
  const auto mode = mode_named(text.substr(0, colon));
  if (!mode || (colon != std::string::npos && *mode != CameraMode::follow))
    throw ParameterError("camera", fmt::format("\"{}\" is not accepted; give {}, follow:ROBOT or a camera file (.json)",
                                               text, mode_names()));
  CameraPlan plan{.mode = *mode};
  if (colon != std::string::npos) plan.robot = text.substr(colon + 1);
  return plan;
}

CameraPlan load_camera(const std::filesystem::path& path) {
  const Json json = Json::parse(read_whole_file(path), nullptr, false);
  if (!json.is_object() || json.value("format", Json()) != "mercury-camera")
    throw InputError(path.string(), "is not a camera file; its \"format\" must be \"mercury-camera\"");
  const Reader read(path.string(), json);
  if (json.value("version", Json()) != 1) read.fail("version", "must be 1");
  return plan_from(read);
}

namespace {

void add_members(const CameraPlan& plan, Json& json) {
  json["mode"] = name_of(plan.mode);
  if (!plan.robot.empty()) json["robot"] = plan.robot;
  if (plan.azimuth) json["azimuth"] = *plan.azimuth;
  if (plan.elevation) json["elevation"] = *plan.elevation;
  json["zoom"] = plan.zoom;
  json["field_of_view"] = plan.field_of_view;
  json["period"] = plan.period;
  if (plan.target) json["target"] = {plan.target->x, plan.target->y, plan.target->z};
  if (plan.distance) json["distance"] = *plan.distance;
}

}  // namespace

std::string bookmarks_text(const CameraBookmarks& bookmarks) {
  Json list = Json::array();
  bool any = false;
  for (const auto& plan : bookmarks) {
    Json& place = list.emplace_back();
    if (!plan) continue;
    add_members(*plan, place);
    any = true;
  }
  return any ? list.dump() : "";
}

CameraBookmarks bookmarks_from(const std::string& text) {
  const Json list = Json::parse(text, nullptr, false);
  if (!list.is_array() || list.size() > most_bookmarks)
    throw ParameterError("bookmarks", fmt::format("must be a JSON list of at most {} cameras", most_bookmarks));
  CameraBookmarks bookmarks;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].is_null()) continue;
    if (!list[i].is_object()) throw ParameterError("bookmarks", fmt::format("/{} is not a camera", i));
    try {
      bookmarks[i] = plan_from(Reader("", list[i]));
    } catch (const ParameterError& error) {
      throw ParameterError("bookmarks", fmt::format("/{}{}", i, error.problem()));
    }
  }
  return bookmarks;
}

void save_camera(const std::filesystem::path& path, const CameraPlan& plan) {
  Json json{{"format", "mercury-camera"}, {"version", 1}};
  add_members(plan, json);
  write_whole_file(path, json.dump(2) + "\n");
}

}  // namespace mercury
