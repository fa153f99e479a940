// SPDX-License-Identifier: Apache-2.0
// A robot as a document: the one description of the file format (docs/formats.md), for JSON and CBOR alike.
#pragma once

#include <string>
#include <string_view>

#include "mercury/robot.h"
#include "robots/actuator_reader.h"
#include "robots/document.h"

namespace mercury {

// Sends the robot's document. Throws InputError("/origin: ...") if its origin is no JSON object.
void write_robot(const Robot& robot, DocumentEvents& events);

// Builds a robot from the events of its document. Keys that the format does not know are ignored.
// An event that breaks a rule throws InputError, with its place as a JSON pointer.
class RobotReader : public DocumentEvents {
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

  // The robot, once the document has ended. Throws InputError if a part is missing or validate() refuses it.
  Robot take();

 private:
  enum Section : unsigned { format, version, name, materials, masses, springs, faces, actuators, origin, unknown };
  static constexpr std::string_view section_names[] = {"format",  "version", "name",      "materials", "masses",
                                                       "springs", "faces",   "actuators", "origin"};
  struct MaterialEntry {
    Material material;
    std::string name;
    unsigned seen = 0;  // a bit for each key
  };

  bool has(Section section) const { return (seen_ >> section & 1) != 0; }
  std::string place() const;
  [[noreturn]] void refuse(const std::string& what) const;
  [[noreturn]] void wrong_type(const std::string& given) const;
  bool passes_by(int change_of_depth);
  DocumentEvents* part(int change_of_depth);
  void begin_list(std::size_t announced);
  void begin_row(bool is_array);
  float finite(const Number& value) const;
  std::uint16_t mass_index(const Number& value) const;
  void row_number(const Number& value);
  void end_row();
  void material_key(std::string_view key_name);
  void end_material();

  Robot robot_;
  unsigned seen_ = 0;  // a bit for each section
  Section section_ = unknown;
  int depth_ = 0;           // of arrays and objects open: 1 = the document, 2 = a list, 3 = a row of it
  std::size_t row_ = 0;     // which row of the list
  std::size_t column_ = 0;  // how many elements of the row are read
  Vec3 position_;
  Spring spring_;
  Face face_;
  MaterialEntry entry_;
  unsigned field_ = 0;  // the key of a material being read
  bool materials_have_names_ = false;
  ActuatorReader actuators_;
  JsonWriter origin_{robot_.origin};
};

}  // namespace mercury
