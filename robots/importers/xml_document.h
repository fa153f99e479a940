// SPDX-License-Identifier: Apache-2.0
// An XML document whose elements remember what became of them, so that the report of an import can list them all.
#pragma once

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "mercury/import_report.h"

namespace mercury {

class XmlDocument {
 public:
  // Throws InputError ("line 3: not valid XML: ...") for a text that is no XML, that has a document type declaration
  // (entities could make it gigantic), or more elements than a file of this kind has. Memory follows the text.
  // These messages begin with `where`.
  explicit XmlDocument(std::string_view text, const std::string& where = {});

  pugi::xml_node root() const { return document_.document_element(); }
  pugi::xml_document& tree() { return document_; }

  // Says what became of an element, or of one of its attributes. The last word counts. An empty node is passed over.
  void mark(const pugi::xml_node& node, ImportOutcome outcome, std::string reason);
  void mark(const pugi::xml_attribute& attribute, ImportOutcome outcome, std::string reason);
  bool is_marked(const pugi::xml_node& node) const { return marks_.contains(node.internal_object()); }

  // Every element that has text, attributes, or no element inside, and every attribute, in their order. Elements of one
  // name that follow each other and hold nothing but text, such as layers, are one line. What was not marked is
  // "unknown". `foretold` gives the reason for elements that are known to be ignored; empty = unknown.
  std::vector<ImportedElement> elements(std::string_view (*foretold)(std::string_view place)) const;

 private:
  struct Mark {
    ImportOutcome outcome;
    std::string reason;
  };
  class Walk;
  std::string_view reason_of(const void* object) const;  // empty if it is not marked

  pugi::xml_document document_;
  std::unordered_map<const void*, Mark> marks_;
};

// "/VXA/VXC/Palette/Material[3]/Mechanical/CTE"; numbers where elements of one name stand side by side.
std::string place_of(const pugi::xml_node& node);

// All text of an element, without the white space around it.
std::string text_of(const pugi::xml_node& node);

// Values of the child of this name: nothing without such a child. Throw InputError with its place for a text that is
// not such a value.
std::optional<double> number_in(const pugi::xml_node& parent, const char* child);
std::optional<int> whole_number_in(const pugi::xml_node& parent, const char* child);
std::optional<bool> switch_in(const pugi::xml_node& parent, const char* child);

// Throws InputError with the place of the element.
[[noreturn]] void refuse(const pugi::xml_node& node, const std::string& problem);

// The number in a text, which must be finite; "+1e+006" is one.
std::optional<double> number_from(std::string_view text);

std::string_view trimmed(std::string_view text);

}  // namespace mercury
