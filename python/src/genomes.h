// SPDX-License-Identifier: Apache-2.0
// Genomes as Python has them.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>

#include "mercury/custom.h"
#include "mercury/genome.h"
#include "mercury/run_folder.h"

namespace mercury::python {

namespace nb = nanobind;

struct SharedGenome {
  GenomePointer genome;
};

struct Genomes {
  std::shared_ptr<const GenomeSpace> space;
};

// What `robots`, `parameters` and `genes` mean everywhere.
struct WantedSpace {
  GenomeSpaceRequest request;
  nb::object kind;  // of custom genomes, a Kind of mercurysim/_custom.py; else None
};
// Throws TypeError, InputError.
WantedSpace space_wanted(nb::handle robots, nb::handle parameters, const std::string& genes);
// The Kind of a class of Python; None stays None. Throws TypeError.
nb::object kind_of(nb::handle genome_class);

// Makes the spaces of a run, whose custom genomes are those of this Kind, or of none.
GenomeSpaceMaker space_maker(nb::handle kind);

// A Genome, or a Robot of a space of custom genomes. Throws TypeError, InputError.
GenomePointer genome_from(nb::handle given, const GenomeSpace& space);

void bind_genomes(nb::module_& module);

}  // namespace mercury::python
