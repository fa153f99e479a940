// SPDX-License-Identifier: Apache-2.0
// The materials of a robot as genes: its base materials (muscle_laws.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evolution/bytes.h"
#include "evolution/genomes/identity_hash.h"
#include "mercury/material.h"
#include "mercury/robot.h"

namespace mercury {

// Base materials from id 1 on: 22 whose pairs follow from them, or a whole table without air. Empty = the defaults.
using MaterialGenes = std::vector<Material>;

MaterialGenes material_genes_of(const Robot& robot);
// The table for Robot::materials; empty for the defaults.
std::vector<Material> table_of(const MaterialGenes& genes);

// As mutate_muscle_laws and cross_muscle_laws. Genes of different numbers of materials are not mixed: the child has
// a's.
MaterialGenes mutated(const MaterialGenes& genes, double strength, std::uint64_t seed, const std::vector<bool>& in_use);
MaterialGenes crossed(const MaterialGenes& a, const MaterialGenes& b, std::uint64_t seed);

void write(ByteWriter& writer, const MaterialGenes& genes);
// Throws InputError for materials that are not valid.
MaterialGenes read_material_genes(ByteReader& reader);

// Adds the materials in use; all with an empty list or in a whole table, whose pairs are materials of their own.
void add_identity(IdentityHash& hash, const MaterialGenes& genes, const std::vector<bool>& in_use);

}  // namespace mercury
