// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "robots/importers/report_builder.h"
#include "robots/importers/xml_document.h"

namespace mercury {
namespace {

// The element that "VXA.VXC.Structure" names, made if it is missing.
pugi::xml_node element_at(pugi::xml_document& document, const std::string& path, const pugi::xml_node& given) {
  pugi::xml_node node = document;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    const std::string word = path.substr(begin, end - begin);
    if (word.empty()) refuse(given, fmt::format("replace=\"{}\" is not a path such as VXA.VXC.Structure", path));
    pugi::xml_node child = node.child(word.c_str());
    if (begin == 0 && !child)
      refuse(given, fmt::format("replace=\"{}\" names no part of the base, whose outermost element is {}", path,
                                document.document_element().name()));
    node = child ? child : node.append_child(word.c_str());
    begin = end + 1;
  }
  if (node == document.document_element()) refuse(given, "replaces the whole base; give a VXA instead");
  return node;
}

void replace(pugi::xml_node target, const pugi::xml_node& source) {
  while (target.first_child()) target.remove_child(target.first_child());
  while (target.first_attribute()) target.remove_attribute(target.first_attribute());
  for (const pugi::xml_attribute& attribute : source.attributes()) target.append_copy(attribute);
  for (const pugi::xml_node& child : source.children()) target.append_copy(child);
}

}  // namespace

void merge_vxd(const XmlDocument& changes, XmlDocument& base, std::vector<ImportedElement>& report) {
  const pugi::xml_node root = changes.root();
  if (std::string_view(root.name()) != "VXD") refuse(root, "a file of another kind; its outermost element must be VXD");
  for (const pugi::xml_node& part : root.children()) {
    if (part.type() != pugi::node_element) continue;
    const std::string path = part.attribute("replace").value();
    if (path.empty()) {
      report.push_back(
          {place_of(part), "", ImportOutcome::ignored, "has no attribute \"replace\", so it changes nothing"});
      continue;
    }
    const pugi::xml_node target = element_at(base.tree(), path, part);
    replace(target, part);
    base.mark(target.attribute("replace"), ImportOutcome::mapped, "replaces this part of the base");
  }
}

}  // namespace mercury
