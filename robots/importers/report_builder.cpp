// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/report_builder.h"

#include <fmt/format.h>

#include <utility>

namespace mercury {

std::string_view name_of(ImportOutcome outcome) {
  switch (outcome) {
    case ImportOutcome::mapped:
      return "mapped";
    case ImportOutcome::approximated:
      return "approximated";
    case ImportOutcome::ignored:
      break;
  }
  return "ignored";
}

void add_bodies(const VoxelBody& grid, const std::string& name, const Provenance& provenance,
                const ImportOptions& options, Import& import) {
  const std::vector<VoxelBody> bodies = separate_bodies(grid);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::string own = i == 0 ? name : fmt::format("{}-{}", name, i + 1);
    Rounding rounding;
    import.robots.push_back(
        voxel_body_robot(bodies[i], own, provenance, static_cast<std::size_t>(options.most_materials), rounding));
    import.report.robots.push_back(own);
    if (!rounding.is_exact()) import.report.notes.push_back(fmt::format("{}: {}", own, text_of(rounding)));
  }
  if (bodies.size() > 1)
    import.report.notes.push_back(fmt::format(
        "{} separate bodies became a robot each; robots of Mercury do not touch each other", bodies.size()));
}

}  // namespace mercury
