// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "mercury/error.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "robots/file/robot_document.h"

namespace mercury {
namespace {

constexpr std::string_view material_keys[] = {
    "name", "stiffness", "amplitude", "frequency", "phase", "relaxation_time", "modulus", "density", "half_wave"};
constexpr unsigned stiffness_key = 1, modulus_key = 6, density_key = 7, half_wave_key = 8, unknown_key = 9;

// Hostile files may have keys of any length; messages show the beginning.
std::string shown(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string start(text.substr(0, longest));
  for (char& c : start)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) >= 0x7f) c = '?';
  return start + (text.size() > longest ? "..." : "");
}

}  // namespace

std::string RobotReader::place() const {
  if (depth_ == 0 || section_ == unknown) return "";
  std::string place("/");
  place += section_names[section_];
  if (section_ >= origin || (depth_ < 3 && !in_values())) return place;
  place.append("/").append(std::to_string(row_));
  if (section_ == materials && field_ < unknown_key) place.append("/").append(material_keys[field_]);
  return place;
}

void RobotReader::refuse(const std::string& what) const {
  const std::string where = place();
  throw where.empty() ? InputError(what) : InputError(where, what);
}

void RobotReader::wrong_type(const Event& event) const {
  const std::string given(name_of(event));
  if (depth_ == 0) refuse("not a Mercury robot: the document must be an object");
  if (depth_ == 1) {
    if (section_ == format || section_ == name) refuse("must be a text, not " + given);
    if (section_ == version) refuse("must be a whole number, not " + given);
    refuse(std::string(section_ == origin || section_ == brain ? "must be an object" : "must be an array") + ", not " +
           given);
  }
  if (in_values())
    refuse(std::string(section_ == mass    ? "must be a number"
                       : section_ == fixed ? "must be a whole number"
                                           : "must be a text") +
           ", not " + given);
  if (depth_ == 2)
    refuse("holds " + given + " at " + std::to_string(row_) + ", not " +
           (section_ == materials ? "an object" : "an array"));
  if (section_ == materials) {
    refuse(std::string(field_ == 0               ? "must be a text"
                       : field_ == half_wave_key ? "must be true or false"
                                                 : "must be a number") +
           ", not " + given);
  }
  if (section_ == springs && column_ == 3)
    refuse("the rest length must be a number, not " + given + "; leave it out for the distance at rest");
  refuse("must hold numbers, not " + given);
}

JsonWriter* RobotReader::text_part() {
  return section_ == origin ? &origin_ : section_ == sensors ? &sensors_ : section_ == brain ? &brain_ : nullptr;
}

// What takes an event within the origin, sensors, a brain, the list of actuators or an unknown member; nullptr for
// others. `inside`: arrays and objects that are open around the event.
DocumentEvents* RobotReader::part(int inside) {
  return section_ == actuators && inside >= 2                       ? static_cast<DocumentEvents*>(&actuators_)
         : section_ == unknown && inside >= 1                       ? static_cast<DocumentEvents*>(&other_)
         : section_ >= origin && section_ != unknown && depth_ >= 2 ? text_part()
                                                                    : nullptr;
}

void RobotReader::on(const Event& event) {
  if (event.kind == Kind::number && depth_ == 3 && section_ >= masses && section_ <= velocity)
    return row_number(*event.number);  // most of a file
  if (event.kind == Kind::key) return read_key(event.text);
  const int change = event.change_of_depth(), inside = depth_ - (change < 0 ? 1 : 0);
  const bool is_ignored = section_ == materials && field_ == unknown_key && inside >= 3;
  if (text_part() && depth_ >= 2) {
    if (event.kind == Kind::bytes) refuse("holds a byte string, which JSON cannot hold");
    if (event.kind == Kind::number && !std::isfinite(event.number->real)) refuse("a number is not finite");
  }
  if (DocumentEvents* const to = part(inside); to || is_ignored) {
    depth_ += change;
    if (to) to->on(event);
  } else if (event.kind == Kind::boolean && depth_ == 3 && section_ == materials && field_ == half_wave_key) {
    entry_.material.half_wave = event.truth;
  } else if (event.kind == Kind::text) {
    read_text(event);
  } else if (event.kind == Kind::number) {
    read_number(event);
  } else if (event.begins()) {
    begin(event);
  } else if (!event.ends()) {
    wrong_type(event);
  } else if (depth_ == 3) {
    end_row();
  } else {
    if (event.kind == Kind::end_array && row_ == 0) refuse_if_empty();
    --depth_;
  }
}

