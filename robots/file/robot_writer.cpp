// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "mercury/error.h"
#include "robots/file/inner_members.h"
#include "robots/file/robot_document.h"

namespace mercury {
namespace {

// Copies an origin into the robot's document.
class Copy : public DocumentEvents {
 public:
  explicit Copy(DocumentEvents& to) : to_(to) {}
  void on(const Event& event) override {
    if (event.kind == Kind::number && !std::isfinite(event.number->real)) throw InputError("a number is too large");
    if (depth_ == 0 && event.kind != Kind::begin_object) throw InputError("must be an object");
    depth_ += event.change_of_depth();
    if (depth_ == max_depth) throw InputError("nested deeper than " + std::to_string(max_depth - 1) + " levels");
    to_.on(event);
  }

 private:
  DocumentEvents& to_;
  int depth_ = 0;
};

class RobotWriter {
 public:
  RobotWriter(const Robot& robot, DocumentEvents& events)
      : robot_(robot), inner_(events, robot.other), events_(robot.other.empty() ? events : inner_) {}

  void run() {
    const bool has_materials = !robot_.materials.empty(), has_mass = !robot_.mass.empty(),
               has_velocity = !robot_.velocity.empty(), has_fixed = !robot_.fixed.empty(),
               has_actuators = !robot_.actuators.empty(), has_origin = !robot_.origin.empty(),
               has_sensors = !robot_.sensors.empty(), has_brain = robot_.brain.has_value();
    const std::vector<std::string_view> requirements = requirements_of(robot_);
    const MemberTexts others = members_of_document(robot_.other);
    events_.begin_object(6u + !requirements.empty() + has_materials + has_mass + has_velocity + has_fixed +
                         has_actuators + has_sensors + has_brain + has_origin + others.size());
    field("format", "mercury-robot");
    field("version", 1u);
    if (!requirements.empty())
      write_values("requires", requirements, [&](std::string_view name) { events_.text(name); });
    field("name", robot_.name);
    if (has_materials) write_materials();
    write_list("masses", robot_.masses, [&](const Vec3& x) {
      events_.begin_array(3);
      real(x.x), real(x.y), real(x.z);
    });
    if (has_mass) write_values("mass", robot_.mass, [&](float mass) { real(mass); });
    if (has_velocity)
      write_list("velocity", robot_.velocity, [&](const Vec3& v) {
        events_.begin_array(3);
        real(v.x), real(v.y), real(v.z);
      });
    if (has_fixed) write_values("fixed", robot_.fixed, [&](std::uint16_t point) { natural(point); });
    // Lengths are written for all springs or for none; a mixture would confuse readers of the file.
    bool at_rest = true;
    for (const Spring& spring : robot_.springs)
      at_rest = at_rest && spring.rest_length == rest_distance(robot_, spring.a, spring.b);
    write_list("springs", robot_.springs, [&](const Spring& spring) {
      events_.begin_array(at_rest ? 3 : 4);
      natural(spring.a), natural(spring.b), natural(spring.material);
      if (!at_rest) real(spring.rest_length);
    });
    write_list("faces", robot_.faces, [&](const Face& face) {
      events_.begin_array(3);
      natural(face.a), natural(face.b), natural(face.c);
    });
    if (has_actuators) write_actuators();
    if (has_sensors) events_.key("sensors"), write_sensors(robot_, events_);
    if (has_brain) events_.key("brain"), write_brain(*robot_.brain, events_);
    if (has_origin) write_origin();
    for (const auto& [name, value] : others) {
      events_.key(name);
      read_json(value, events_);
    }
    events_.end_object();
  }

 private:
  void natural(std::uint64_t value) { events_.number(natural_number(value)); }
  void real(float value) { events_.number(real_number(value, room_)); }
  void field(std::string_view key, std::string_view value) { events_.key(key), events_.text(value); }
  void field(std::string_view key, unsigned value) { events_.key(key), natural(value); }
  void field(std::string_view key, float value) { events_.key(key), real(value); }

  template <class List, class Begin>
  void write_list(std::string_view key, const List& list, Begin begin) {
    events_.key(key);
    events_.begin_array(list.size());
    for (const auto& row : list) {
      begin(row);
      events_.end_array();
    }
    events_.end_array();
  }

  template <class List, class Write>
  void write_values(std::string_view key, const List& list, Write write) {
    events_.key(key);
    events_.begin_array(list.size());
    for (const auto& value : list) write(value);
    events_.end_array();
  }

  void write_materials() {
    events_.key("materials");
    events_.begin_array(robot_.materials.size());
    const bool has_names = !robot_.material_names.empty();
    for (std::size_t i = 0; i < robot_.materials.size(); ++i) {
      const Material& material = robot_.materials[i];
      const bool has_relaxation_time = material.relaxation_time != 0;
      events_.begin_object(4u + has_names + has_relaxation_time + material.half_wave);
      if (has_names) field("name", robot_.material_names[i]);
      field("stiffness", material.stiffness);
      field("amplitude", material.amplitude);
      field("frequency", material.frequency);
      field("phase", material.phase);
      if (has_relaxation_time) field("relaxation_time", material.relaxation_time);
      if (material.half_wave) events_.key("half_wave"), events_.boolean(true);
      events_.end_object();
    }
    events_.end_array();
  }

  void write_actuators() {
    events_.key("actuators");
    events_.begin_array(robot_.actuators.size());
    for (const Actuator& actuator : robot_.actuators) {
      events_.begin_object(2);
      field("name", actuator.name);
      write_values("materials", actuator.materials, [&](MaterialId id) { natural(id); });
      events_.end_object();
    }
    events_.end_array();
  }

  void write_origin() {
    events_.key("origin");
    try {
      Copy copy(events_);
      read_json(robot_.origin, copy);
    } catch (const InputError& error) {
      throw InputError("/origin", error.what());
    }
  }

  const Robot& robot_;
  InnerMembersWriter inner_;
  DocumentEvents& events_;
  std::array<char, 32> room_{};
};

}  // namespace

std::vector<std::string_view> requirements_of(const Robot& robot) {
  const bool relaxes = std::ranges::any_of(robot.materials, [](const Material& m) { return m.relaxation_time != 0; });
  const bool has_gates = robot.brain && std::ranges::any_of(robot.brain->layers, &NeuronLayer::is_gated);
  const std::array<bool, known_requirements.size()> has{!robot.mass.empty(),
                                                        !robot.velocity.empty(),
                                                        !robot.fixed.empty(),
                                                        relaxes,
                                                        false,
                                                        robot.brain.has_value(),
                                                        has_gates};
  std::vector<std::string_view> found;
  for (std::size_t i = 0; i < has.size(); ++i)
    if (has[i]) found.push_back(known_requirements[i]);
  return found;
}

void write_robot(const Robot& robot, DocumentEvents& events) { RobotWriter(robot, events).run(); }

}  // namespace mercury
