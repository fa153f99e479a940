// SPDX-License-Identifier: Apache-2.0
// Muscle laws: how the muscles of a robot move (amplitude, frequency and phase of its materials), for searches that
// change them.
//
// A robot with the default table, or with one made by material_table(), has 22 base materials, and the materials of
// their pairs follow from them. Any other table has no such order: each of its materials is a base material then.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mercury/material.h"
#include "mercury/robot.h"

namespace mercury {

// What a search gives a muscle. A muscle that is beyond from the start stays where it is at most.
inline constexpr float max_muscle_amplitude = 0.4f;  // of either sign [1]
inline constexpr float max_muscle_frequency = 20;    // [rad/s]

// Whether the robot's materials are the 22 base materials and their pairs, as material_table() makes them.
bool has_base_materials(const Robot& robot);

// The base materials of a robot, from id 1 on: 22 with has_base_materials(), else its whole table without air. Those
// with an amplitude are its muscles.
std::vector<Material> base_materials_of(const Robot& robot);

// Whether springs of the robot have the base material, alone or in a pair. In the order of base_materials_of().
std::vector<bool> base_materials_in_use(const Robot& robot);

// The robot with these base materials; those of pairs are computed again. A robot whose materials are the defaults
// afterward has no table of its own. Throws InputError unless there are as many as base_materials_of() gives, and for
// a material that is not valid.
Robot with_base_materials(Robot robot, std::span<const Material> bases);

// Base materials with changed muscles; stiffnesses and materials without an amplitude stay. Each amplitude and each
// phase moves with probability 1/4, by a normal number times `strength` times 0.04, or 0.4 rad. Frequencies move with
// probability 1/4, by a normal number times `strength` times 0.5 rad/s; muscles of one frequency move together, so that
// they keep their phases to each other, and each muscle by itself with probability 1/40. Results are folded back into
// the ranges above, phases into [0, 2 pi). With a strength above 0, at least one of the muscles in use changes, if
// there are any; an empty `in_use` counts all. With a `tail` above 0, numbers of Student's t with that many degrees of
// freedom stand in place of the normal ones. Depends on the arguments alone, bit for bit on every machine. Throws
// ParameterError("muscles", ...) unless the strength is finite and at least 0.
std::vector<Material> mutate_muscle_laws(std::span<const Material> bases, double strength, std::uint64_t seed,
                                         const std::vector<bool>& in_use = {}, int tail = 0);

// Base materials of a child: each from either parent with probability 1/2. Throws InputError if their numbers differ.
std::vector<Material> cross_muscle_laws(std::span<const Material> a, std::span<const Material> b, std::uint64_t seed);

// The muscles in use as numbers, for searches among these (mercury/genome.h): one for each frequency that muscles of
// `bases` have, then amplitude and phase of each. Muscles of one frequency keep one. The unit of a number is the step
// of mutate_muscle_laws() with strength 1. `like` has the muscles of `bases`, moved.
std::vector<double> muscle_numbers(std::span<const Material> bases, const std::vector<bool>& in_use,
                                   std::span<const Material> like);
// The reverse, for any finite numbers: they are brought into the ranges above, phases by
// whole turns, the others by reflection.
std::vector<Material> with_muscle_numbers(std::span<const Material> bases, const std::vector<bool>& in_use,
                                          std::span<const double> numbers);

// The same for robots. Only materials change: a child of two has the body of the first. It has the table of the first
// if either of them has no base materials, as above.
Robot with_mutated_muscles(Robot robot, double strength, std::uint64_t seed);
Robot with_crossed_muscles(Robot a, const Robot& b, std::uint64_t seed);

}  // namespace mercury
