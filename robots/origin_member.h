// SPDX-License-Identifier: Apache-2.0
// Members of a robot's origin, a JSON object, without touching the others: the weights of a network are many, and keep
// every digit this way.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "mercury/robot.h"

namespace mercury {

// A member of the outermost object; none if there is none. Throws InputError("/origin", ...) if the origin is not an
// object.
std::optional<nlohmann::json> origin_member(const Robot& robot, const char* key);

// The origin with this member, given as JSON text, in place of its own; without it if the text is empty. An empty
// origin becomes an object with this member alone. Throws InputError("/origin", ...) if the origin is not an object.
std::string with_origin_member(const std::string& origin, std::string_view key, const std::string& text);

}  // namespace mercury
