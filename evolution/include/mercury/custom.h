// SPDX-License-Identifier: Apache-2.0
// Custom parts of an evolution: objectives, genomes or an algorithm that a program of the user's own brings. Settings
// and files name them "python:NAME". Everything that reads run folders reads those that have custom parts, since the
// journal holds their scores and robots; only the program can go on with them (docs/python.md).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "mercury/evolution.h"
#include "mercury/genome.h"
#include "mercury/robot.h"

namespace mercury {

inline constexpr std::string_view custom_prefix = "python:";
constexpr bool is_custom(std::string_view name) { return name.starts_with(custom_prefix); }
// Throws ParameterError unless the name of a custom part goes on with 1 to 100 letters, digits and . _ -
void check_custom_name(const std::string& parameter, std::string_view name);

// "the algorithm python:pycma and the objective python:light"; empty if there is no custom part.
std::string custom_parts(const EvolutionSettings& settings, const GenomeSpaceRequest& space);

// A custom genome, as the program writes it, with the robot that it grows.
struct CustomGenes {
  std::string text;     // of the program
  Robot robot;          // without a name
  std::string problem;  // why it has no robot; empty = it has one
};

// What the program does with its genomes, as Genome and GenomeSpace say. Several threads call them at the same time. A
// function that is missing cannot be used: it throws InputError.
struct CustomOperators {
  std::function<CustomGenes(std::uint64_t seed, std::uint64_t index)> random;
  std::function<CustomGenes(const CustomGenes& genes, double strength, std::uint64_t seed)> mutate;
  std::function<CustomGenes(const CustomGenes& genes, const CustomGenes& other, std::uint64_t seed)> cross;
};

class CustomSpace : public GenomeSpace {
 public:
  // `name` = "python:NAME". Throws ParameterError("kind", ...) for another name.
  explicit CustomSpace(std::string name, CustomOperators operators = {});

  GenomePointer random(std::uint64_t seed, std::uint64_t index) const override;
  GenomePointer decode(std::string_view bytes) const override;
  // Throws InputError if its robot breaks a rule.
  GenomePointer genome(CustomGenes genes) const;

  struct Context;

 private:
  std::shared_ptr<const Context> context_;
};

// Of a genome of a CustomSpace; else throws InputError.
const CustomGenes& custom_genes_of(const Genome& genome);

}  // namespace mercury
