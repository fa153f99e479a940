// SPDX-License-Identifier: Apache-2.0
#include "robots/file/robot_document.h"

#include <algorithm>
#include <utility>

#include "mercury/error.h"

namespace mercury {
namespace {

std::string place_of(std::size_t actuator) { return "/actuators/" + std::to_string(actuator); }

}  // namespace

void ActuatorReader::refuse(const std::string& what) const {
  if (depth_ == 0) throw InputError("/actuators", what);
  const std::string place = place_of(entries_.size() - 1);
  if (field_ == unknown) throw InputError(place, what);
  throw InputError(std::string(place).append("/").append(field_names[field_]), what);
}

void ActuatorReader::wrong_type(const Event& event) const {
  const std::string given(name_of(event));
  if (depth_ == 0) refuse("holds " + given + " at " + std::to_string(entries_.size()) + ", not an object");
  if (depth_ == 2) refuse("must hold whole numbers, not " + given);
  refuse(std::string(field_ == name ? "must be a text" : "must be an array") + ", not " + given);
}

void ActuatorReader::on(const Event& event) {
  if (event.kind == Kind::key) return read_key(event.text);
  const int change = event.change_of_depth(), inside = depth_ - (change < 0 ? 1 : 0);
  if (field_ == unknown && inside >= 1) {  // under a key that the format does not know
    depth_ += change;
  } else if (event.kind == Kind::text && depth_ == 1 && field_ == name) {
    read_name(event.text);
  } else if (event.kind == Kind::number && depth_ == 2) {
    read_index(*event.number);
  } else if (event.kind == Kind::begin_array && depth_ == 1 && field_ != name) {
    ++depth_;
  } else if (event.kind == Kind::begin_object && depth_ == 0) {
    if (entries_.size() == max_actuators) refuse("more than 255 actuators, at most 255 are accepted");
    entries_.emplace_back();
    field_ = unknown;
    ++depth_;
  } else if (event.kind == Kind::end_array) {
    --depth_;
  } else if (event.kind == Kind::end_object) {
    end_entry();
  } else {
    wrong_type(event);
  }
}

void ActuatorReader::read_name(std::string_view value) {
  json_text(value);
  if (value.empty() || value.find('\0') != value.npos) refuse("an actuator needs a name, without NUL characters");
  for (std::size_t i = 0; i + 1 < entries_.size(); ++i)
    if (entries_[i].name == value) refuse("is the name of actuator " + std::to_string(i));
  entries_.back().name = value;
}

void ActuatorReader::read_index(const Number& value) {
  const std::string one = field_ == materials ? "material" : "spring";
  if (value.kind == Number::Kind::real) refuse("a " + one + " is given by a whole number");
  if (value.kind == Number::Kind::negative) refuse(one + " " + to_text(value) + " is out of range");
  if (field_ == springs) {
    entries_.back().springs.push_back(value.natural);  // give_to() compares it with the number of springs
    return;
  }
  if (value.natural == air) refuse("material 0 is air, an actuator needs others");
  if (value.natural >= max_materials) refuse("material " + to_text(value) + " is out of range, a table has up to 256");
  if (std::exchange(taken_[value.natural], true))
    refuse("material " + to_text(value) + " is named twice among the actuators");
  entries_.back().materials.push_back(static_cast<MaterialId>(value.natural));
}

void ActuatorReader::read_key(std::string_view key_name) {
  if (depth_ != 1) return;
  const auto* const found = std::find(std::begin(field_names), std::end(field_names), key_name);
  field_ = static_cast<Field>(found - std::begin(field_names));
  if (field_ == unknown) return;
  if (entries_.back().has(field_)) refuse("appears twice");
  entries_.back().seen |= 1u << field_;
}

void ActuatorReader::end_entry() {
  field_ = unknown;
  const Entry& entry = entries_.back();
  if (!entry.has(name)) refuse("name is missing");
  if (entry.has(materials) == entry.has(springs))
    refuse(entry.has(springs) ? "has both materials and springs; give one of them"
                              : "has neither materials nor springs; give one of them");
  if (entry.materials.empty() && entry.springs.empty()) refuse("an actuator needs at least one material or spring");
  --depth_;
}

// A spring has one actuator at most.
void ActuatorReader::check_springs(const Robot& robot) const {
  constexpr std::uint8_t none = 255;
  std::array<std::uint8_t, max_materials> of_material;
  of_material.fill(none);
  for (std::size_t i = 0; i < entries_.size(); ++i)
    for (const MaterialId id : entries_[i].materials) of_material[id] = static_cast<std::uint8_t>(i);
  std::vector<std::uint8_t> of_spring;
  for (const Spring& spring : robot.springs) of_spring.push_back(of_material[spring.material]);
  for (std::size_t i = 0; i < entries_.size(); ++i)
    for (const std::uint64_t s : entries_[i].springs) {
      const std::string where = place_of(i) + "/springs", spring = "spring " + std::to_string(s);
      if (s >= of_spring.size())
        throw InputError(where, spring + " is out of range, the robot has " + std::to_string(of_spring.size()));
      if (of_spring[s] != none && of_spring[s] != i)
        throw InputError(where, spring + " belongs to actuator " + std::to_string(of_spring[s]));
      of_spring[s] = static_cast<std::uint8_t>(i);
    }
}

void ActuatorReader::refuse_springs(const std::string& why) const {
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (!entries_[i].springs.empty()) throw InputError(place_of(i) + "/springs", why);
}

void ActuatorReader::give_to(Robot& robot) const {
  const std::size_t table = materials_of(robot).size();
  for (std::size_t i = 0; i < entries_.size(); ++i)
    for (const MaterialId id : entries_[i].materials)
      if (id >= table)
        throw InputError(place_of(i) + "/materials",
                         "material " + std::to_string(id) + " is out of range, the table has " + std::to_string(table));
  check_springs(robot);
  // Materials first: their ids are those of the document's table, which springs may change.
  std::vector<std::size_t> position(entries_.size());
  for (const bool by_springs : {false, true})
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const Entry& entry = entries_[i];
      if (entry.springs.empty() == by_springs) continue;
      position[i] = robot.actuators.size();
      if (!by_springs) {
        robot.actuators.push_back({entry.name, entry.materials});
        continue;
      }
      const std::vector<std::uint32_t> chosen(entry.springs.begin(), entry.springs.end());
      try {
        add_actuator(robot, entry.name, chosen);
      } catch (const InputError&) {  // all that it refuses but one is excluded above
        throw InputError(place_of(i) + "/springs",
                         "its springs need materials of their own, and the robot would have more than 255");
      }
    }
  std::vector<Actuator> in_order;
  for (const std::size_t at : position) in_order.push_back(std::move(robot.actuators[at]));
  robot.actuators = std::move(in_order);
}

}  // namespace mercury