void RobotReader::read_text(const Event& event) {
  const std::string_view value = event.text;
  if (depth_ == 1 && section_ == format) {
    if (value != "mercury-robot")
      refuse(std::string("\"").append(shown(value)).append("\" is not known; give \"mercury-robot\""));
  } else if (depth_ == 1 && section_ == name) {
    robot_.name = value;
    json_text(value);
  } else if (depth_ == 3 && section_ == materials && field_ == 0) {
    entry_.name = value;
    json_text(value);
  } else if (depth_ == 2 && section_ == requirements) {
    require_known(value);
  } else {
    wrong_type(event);
  }
}

float RobotReader::finite(const Number& value) const {
  const auto number = to_float(value);
  if (!number) refuse((value.text.empty() ? "a number" : shown(value.text)) + " is not a finite 32-bit number");
  return *number;
}

void RobotReader::read_number(const Event& event) {
  const Number& value = *event.number;
  if (depth_ == 1 && section_ == version) {
    if (value.kind != Number::Kind::natural || value.natural != 1)
      refuse(std::isfinite(value.real) ? shown(to_text(value)) + " is not known; this program reads version 1"
                                       : "is not known; this program reads version 1");
  } else if (depth_ == 3 && section_ == materials && field_ > 0 && field_ < half_wave_key) {
    float* const fields[] = {&entry_.material.stiffness,
                             &entry_.material.amplitude,
                             &entry_.material.frequency,
                             &entry_.material.phase,
                             &entry_.material.relaxation_time,
                             &entry_.modulus,
                             &entry_.density};
    *fields[field_ - 1] = finite(value);
  } else if (in_values() && section_ != requirements) {
    value_number(value);
  } else {
    wrong_type(event);
  }
}

std::uint16_t RobotReader::mass_index(const Number& value) const {
  if (value.kind == Number::Kind::real) refuse("a mass is given by a whole number");
  if (value.kind == Number::Kind::natural && value.natural < max_masses)
    return static_cast<std::uint16_t>(value.natural);  // validate() compares it with the number of masses
  refuse("mass " + to_text(value) + " is out of range, " +
         (has(masses) ? "the robot has " + std::to_string(robot_.masses.size()) : "a robot has at most 65535"));
}

void RobotReader::row_number(const Number& value) {
  const std::size_t column = column_++;
  if (section_ == masses) {
    if (column > 2) refuse("a mass has three coordinates [x, y, z]");
    (column == 0 ? vector_.x : column == 1 ? vector_.y : vector_.z) = finite(value);
  } else if (section_ == velocity) {
    if (column > 2) refuse("a velocity has three components [x, y, z]");
    (column == 0 ? vector_.x : column == 1 ? vector_.y : vector_.z) = finite(value);
  } else if (section_ == faces) {
    if (column > 2) refuse("a face has three masses [a, b, c]");
    (column == 0 ? face_.a : column == 1 ? face_.b : face_.c) = mass_index(value);
  } else if (column < 2) {
    (column == 0 ? spring_.a : spring_.b) = mass_index(value);
  } else if (column == 2) {
    if (value.kind == Number::Kind::real) refuse("a material is given by a whole number");
    if (value.kind == Number::Kind::negative || value.natural >= max_materials)
      refuse("material " + to_text(value) + " is out of range, the table has " +
             std::to_string(materials_of(robot_).size()));
    spring_.material = static_cast<MaterialId>(value.natural);
  } else if (column == 3) {
    spring_.rest_length = finite(value);
  } else {
    refuse("a spring is [a, b, material] or [a, b, material, rest_length]");
  }
}

