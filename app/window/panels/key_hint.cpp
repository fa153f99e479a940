// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/key_hint.h"

#include <fmt/format.h>

namespace mercury::window {

std::string with_keys(const KeyMap& keys, const std::string& text, Action action) {
  const std::string names = keys.keys_of(action);
  if (names.empty()) return text;
  return fmt::format("{} ({}{})", text, names.size() == 1 ? "key " : "", names);
}

}  // namespace mercury::window
