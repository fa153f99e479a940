// SPDX-License-Identifier: Apache-2.0
// A robot that explodes, with all that it takes to see it happen again: *.repro.
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

// What was changed when so many steps had been made, before the next one.
struct ReproChange {
  std::int64_t step = 0;
  std::optional<Configuration> configuration;
  std::optional<std::vector<Material>> materials;          // the whole table
  std::optional<std::vector<Perturbation>> perturbations;  // all there are from then on
};

struct Repro {
  Robot robot;                              // with its materials as at the start
  Configuration configuration;              // at the start
  Clock clock;                              // the start; its dt is the configuration's
  State state;                              // at the start
  std::vector<Perturbation> perturbations;  // at the start
  std::vector<ReproChange> changes;         // in order
  double exploded_at = 0;                   // [s]
  std::uint32_t culprit_spring = no_spring;
  std::int64_t last_step = 0;  // by which it has exploded
  std::string device_name;     // what ran it: on the same kind of device it happens again bit for bit
};

// By the extension.
bool is_repro_name(const std::filesystem::path& path);

// A JSON document that gives the same again, bit for bit.
std::string serialize_repro(const Repro& repro);
// Throws InputError, in one line without the path, for what is not a whole repro.
Repro parse_repro(std::string_view document);
// Throws InputError, the path before the message.
Repro load_repro(const std::filesystem::path& path);

// The simulation of a repro as it stands at its start, on that device. Throws as Simulation.
Simulation start_of(const Repro& repro, const Device& device);

// Makes the changes of a repro in its simulation as their steps come.
class ReproChanges {
 public:
  explicit ReproChanges(const Repro& repro) : repro_(repro) {}
  // The step of the next one; the largest number if none is left.
  std::int64_t next_step() const {
    return next_ < repro_.changes.size() ? repro_.changes[next_].step : std::numeric_limits<std::int64_t>::max();
  }
  // Those of the step at which the simulation stands.
  void make(Simulation& simulation);

 private:
  const Repro& repro_;
  std::size_t next_ = 0;
};

}  // namespace mercury