// Lists with one element per mass.
void RobotReader::require_room() const {
  if (row_ == max_masses)
    refuse("more than 65535 " + std::string(section_ == masses ? "masses" : "elements") +
           ", at most 65535 are accepted");
}

// An element of `mass` or `fixed`.
void RobotReader::value_number(const Number& value) {
  if (row_ == max_masses) --depth_, require_room();
  if (section_ == mass)
    robot_.mass.push_back(finite(value));
  else
    robot_.fixed.push_back(mass_index(value));
  ++row_;
}

void RobotReader::require_known(std::string_view requirement) {
  if (std::ranges::find(known_requirements, requirement) == known_requirements.end()) {
    std::string known;
    for (const std::string_view each : known_requirements) known.append(known.empty() ? "" : ", ").append(each);
    refuse("requires \"" + shown(requirement) + "\", which this version does not know; it knows " + known);
  }
  ++row_;
}

void RobotReader::begin_list(std::size_t announced) {
  row_ = 0;
  const bool per_mass = section_ == masses || section_ == velocity || section_ == mass || section_ == fixed;
  const std::size_t limit = per_mass                ? max_masses
                            : section_ == materials ? std::size_t{max_materials}
                            : section_ == actuators ? max_actuators
                                                    : unknown_length;
  if (announced != unknown_length && announced > limit) {
    const std::string what(per_mass && section_ != masses ? "elements" : section_names[section_]);
    refuse(std::to_string(announced) + " " + what + ", at most " + std::to_string(limit) + " are accepted");
  }
  ++depth_;
}

void RobotReader::begin_row(const Event& event) {
  if ((event.kind == Kind::begin_array) == (section_ == materials)) wrong_type(event);
  if (section_ == masses || section_ == velocity) require_room();
  if (section_ == materials && row_ == max_materials) refuse("more than 256 materials, at most 256 are accepted");
  column_ = 0;
  spring_.rest_length = std::numeric_limits<float>::quiet_NaN();
  entry_ = {};
  field_ = unknown_key;
  ++depth_;
}

void RobotReader::begin(const Event& event) {
  const bool is_array = event.kind == Kind::begin_array;
  const bool is_part = depth_ == 1 && (is_array ? section_ == sensors : section_ == origin || section_ == brain);
  if (depth_ == 0 && !is_array) {
    depth_ = 1;
  } else if (is_part) {
    ++depth_;
    text_part()->on(event);
  } else if (is_array && depth_ == 1 && section_ >= materials && section_ <= actuators) {
    begin_list(event.announced);
  } else if (depth_ == 2 && !in_values()) {
    begin_row(event);
  } else {
    wrong_type(event);
  }
}

void RobotReader::read_key(std::string_view key_name) {
  if (depth_ == 1) {
    const auto* const found = std::find(std::begin(section_names), std::end(section_names), key_name);
    section_ = static_cast<Section>(found - std::begin(section_names));
    if (section_ == unknown) return other_.begin_member(key_name);
    if (has(section_)) refuse("appears twice");
    seen_ |= 1u << section_;
  } else if (DocumentEvents* const to = part(depth_)) {
    to->key(key_name);
  } else if (section_ == materials && depth_ == 3) {
    material_key(key_name);
  }
}

void RobotReader::material_key(std::string_view key_name) {
  const auto* const found = std::find(std::begin(material_keys), std::end(material_keys), key_name);
  field_ = static_cast<unsigned>(found - std::begin(material_keys));
  if (field_ == unknown_key) return;
  if ((entry_.seen >> field_ & 1) != 0) refuse("appears twice");
  entry_.seen |= 1u << field_;
}

void RobotReader::end_material() {
  field_ = unknown_key;
  const auto has_key = [&](unsigned key) { return (entry_.seen >> key & 1) != 0; };
  if (!has_key(stiffness_key) && !has_key(modulus_key)) refuse("stiffness or modulus is missing");
  if (has_key(modulus_key) != has_key(density_key)) refuse("modulus and density come together; give both or neither");
  if (has_key(modulus_key)) {
    if (has_key(stiffness_key)) refuse("a stiffness follows from the modulus; give one of them");
    if (!(entry_.modulus > 0 && entry_.density > 0)) refuse("modulus and density must be above 0");
  }
  substances_.push_back({entry_.modulus, entry_.density});
  robot_.materials.push_back(entry_.material);
  robot_.material_names.push_back(std::move(entry_.name));
  materials_have_names_ = materials_have_names_ || (entry_.seen & 1) != 0;
}

