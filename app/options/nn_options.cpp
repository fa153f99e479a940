// SPDX-License-Identifier: Apache-2.0
#include "app/options/nn_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/options/option_values.h"

namespace mercury {
namespace {

// "64,64"
std::vector<int> layers_from(const std::string& option, std::string_view text) {
  std::vector<int> layers;
  for (std::size_t start = 0;;) {
    const std::size_t end = text.find(',', start);
    layers.push_back(number_from<int>(option, text.substr(start, end - start)));
    if (end == std::string_view::npos) return layers;
    start = end + 1;
  }
}

}  // namespace

void NnRobotOptions::add_to(CLI::App& command) {
  const auto number = [&](const char* name, auto& value, const std::string& description, const char* form) {
    add_number(command, name, value, description, form)->group("Network robots");
  };
  number("--points", options_.points, fmt::format("Points of the cloud, 64 to 65535 (default {})", options_.points),
         "N");
  add_value(command, "--hidden", options_.hidden,
            fmt::format("Neurons of the hidden layers (default {})", fmt::join(options_.hidden, ",")), "N,N,...",
            layers_from)
      ->group("Network robots");
  number("--alpha", options_.alpha,
         "Radius of the alpha shape; 0 takes the smallest that gives one body holding all points (default 0)", "M");
  number("--mirrored", options_.mirrored,
         fmt::format("Share of the robots that have a left and a right (default {})", options_.mirrored), "0..1");
}

NnOptions NnRobotOptions::chosen() const {
  validate(options_);
  return options_;
}

}  // namespace mercury
