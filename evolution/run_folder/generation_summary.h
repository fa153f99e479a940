// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mercury/individual.h"
#include "mercury/run_folder.h"

namespace mercury {

// `living` = ids, the best first; `individuals` = everyone, by id.
GenerationSummary summary_of(int number, GenerationTimes times, std::span<const Individual> born,
                             std::span<const std::uint64_t> living, std::span<const Individual> individuals,
                             std::size_t objectives);

}  // namespace mercury
