// SPDX-License-Identifier: Apache-2.0
// The actuators of a robot's document: {"name": "left", "materials": [1, 5]} or {"name": "tail", "springs": [0, 1]}.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mercury/robot.h"
#include "robots/document.h"

namespace mercury {

// Each actuator has at least one material that no other has, and none has air.
inline constexpr std::size_t max_actuators = max_materials - 1;

// Takes the events within the list "actuators". An event that breaks a rule throws InputError, with its place as a JSON
// pointer. Keys that the format does not know are ignored.
class ActuatorReader : public DocumentEvents {
 public:
  void null() override;
  void boolean(bool value) override;
  void number(const Number& value) override;
  void text(std::string_view value) override;
  void bytes(std::string_view value) override;
  void begin_array(std::size_t announced) override;
  void end_array() override;
  void begin_object(std::size_t announced) override;
  void key(std::string_view key_name) override;
  void end_object() override;

  // Gives the actuators to a robot that has none, once its document has ended: keys stand in any order. Springs get
  // materials of their own (add_actuator()). The rest of the robot is valid. Throws InputError if they do not fit the
  // robot.
  void give_to(Robot& robot) const;

 private:
  enum Field : unsigned { name, materials, springs, unknown };
  static constexpr std::string_view field_names[] = {"name", "materials", "springs"};
  struct Entry {
    std::string name;
    std::vector<MaterialId> materials;
    std::vector<std::uint64_t> springs;
    unsigned seen = 0;  // a bit for each field
    bool has(Field field) const { return (seen >> field & 1) != 0; }
  };

  bool passes_by(int change_of_depth);
  [[noreturn]] void refuse(const std::string& what) const;
  [[noreturn]] void wrong_type(const std::string& given) const;
  void check_springs(const Robot& robot) const;

  std::vector<Entry> entries_;
  Field field_ = unknown;
  int depth_ = 0;  // of arrays and objects open: 1 = an actuator, 2 = a list of it
  std::array<bool, max_materials> taken_{};
};

}  // namespace mercury
