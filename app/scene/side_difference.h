// SPDX-License-Identifier: Apache-2.0
// What the second side of a picture simulates differently: the same robots under other settings.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mercury/configuration.h"

namespace mercury {

// Settings by name, in the place of those of the first side: "solver=xpbd", "environment=land,friction=0.3". The others
// are those of the first side, also when they change. The parameters of an environment count where it has them.
class SideDifference {
 public:
  SideDifference() = default;
  // Of a text like those above. Vectors have colons: "flow=0.5:0:0". Throws ParameterError("compare", ...) for what
  // cannot be used.
  explicit SideDifference(const std::string& text);

  // Sets one setting, or leaves it to the first side if the value is empty. Throws as the constructor does.
  void set(const std::string& name, const std::string& value);
  std::string value(const std::string& name) const;  // empty = that of the first side

  // The configuration of the second side. It can be used if that of the first side can.
  Configuration over(const Configuration& first) const;
  std::string text() const;
  bool empty() const { return settings_.empty(); }
  friend bool operator==(const SideDifference&, const SideDifference&) = default;

 private:
  std::vector<std::pair<std::string, std::string>> settings_;
};

// What two configurations differ in, for people: {"force", "XPBD"} or {"ocean, dt 1 ms", "land, dt 0.1 ms"}. Both are
// empty if they do not differ.
std::pair<std::string, std::string> differences(const Configuration& first, const Configuration& second);

}  // namespace mercury
