// SPDX-License-Identifier: Apache-2.0
// What the genomes of each kind of robot consist of, and how they change. body_genome.h makes genomes of them.
//
// Each of these structs has
//   tag                     the first byte of its encoding
//   of(robot)               the genes of a robot, from its origin; throws InputError if it has none
//   mutated, crossed        children; `genes` says what may change
//   grown                   the robot
//   write, read             the encoding without its head; read() throws InputError
//   add_identity            what makes the robot what it is
#pragma once

#include <cstdint>
#include <string>

#include "evolution/bytes.h"
#include "evolution/genomes/identity_hash.h"
#include "evolution/genomes/material_genes.h"
#include "mercury/cppn.h"
#include "mercury/genome.h"
#include "mercury/nn_robot.h"
#include "mercury/shell.h"
#include "mercury/voxel.h"

namespace mercury {

struct VoxelGenes {
  static constexpr std::uint8_t tag = 1;
  VoxelGrid grid;
  MaterialGenes materials;

  static VoxelGenes of(const Robot& robot);
  VoxelGenes mutated(Genes genes, double strength, std::uint64_t seed) const;
  VoxelGenes crossed(const VoxelGenes& other, Genes genes, std::uint64_t seed) const;
  Robot grown(const std::string& name, const std::string& environment) const;
  void write(ByteWriter& writer) const;
  static VoxelGenes read(ByteReader& reader);
  void add_identity(IdentityHash& hash) const;
};

// A robot's phases are part of its body. Its muscles have one amplitude, and frequencies that follow from one.
struct CppnGenes {
  static constexpr std::uint8_t tag = 2;
  CppnGenome genome;

  static CppnGenes of(const Robot& robot);
  CppnGenes mutated(Genes genes, double strength, std::uint64_t seed) const;
  CppnGenes crossed(const CppnGenes& other, Genes genes, std::uint64_t seed) const;
  Robot grown(const std::string& name, const std::string& environment) const;
  void write(ByteWriter& writer) const;
  static CppnGenes read(ByteReader& reader);
  void add_identity(IdentityHash& hash) const;
};

struct NnGenes {
  static constexpr std::uint8_t tag = 3;
  NnGenome genome;
  MaterialGenes materials;

  static NnGenes of(const Robot& robot);
  NnGenes mutated(Genes genes, double strength, std::uint64_t seed) const;
  NnGenes crossed(const NnGenes& other, Genes genes, std::uint64_t seed) const;
  Robot grown(const std::string& name, const std::string& environment) const;
  void write(ByteWriter& writer) const;
  static NnGenes read(ByteReader& reader);
  void add_identity(IdentityHash& hash) const;
};

// The muscle laws are amplitudes and frequency; the waves of the muscles are part of the body.
struct ShellGenes {
  static constexpr std::uint8_t tag = 4;
  ShellGenome genome;

  static ShellGenes of(const Robot& robot);
  ShellGenes mutated(Genes genes, double strength, std::uint64_t seed) const;
  ShellGenes crossed(const ShellGenes& other, Genes genes, std::uint64_t seed) const;
  Robot grown(const std::string& name, const std::string& environment) const;
  void write(ByteWriter& writer) const;
  static ShellGenes read(ByteReader& reader);
  void add_identity(IdentityHash& hash) const;
};

// Which of the genes a mutation changes. With Genes::both it is the body, the muscle laws, or both, a third each.
struct Changes {
  bool body = false, muscles = false;
};
Changes changes_of(Genes genes, std::uint64_t seed);

}  // namespace mercury
