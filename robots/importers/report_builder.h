// SPDX-License-Identifier: Apache-2.0
// Parts that all importers share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mercury/import.h"
#include "robots/importers/substances.h"
#include "robots/importers/voxel_body.h"

namespace mercury {

class XmlDocument;

// Robots of all bodies of a grid, the largest first: NAME, NAME-2, NAME-3, ... Rounding and several bodies become
// notes. `relaxation_time` [s] is for bodies that stand.
void add_bodies(const VoxelBody& grid, const std::string& name, const Provenance& provenance,
                const ImportOptions& options, Import& import, SpringRule rule = SpringRule::equal,
                double relaxation_time = 0);

// The values of a list, separated by commas, or else by white space. A value may be empty between two commas.
std::vector<std::string_view> list_values(std::string_view text);

// The environment on the floor with this stiffness scale, as in water it is 1.
inline constexpr double land_stiffness_scale = 200;

// Puts the parts of a VXD into the document of its base, as voxcraft-sim does: each child with an attribute "replace",
// such as "VXA.VXC.Structure", takes the place of that element. Elements of the VXD itself that change nothing are
// listed in `report`. Throws InputError for a path that names no element.
void merge_vxd(const XmlDocument& changes, XmlDocument& base, std::vector<ImportedElement>& report);

}  // namespace mercury