void RobotReader::end_row() {
  if (section_ == masses) {
    if (column_ != 3) refuse("a mass has three coordinates [x, y, z]");
    robot_.masses.push_back(vector_);
  } else if (section_ == velocity) {
    if (column_ != 3) refuse("a velocity has three components [x, y, z]");
    robot_.velocity.push_back(vector_);
  } else if (section_ == springs) {
    if (column_ < 3) refuse("a spring is [a, b, material] or [a, b, material, rest_length]");
    robot_.springs.push_back(spring_);
  } else if (section_ == faces) {
    if (column_ != 3) refuse("a face has three masses [a, b, c]");
    robot_.faces.push_back(face_);
  } else {
    end_material();
  }
  --depth_;
  ++row_;
}

// Called after a list without elements. Where a missing list has a meaning of its own, an empty one is a mistake.
void RobotReader::refuse_if_empty() {
  if (section_ < materials || section_ > actuators) return;
  --depth_;  // the place is the list
  if (section_ == materials) refuse("an empty table; leave it out for the 254 defaults");
  if (section_ == mass) refuse("an empty list; leave it out for 1 kg per mass");
  if (section_ == velocity) refuse("an empty list; leave it out for a robot at rest");
  ++depth_;
}

// A table that says of what its materials are made: springs and masses follow.
void RobotReader::make_real() {
  const auto is_real = [](const Substance& substance) { return substance.modulus > 0; };
  auto usual = std::ranges::find_if(substances_, is_real);
  if (usual == substances_.end()) return;
  if (has(mass)) throw InputError("/mass", "follows from the density of the materials; leave it out");
  actuators_.refuse_springs("springs follow from the moduli of materials; name materials");
  // As stiff beside each other as their moduli are, muscles with the paper's 50 N/m.
  for (auto other = usual; other != substances_.end(); ++other)
    if (is_real(*other) && robot_.materials[static_cast<std::size_t>(other - substances_.begin())].amplitude != 0) {
      usual = other;
      break;
    }
  RealMaterial real{usual->modulus,
                    usual->density,
                    robot_.materials[static_cast<std::size_t>(usual - substances_.begin())].relaxation_time,
                    {}};
  for (std::size_t id = 0; id < substances_.size(); ++id) {
    Material& material = robot_.materials[id];
    if (!is_real(substances_[id]) && material.stiffness != 0)
      throw InputError("/materials/" + std::to_string(id),
                       "has a stiffness beside materials with a modulus; give it one, and a density");
    if (is_real(substances_[id])) material.stiffness = 50 * substances_[id].modulus / usual->modulus;
    real.each.push_back({substances_[id].modulus, substances_[id].density, material.relaxation_time});
    material.relaxation_time = 0;
  }
  robot_ = with_real_body(robot_, real);
  validate(robot_);
}

Robot RobotReader::take() {
  if (!has(format)) throw InputError("not a Mercury robot: \"format\": \"mercury-robot\" is missing");
  for (const Section section : {version, masses, springs, faces})
    if (!has(section)) throw InputError(std::string("/").append(section_names[section]), "is missing");
  if (!materials_have_names_) robot_.material_names.clear();
  for (Spring& spring : robot_.springs)
    if (std::isnan(spring.rest_length) && spring.a < robot_.masses.size() && spring.b < robot_.masses.size())
      spring.rest_length = rest_distance(robot_, spring.a, spring.b);
  validate(robot_);
  actuators_.give_to(robot_);
  make_real();
  if (has(sensors)) set_sensors(robot_, sensors_text_);
  if (has(brain)) set_brain(robot_, brain_text_);
  validate_brain(robot_);
  robot_.other = other_.take();
  return std::move(robot_);
}

}  // namespace mercury
