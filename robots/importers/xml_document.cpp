// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/xml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "mercury/error.h"
#include "mercury/number_text.h"

namespace mercury {
namespace {

constexpr std::size_t most_elements = 100'000;
constexpr int deepest = 64;
constexpr std::size_t longest_value = 60;

bool is_element(const pugi::xml_node& node) { return node.type() == pugi::node_element; }

bool has_elements(const pugi::xml_node& node) {
  return std::ranges::any_of(node.children(), [](const pugi::xml_node& child) { return is_element(child); });
}

bool is_text_alone(const pugi::xml_node& node) { return !node.first_attribute() && !has_elements(node); }

// The node after this one in the order of the document, and how much deeper it is.
pugi::xml_node next_node(pugi::xml_node node, const pugi::xml_node& root, int& depth) {
  if (node.first_child()) {
    ++depth;
    return node.first_child();
  }
  while (node && node != root && !node.next_sibling()) {
    node = node.parent();
    --depth;
  }
  return node && node != root ? node.next_sibling() : pugi::xml_node();
}

std::string one_line(std::string_view text) {
  std::string line;
  for (const char letter : text.substr(0, longest_value))
    line += static_cast<unsigned char>(letter) < ' ' ? ' ' : letter;
  // Cuts no letter of several bytes.
  if (text.size() > longest_value) {
    while (!line.empty() && (static_cast<unsigned char>(line.back()) & 0x80) != 0) line.pop_back();
    line += "...";
  }
  return line;
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(space) - begin + 1);
}

std::optional<double> number_from(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto value = parse_number<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

XmlDocument::XmlDocument(std::string_view text, const std::string& where) {
  // Of a VXD, whose parts have no element around them in some files, only the first would be read; parse_fragment keeps
  // the others, so that they can be refused.
  const pugi::xml_parse_result result =
      document_.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_doctype | pugi::parse_fragment);
  if (!result) {
    const std::size_t end = std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, result.offset)), text.size());
    const auto lines = std::ranges::count(text.substr(0, end), '\n');
    throw InputError(fmt::format("{}line {}: not valid XML: {}", where, lines + 1, result.description()));
  }
  std::size_t elements = 0;
  int depth = 0;
  for (pugi::xml_node node = document_; node; node = next_node(node, document_, depth)) {
    if (node.type() == pugi::node_doctype)
      throw InputError(where + "a document type declaration is not accepted; robot files need none");
    elements += is_element(node) ? 1 : 0;
    if (elements > most_elements) throw InputError(fmt::format("{}more than {} elements", where, most_elements));
    if (depth > deepest) throw InputError(fmt::format("{}nested deeper than {} levels", where, deepest));
  }
  if (!root()) throw InputError(where + "holds no XML element");
}

void XmlDocument::mark(const pugi::xml_node& node, ImportOutcome outcome, std::string reason) {
  if (node) marks_.insert_or_assign(node.internal_object(), Mark{outcome, std::move(reason)});
}

void XmlDocument::mark(const pugi::xml_attribute& attribute, ImportOutcome outcome, std::string reason) {
  if (attribute) marks_.insert_or_assign(attribute.internal_object(), Mark{outcome, std::move(reason)});
}

// Lists the elements, with places that are made on the way: looking each up by itself would take quadratic time.
class XmlDocument::Walk {
 public:
  Walk(const XmlDocument& document, std::string_view (*foretold)(std::string_view place))
      : document_(document), foretold_(foretold) {}

  void visit(const pugi::xml_node& parent, const std::string& parent_place) {
    std::map<std::string_view, int> count, seen;
    for (const pugi::xml_node& child : parent.children())
      if (is_element(child)) ++count[child.name()];
    for (pugi::xml_node child = parent.first_child(); child; child = child.next_sibling()) {
      if (!is_element(child)) continue;
      const std::string name = child.name();
      std::string place = parent_place + "/" + name;
      const int number = ++seen[child.name()];
      std::size_t group = 1;
      const pugi::xml_node first = child;
      if (is_text_alone(child))
        while (is_same_text(child, child.next_sibling())) {
          child = child.next_sibling();
          ++group;
          ++seen[child.name()];
        }
      if (group == 1 && count[child.name()] > 1) place += fmt::format("[{}]", number);
      add_attributes(first, place);
      if (group > 1)
        add(first.internal_object(), place, fmt::format("{} times", group));
      else if (!has_elements(first))
        add(first.internal_object(), place, one_line(text_of(first)));
      else if (document_.is_marked(first))
        add(first.internal_object(), place, "");
      visit(first, place);
    }
  }

