// SPDX-License-Identifier: Apache-2.0
// A robot that explodes, with everything needed to reproduce it: *.repro.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/clock.h"
#include "mercury/simulation.h"

namespace mercury {

// A change by the user after `step` steps, before the next one.
struct ReproChange {
  std::int64_t step = 0;
  std::optional<Configuration> configuration;
  std::optional<std::vector<Material>> materials;          // the whole table
  std::optional<std::vector<Perturbation>> perturbations;  // all of them, from then on
};

struct Repro {
  Robot robot;                              // with its materials at the start
  Configuration configuration;              // at the start
  Clock clock;                              // the start; its dt is the configuration's
  State state;                              // at the start
  std::vector<Perturbation> perturbations;  // at the start
  std::vector<ReproChange> changes;         // in order
  double exploded_at = 0;                   // [s]
  std::uint32_t culprit_spring = no_spring;
  std::int64_t last_step = 0;  // the robot has exploded by then
  std::string device_name;     // where it exploded; the same kind of device repeats it bit for bit
};

// Whether the extension is .repro.
bool is_repro_name(const std::filesystem::path& path);

// A JSON document from which parse_repro() restores every bit.
std::string serialize_repro(const Repro& repro);
// Throws InputError, one line without the path, unless the document is a complete repro.
Repro parse_repro(std::string_view document);
// Throws InputError that begins with the path.
Repro load_repro(const std::filesystem::path& path);

// The simulation of a repro at its start, on that device. Throws like Simulation.
Simulation start_of(const Repro& repro, const Device& device);

// Applies the changes of a repro to its simulation, each at its step.
class ReproChanges {
 public:
  explicit ReproChanges(const Repro& repro) : repro_(repro) {}
  // The step of the next change; the largest number if none is left.
  std::int64_t next_step() const {
    return next_ < repro_.changes.size() ? repro_.changes[next_].step : std::numeric_limits<std::int64_t>::max();
  }
  // Applies the changes due at the current step of the simulation.
  void apply(Simulation& simulation);

 private:
  const Repro& repro_;
  std::size_t next_ = 0;
};

}  // namespace mercury
