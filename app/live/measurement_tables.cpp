// SPDX-License-Identifier: Apache-2.0
#include "app/live/measurement_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/base/output_files.h"

namespace mercury {

std::string series_csv(const SceneDocument& document, const Measurements& measurements,
                       const std::vector<RobotId>& robots) {
  std::string header = "time [s]";
  std::map<double, std::size_t> rows;  // time -> row
  std::vector<Series> all;
  for (const RobotId id : robots) {
    const DocumentRobot* robot = document.find(id);
    if (!robot) continue;
    for (const MeasureName& measure : measures())
      header.append(",").append(csv_field(fmt::format("{} {} [{}]", robot->body.name, measure.name, measure.unit)));
    all.push_back(measurements.series(id));
    for (const double time : all.back().times) rows.emplace(time, 0);
  }
  std::vector<std::string> lines;
  for (auto& [time, row] : rows) {
    row = lines.size();
    lines.push_back(csv_number(time));
  }
  for (const Series& series : all) {
    std::vector<bool> filled(lines.size());
    for (std::size_t i = 0; i < series.times.size(); ++i) {
      const std::size_t row = rows.at(series.times[i]);
      filled[row] = true;
      for (const MeasureName& measure : measures())
        if (const float value = series.samples[i].of(measure.measure); std::isnan(value))
          lines[row] += ',';
        else
          lines[row] += fmt::format(",{}", value);
    }
    for (std::size_t row = 0; row < lines.size(); ++row)
      if (!filled[row]) lines[row].append(measures().size(), ',');
  }
  std::string text = header + "\n";
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string ranking_csv(const SceneDocument& document, const Measurements& measurements) {
  std::string text =
      "name,distance [m],mean speed [m/s],age [s],distance at equal age [m],speed [m/s],kinetic energy [J],elastic "
      "energy "
      "[J],largest strain,exploded at [s]\n";
  std::vector<RankingRow> rows = measurements.ranking();
  std::ranges::stable_sort(rows,
                           [](const auto& a, const auto& b) { return ranks_before(a, b, a.distance, b.distance); });
  for (const RankingRow& row : rows) {
    const DocumentRobot* robot = document.find(row.robot);
    if (!robot) continue;
    text += csv_field(robot->body.name);
    for (const double figure : {row.distance, row.mean_speed, row.age, row.distance_at_equal_age, row.speed,
                                row.kinetic_energy, row.elastic_energy, row.largest_strain})
      text.append(1, ',').append(row.counts() ? csv_number(figure) : "");
    text.append(1, ',').append(row.exploded ? csv_number(row.exploded_at) : "").append(1, '\n');
  }
  return text;
}

}  // namespace mercury
