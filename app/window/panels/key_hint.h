// SPDX-License-Identifier: Apache-2.0
// Tooltips that name the present keys of a command (toolkit/key_map.h).
#pragma once

#include <string>

#include "app/window/toolkit/key_map.h"

namespace mercury::window {

// "reset to the start (key R)"; without keys, the text alone.
std::string with_keys(const KeyMap& keys, const std::string& text, Action action);

}  // namespace mercury::window
