// SPDX-License-Identifier: Apache-2.0
// The part of a genome that is a brain: what evolution changes in it. Weights alone (robots/brain_genes.h), or neurons
// and connections as well (evolution/genomes/growing_brain.h).
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mercury/genome.h"
#include "mercury/robot.h"
#include "robots/bytes.h"
#include "robots/genes.h"

namespace mercury {

class BrainPart;
using BrainPartPointer = std::shared_ptr<const BrainPart>;

class BrainPart {
 public:
  virtual ~BrainPart() = default;

  virtual BrainPartPointer mutated(double strength, std::uint64_t seed) const = 0;
  // With a part of an alike family; `fitness` compares this one's genome with the other's.
  virtual BrainPartPointer crossed(const BrainPart& other, std::partial_ordering fitness, std::uint64_t seed) const = 0;
  // Puts it into a robot that has the family's brain. If it does not fit, the robot has none afterward.
  virtual void put_into(Robot& robot) const = 0;
  virtual void add_identity(IdentityHash& hash) const = 0;
  virtual void write(ByteWriter& writer) const = 0;

  // As of Genome.
  virtual std::optional<double> distance(const BrainPart& /*of an alike family*/) const { return std::nullopt; }
  virtual std::vector<double> numbers() const { return {}; }
  virtual BrainPartPointer with_numbers(std::span<const double> /*numbers*/) const { return nullptr; }
};

// What the brains of one founder and of its offspring have in common. It outlives its parts.
class BrainFamily {
 public:
  virtual ~BrainFamily() = default;

  virtual BrainPartPointer first() const = 0;  // the founder's
  virtual BrainPartPointer random(std::uint64_t seed) const = 0;
  // Throws InputError or DamagedBytes.
  virtual BrainPartPointer read(ByteReader& reader) const = 0;
};

// Of a founder whose weights alone change; without a brain, it has none.
std::unique_ptr<BrainFamily> make_fixed_brains(const Robot& founder);
// Of a founder whose brain grows. Throws InputError if it cannot.
std::unique_ptr<BrainFamily> make_growing_brains(const Robot& founder, const BrainGrowth& growth);
// Whether the brains of two founders, which both have one, are of alike families if they grow.
bool grow_alike(const Robot& a, const Robot& b);

}  // namespace mercury
