// SPDX-License-Identifier: Apache-2.0
// Members that this version does not know, in objects within a robot's document: materials, actuators, sensors, and the
// parts of a brain. They are kept in Robot::other beside those of the document, under the keys and indices of their
// places,
//
//     {"color": "red", "materials": {"3": {"supplier": "A"}}, "brain": {"layers": {"0": {"note": 1}}}}
//
// since a member of the document that is called "materials" is no unknown one.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "robots/file/document.h"
#include "robots/file/other_members.h"

namespace mercury {

// An object of the document that may have unknown members; null = nothing is known of what is there.
struct ObjectPlace;

// Those members of Robot::other that are of the document itself.
MemberTexts members_of_document(std::string_view other);

// Shorter keys first, so that indices stand in their order. The order must not be that of the document: it would be
// another one when the robot has been written.
struct InnerOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  }
};

// Takes unknown inner members out of a document that is read, and sends all else on.
class InnerMembersReader : public DocumentEvents {
 public:
  explicit InnerMembersReader(DocumentEvents& to) : to_(to) {}

  void on(const Event& event) override;

  // Robot::other with them; `other` = that of the document.
  std::string with_inner(const std::string& other, bool with_materials) const;

 private:
  // What is kept of objects within an object or an array, as JSON text, by their keys or indices.
  using Inner = std::map<std::string, std::string, InnerOrder>;
  // An object or an array that is open.
  struct Frame {
    const ObjectPlace* place = nullptr;  // of the object, or of the objects of the array
    bool is_array = false;
    std::size_t index = 0;  // of the element of the array
    std::string key;        // of the member of the object
    std::string members;    // unknown ones, as JSON text
    Inner inner;            // of objects below
  };

  void close();
  void end_taken();

  DocumentEvents& to_;
  std::vector<Frame> frames_;  // within each other; those of places that may have unknown members
  int beyond_ = 0;             // arrays and objects that are open within the last of them
  OtherMembers taken_;
  int taken_depth_ = -1;  // of an unknown member: arrays and objects of it that are open; -1 = there is none
  Inner of_document_;
};

// Puts them back into a document that is written.
class InnerMembersWriter : public DocumentEvents {
 public:
  // `other` = Robot::other.
  InnerMembersWriter(DocumentEvents& to, std::string_view other) : to_(to), other_(other) {}

  void on(const Event& event) override;

 private:
  struct Frame {
    const ObjectPlace* place = nullptr;
    bool is_array = false;
    std::size_t index = 0;
    std::string key;
    MemberTexts members, unknown;  // that belong below, and here
  };

  void open(bool is_array);

  DocumentEvents& to_;
  const std::string_view other_;
  std::vector<Frame> frames_;
};

}  // namespace mercury
