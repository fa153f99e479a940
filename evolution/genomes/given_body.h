// SPDX-License-Identifier: Apache-2.0
// Genomes of the muscles of given bodies: robots of any kind, whose materials alone change.
#pragma once

#include <memory>

#include "mercury/genome.h"

namespace mercury {

std::unique_ptr<GenomeSpace> make_given_body_space(const GenomeSpaceRequest& request);

}  // namespace mercury
