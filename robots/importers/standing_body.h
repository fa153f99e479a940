// SPDX-License-Identifier: Apache-2.0
// Bodies of imported robots on land, with springs of their own for each voxel: they bend as well as stretch like the
// beams of VoxCAD, and stand on the middles of voxels, as there.
//
//      o---e---o        Corners have springs along edges (e) and across sides. The middle M of a voxel has springs to
//      | b   b |        its corners (b) and to the middles beside it (c), which run along the axis of a limb: they
//      |   M   |        stretch with it and do not resist its bending. Half of a voxel's mass is in its middle.
//      | b | b |
//      o---c---o        A voxel with none below stands on its middle: there the floor lifts and rubs a voxel in its
//        b | b          middle, without a moment. Lower corners that only such voxels have are left out, and what is
//          M            left of the voxel changes its length by 4/3 of its amplitude, as much as half a voxel more.
//     ----------- floor
//
// Springs that resist bending have half of the relaxation time, as the moments of beams have, those of the axis have
// 3/2 of it. There, damping resists what differs from the muscle's own movement; here, it resists all. A muscle that
// leads by tau dL/dt gives the same force. docs/formats.md derives the numbers.
#pragma once

#include "robots/importers/voxel_body.h"

namespace mercury {

// As voxel_body_robot(), without an origin. Materials have relaxation times, up to 3/2 of `relaxation_time` [s].
Robot standing_body(const VoxelBody& body, const std::string& name, double relaxation_time, std::size_t most_materials,
                    Rounding& rounding);

}  // namespace mercury
