// SPDX-License-Identifier: Apache-2.0
// Columns of results, and the page that describes them.
#include "app/commands/robot_results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "app/commands/run_report.h"

namespace mercury {
namespace {

// The cells of the lines "| `name` | unit | help |" below a heading of docs/formats.md.
std::vector<std::vector<std::string>> documented_columns() {
  std::ifstream page(MERCURY_DOCS "/formats.md");
  std::vector<std::vector<std::string>> columns;
  bool is_here = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) is_here = line.starts_with("## Results of `mercury run`");
    if (!is_here || !line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    std::istringstream rest(line.substr(1));
    for (std::string cell; std::getline(rest, cell, '|');) {
      const std::size_t first = cell.find_first_not_of(' ');
      cells.push_back(first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
    }
    columns.push_back(cells);
  }
  return columns;
}

TEST(RobotResults, ThePageOfFormatsDescribesEveryColumn) {
  std::vector<std::vector<std::string>> expected;
  std::string names;
  for (const ResultColumn& column : result_columns()) {
    expected.push_back({fmt::format("`{}`", column.name), std::string(column.unit), std::string(column.help)});
    names.append(names.empty() ? "" : ",").append(column.name);
  }
  EXPECT_EQ(documented_columns(), expected);
  EXPECT_EQ(csv_heading(), names + "\n");
}

RobotResult walker(double distance) {
  RobotResult robot{.identity = {.index = 3, .name = "a,\"b\"", .file = "x.json"}, .fate = Fate::sound};
  robot.masses = 2;
  robot.springs = 1;
  robot.distance = distance;
  robot.hash = 0xabc;
  return robot;
}

TEST(RobotResults, ValuesThatMeanNothingAreEmptyOrNull) {
  EXPECT_EQ(csv_line(walker(0.1)),
            "3,\"a,\"\"b\"\"\",x.json,,sound,,2,1,paper,0.1,1,,,,,,,,,,,,,,,,,,,,,,,false,,,0000000000000abc\n");
  const auto json = json_of(walker(0.1));
  EXPECT_EQ(json["distance"], 0.1);
  EXPECT_EQ(json["exploded"], false);
  EXPECT_TRUE(json["end_x"].is_null() && json["random"].is_null() && json["exploded_at"].is_null());
  const RobotResult failed{.identity = {.index = 1, .name = "n"}, .failure = "none"};
  EXPECT_EQ(csv_line(failed), "1,n,,,failed,none" + std::string(result_columns().size() - 6, ',') + "\n");
  EXPECT_TRUE(json_of(failed)["hash"].is_null() && json_of(failed)["masses"].is_null());
}

// A name of any length and any bytes takes one line of the table.
TEST(RobotResults, TheTableMarksWhatMeansNothingAndKeepsNamesInOneLine) {
  RobotResult exploded = walker(RobotResult::none);
  exploded.identity.name = "\x1b[31mred\n" + std::string(10'000, 'x');
  exploded.fate = Fate::exploded;
  exploded.exploded_at = 2;
  RunReport report;
  report.robots = {exploded, walker(1)};
  const std::string table = table_of(report);
  EXPECT_EQ(table.find('\x1b'), std::string::npos);
  EXPECT_LT(table.size(), 2000u);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 8);
  EXPECT_NE(table.find("exploded at 2 s"), std::string::npos);
  EXPECT_NE(table.find("- = means nothing"), std::string::npos);
  report.robots = {walker(1)};
  EXPECT_EQ(table_of(report).find("- = means nothing"), std::string::npos);
}

}  // namespace
}  // namespace mercury
