// SPDX-License-Identifier: Apache-2.0
// Arguments of the form NAME=VALUE.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

namespace mercury {

// Sets the values that are given. Ends the program if a name is none of these.
inline void set_named_values(std::map<std::string, std::string>& values, int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const auto found = values.find(argument.substr(0, argument.find('=')));
    if (found == values.end()) {
      std::fprintf(stderr, "%s: %s is not accepted; give NAME=VALUE with one of", argv[0], argument.c_str());
      for (const auto& [name, value] : values) std::fprintf(stderr, " %s", name.c_str());
      std::fprintf(stderr, "\n");
      std::exit(2);
    }
    found->second = argument.substr(argument.find('=') + 1);
  }
}

}  // namespace mercury
