// SPDX-License-Identifier: Apache-2.0
// What became of a file of another simulator: every element of it, and what Mercury made of each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mercury {

enum class ImportOutcome { mapped, approximated, ignored };

// "mapped", "approximated", "ignored".
std::string_view name_of(ImportOutcome outcome);

struct ImportedElement {
  std::string place;  // in the file: "/VXA/VXC/Palette/Material[3]/Mechanical/CTE", "/objects/robot/types"
  std::string value;  // shortened if it is long
  ImportOutcome outcome = ImportOutcome::ignored;
  std::string reason;  // what it became, or why it was ignored; "unknown" for elements that no reader knows
};

struct ImportReport {
  std::string file;                       // as it was given
  std::string format;                     // "VXA of voxcraft-sim", "EvoGym world", ...
  std::string base;                       // the file that a .vxd or .rsc builds on; empty = none
  std::vector<std::string> robots;        // their names
  double length_scale = 1;                // meters here per meter in the file
  double time_scale = 1;                  // seconds here per second in the file
  std::vector<ImportedElement> elements;  // all of them, in the order of the file
  // What belongs to no single element. First what decides how the robot moves: what holds or drives it there and not
  // here, and what is assumed. Then the rest, such as rounded materials.
  std::vector<std::string> decisive, notes;
};

}  // namespace mercury
