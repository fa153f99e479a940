// SPDX-License-Identifier: Apache-2.0
// A robot as a document: the one description of the file format (docs/formats.md), for JSON and CBOR alike.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/robot.h"
#include "robots/file/document.h"
#include "robots/file/other_members.h"

namespace mercury {

// The actuators of a robot's document: {"name": "left", "materials": [1, 5]} or {"name": "tail", "springs": [0, 1]}.

// Each actuator has at least one material that no other has, and none has air.
inline constexpr std::size_t max_actuators = max_materials - 1;

// Takes the events within the list "actuators". An event that breaks a rule throws InputError, with its place as a JSON
// pointer. Keys that the format does not know are ignored.
class ActuatorReader : public DocumentEvents {
 public:
  void on(const Event& event) override;

  // Gives the actuators to a robot that has none, once its document has ended: keys stand in any order. Springs get
  // materials of their own (add_actuator()). The rest of the robot is valid. Throws InputError if they do not fit the
  // robot.
  void give_to(Robot& robot) const;
  // Throws InputError for an actuator that names springs.
  void refuse_springs(const std::string& why) const;

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

  [[noreturn]] void refuse(const std::string& what) const;
  [[noreturn]] void wrong_type(const Event& given) const;
  void read_key(std::string_view key_name);
  void read_name(std::string_view value);
  void read_index(const Number& value);
  void end_entry();
  void check_springs(const Robot& robot) const;

  std::vector<Entry> entries_;
  Field field_ = unknown;
  int depth_ = 0;  // of arrays and objects open: 1 = an actuator, 2 = a list of it
  std::array<bool, max_materials> taken_{};
};

// What a file may say that it requires ("requires"): the parts of a robot that a version without them would leave out,
// and then run another robot. Files name those that they have. Parts that came before there was this list are not in
// it.
inline constexpr std::array<std::string_view, 7> known_requirements{"mass",    "velocity", "fixed", "relaxation_time",
                                                                    "modulus", "brain",    "gates"};
// Those of them that a robot has, in their order.
std::vector<std::string_view> requirements_of(const Robot& robot);

// Sends the robot's document. Throws InputError("/origin: ...") if its origin is no JSON object.
void write_robot(const Robot& robot, DocumentEvents& events);

// Its list of sensors, and its brain (docs/brains.md); mercury/robot_file.h reads them.
void write_sensors(const Robot& robot, DocumentEvents& events);
void write_brain(const Brain& brain, DocumentEvents& events);

// Builds a robot from the events of its document. Members of the document that the format does not know are kept
// (Robot::other), other keys that it does not know are ignored.
// An event that breaks a rule throws InputError, with its place as a JSON pointer.
class RobotReader : public DocumentEvents {
 public:
  void on(const Event& event) override;

  // The robot, once the document has ended. Throws InputError if a part is missing or validate() refuses it.
  Robot take();

 private:
  // Lists of rows from `materials` on, lists of values from `requirements` on.
  enum Section : unsigned {
    format,
    version,
    name,
    materials,
    masses,
    springs,
    faces,
    velocity,
    requirements,
    mass,
    fixed,
    actuators,
    origin,  // it and the rest are taken as texts
    sensors,
    brain,
    unknown
  };
  static constexpr std::string_view section_names[] = {"format",  "version",   "name",     "materials", "masses",
                                                       "springs", "faces",     "velocity", "requires",  "mass",
                                                       "fixed",   "actuators", "origin",   "sensors",   "brain"};
  struct MaterialEntry {
    Material material;
    std::string name;
    float modulus = 0, density = 0;
    unsigned seen = 0;  // a bit for each key
  };

  bool has(Section section) const { return (seen_ >> section & 1) != 0; }
  bool in_values() const { return depth_ == 2 && section_ >= requirements && section_ <= fixed; }
  std::string place() const;
  [[noreturn]] void refuse(const std::string& what) const;
  [[noreturn]] void wrong_type(const Event& given) const;
  JsonWriter* text_part();
  DocumentEvents* part(int inside);
  void read_key(std::string_view key_name);
  void read_text(const Event& event);
  void read_number(const Event& event);
  void begin(const Event& event);
  void begin_list(std::size_t announced);
  void begin_row(const Event& event);
  float finite(const Number& value) const;
  std::uint16_t mass_index(const Number& value) const;
  void row_number(const Number& value);
  void value_number(const Number& value);
  void require_known(std::string_view requirement);
  void require_room() const;
  void end_row();
  void refuse_if_empty();
  void material_key(std::string_view key_name);
  void end_material();
  void make_real();

  Robot robot_;
  unsigned seen_ = 0;  // a bit for each section
  Section section_ = unknown;
  int depth_ = 0;           // of arrays and objects open: 1 = the document, 2 = a list, 3 = a row of it
  std::size_t row_ = 0;     // which row of the list
  std::size_t column_ = 0;  // how many elements of the row are read
  Vec3 vector_;
  Spring spring_;
  Face face_;
  MaterialEntry entry_;
  unsigned field_ = 0;  // the key of a material being read
  bool materials_have_names_ = false;
  struct Substance {
    float modulus, density;  // [Pa], [kg/m3]; 0 = the file says none
  };
  std::vector<Substance> substances_;  // one per material
  ActuatorReader actuators_;
  JsonWriter origin_{robot_.origin};
  std::string sensors_text_, brain_text_;
  JsonWriter sensors_{sensors_text_}, brain_{brain_text_};
  OtherMembers other_;
};

}  // namespace mercury