  std::vector<ImportedElement> take() { return std::move(elements_); }

 private:
  // Whether the next one says the same about itself, so that both make one line.
  bool is_same_text(const pugi::xml_node& node, const pugi::xml_node& next) const {
    return next && is_element(next) && std::string_view(node.name()) == next.name() && is_text_alone(next) &&
           document_.reason_of(node.internal_object()) == document_.reason_of(next.internal_object());
  }
  void add_attributes(const pugi::xml_node& node, const std::string& place) {
    for (const pugi::xml_attribute& attribute : node.attributes())
      add(attribute.internal_object(), place + "/@" + attribute.name(), one_line(attribute.value()));
  }
  void add(const void* object, std::string place, std::string value) {
    const auto mark = document_.marks_.find(object);
    if (mark != document_.marks_.end()) {
      elements_.push_back({std::move(place), std::move(value), mark->second.outcome, mark->second.reason});
      return;
    }
    const std::string_view reason = foretold_(place);
    elements_.push_back(
        {std::move(place), std::move(value), ImportOutcome::ignored, reason.empty() ? "unknown" : std::string(reason)});
  }

  const XmlDocument& document_;
  std::string_view (*foretold_)(std::string_view place);
  std::vector<ImportedElement> elements_;
};

std::string_view XmlDocument::reason_of(const void* object) const {
  const auto mark = marks_.find(object);
  return mark == marks_.end() ? std::string_view() : std::string_view(mark->second.reason);
}

std::vector<ImportedElement> XmlDocument::elements(std::string_view (*foretold)(std::string_view place)) const {
  Walk walk(*this, foretold);
  walk.visit(document_, "");
  return walk.take();
}

std::string place_of(const pugi::xml_node& node) {
  if (!node || node.type() == pugi::node_document) return "";
  const std::string_view name = node.name();
  int number = 1, count = 0;
  for (const pugi::xml_node& sibling : node.parent().children(node.name())) {
    ++count;
    if (sibling == node) number = count;
  }
  std::string place = place_of(node.parent());
  place += "/";
  place += name;
  if (count > 1) place += fmt::format("[{}]", number);
  return place;
}

std::string text_of(const pugi::xml_node& node) {
  std::string text;
  for (const pugi::xml_node& part : node.children())
    if (part.type() == pugi::node_pcdata || part.type() == pugi::node_cdata) text += part.value();
  return std::string(trimmed(text));
}

void refuse(const pugi::xml_node& node, const std::string& problem) { throw InputError(place_of(node), problem); }

std::optional<double> number_in(const pugi::xml_node& parent, const char* child) {
  const pugi::xml_node node = parent.child(child);
  if (!node) return std::nullopt;
  const std::string text = text_of(node);
  const std::optional<double> number = number_from(text);
  if (!number) refuse(node, fmt::format("\"{}\" is not a number", one_line(text)));
  return number;
}

std::optional<int> whole_number_in(const pugi::xml_node& parent, const char* child) {
  const std::optional<double> number = number_in(parent, child);
  if (!number) return std::nullopt;
  if (*number != std::floor(*number) || std::abs(*number) > 1e9)
    refuse(parent.child(child), fmt::format("{} is not accepted; give a whole number", *number));
  return static_cast<int>(*number);
}

std::optional<bool> switch_in(const pugi::xml_node& parent, const char* child) {
  const pugi::xml_node node = parent.child(child);
  if (!node) return std::nullopt;
  const std::string text = text_of(node);
  if (text == "1" || text == "true") return true;
  if (text == "0" || text == "false") return false;
  refuse(node, fmt::format("\"{}\" is not accepted; give 0 or 1", one_line(text)));
}

}  // namespace mercury
