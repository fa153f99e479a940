// SPDX-License-Identifier: Apache-2.0
#include "app/live/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "app/base/output_files.h"
#include "app/live/scene_document.h"
#include "mercury/distance.h"

namespace mercury {
namespace {

constexpr double sample_period = 0.02;  // the first interval [s]

constexpr std::array<MeasureName, 7> names{{
    {Measure::speed, "speed", "m/s", "of the center of mass"},
    {Measure::distance, "distance", "m", "of the center of mass from where it was at first"},
    {Measure::kinetic_energy, "kinetic energy", "J", "of the motion of all masses"},
    {Measure::elastic_energy, "elastic energy", "J", "in all springs"},
    {Measure::strain, "largest strain", "1", "how much longer than at rest the most stretched spring was so far"},
    {Measure::inverted, "inverted", "1", "share of the body that is turned inside out, which real bodies cannot be",
     true},
    {Measure::overlap, "overlap", "1", "share of the masses that are inside another part of the body", true},
}};

Sample sample_of(const RankingRow& row, const Telemetry& telemetry) {
  return {.speed = static_cast<float>(row.speed),
          .distance = static_cast<float>(row.distance),
          .kinetic_energy = static_cast<float>(row.kinetic_energy),
          .elastic_energy = static_cast<float>(row.elastic_energy),
          .strain = telemetry.largest_strain,
          .inverted = telemetry.inverted,
          .overlap = telemetry.overlap};
}

template <class T>
void keep_every_second(std::vector<T>& values, std::size_t first) {
  std::size_t kept = 0;
  for (std::size_t i = first; i < values.size(); i += 2) values[kept++] = values[i];
  values.resize(kept);
}

}  // namespace

std::span<const MeasureName> measures() { return names; }

bool ranks_before(const RankingRow& a, const RankingRow& b, double figure_a, double figure_b, bool ascending) {
  if (a.counts() != b.counts()) return a.counts();
  return a.counts() && (ascending ? figure_a < figure_b : figure_b < figure_a);
}

float Sample::of(Measure measure) const {
  switch (measure) {
    case Measure::speed:
      return speed;
    case Measure::distance:
      return distance;
    case Measure::kinetic_energy:
      return kinetic_energy;
    case Measure::elastic_energy:
      return elastic_energy;
    case Measure::inverted:
      return inverted;
    case Measure::overlap:
      return overlap;
    case Measure::strain:
      break;
  }
  return strain;
}

Measurements::Measurements(std::size_t capacity) : capacity_(std::max<std::size_t>(4, capacity + capacity % 2)) {}

void Measurements::restart(const LiveRobots& robots, double time, std::int64_t step, const Configuration& configuration,
                           std::span<const Telemetry> telemetry) {
  const std::lock_guard lock(mutex_);
  environment_ = configuration.environment;
  order_.clear();
  tracks_.clear();
  times_.clear();
  interval_ = std::max<std::int64_t>(1, std::llround(sample_period / configuration.dt));
  first_interval_ = interval_;
  next_ = step;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    order_.push_back(robots.robots[i].id);
    Track& track = tracks_[order_.back()];
    track = {.start = telemetry[i].center_of_mass, .start_time = time};
    track.row.robot = order_.back();
    note(track, telemetry[i], time);
  }
}

void Measurements::branch(const Measurements& other, std::span<const RobotId> robots) {
  const std::scoped_lock lock(mutex_, other.mutex_);
  environment_ = other.environment_;
  tracks_.clear();
  for (const RobotId id : robots)
    if (const auto track = other.tracks_.find(id); track != other.tracks_.end()) tracks_.insert(*track);
  order_.assign(robots.begin(), robots.end());
  times_ = other.times_;
  interval_ = other.interval_;
  first_interval_ = other.first_interval_;
  next_ = other.next_;
}

void Measurements::set_robots(const LiveRobots& robots, double time, const Environment& environment,
                              std::span<const Telemetry> telemetry) {
  const std::lock_guard lock(mutex_);
  environment_ = environment;
  order_.clear();
  std::map<RobotId, Track> tracks;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotId id = robots.robots[i].id;
    order_.push_back(id);
    const auto old = tracks_.find(id);
    Track& track = tracks[id];
    if (old != tracks_.end()) {
      track = std::move(old->second);
    } else {
      track = {.start = telemetry[i].center_of_mass, .start_time = time, .missing = times_.size()};
      track.row.robot = id;
    }
    note(track, telemetry[i], time);
  }
  tracks_ = std::move(tracks);
}

std::int64_t Measurements::next_step() const {
  const std::lock_guard lock(mutex_);
  return next_;
}

void Measurements::note(Track& track, const Telemetry& telemetry, double time) const {
  RankingRow& row = track.row;
  const auto finite = [](double value) { return std::isfinite(value) ? value : 0; };
  track.largest_strain = std::max(track.largest_strain, finite(telemetry.largest_strain));
  row.largest_strain = track.largest_strain;
  row.exploded = telemetry.exploded;
  row.exploded_at = telemetry.exploded_at;
  row.distance = finite(distance_between(track.start, telemetry.center_of_mass, environment_));
  row.age = std::max(0.0, time - track.start_time);
  row.mean_speed = row.age > 0 ? row.distance / row.age : 0;
  row.speed = telemetry.exploded ? 0 : finite(length(telemetry.velocity));
  row.kinetic_energy = telemetry.exploded ? 0 : finite(telemetry.kinetic_energy);
  row.elastic_energy = telemetry.exploded ? 0 : finite(telemetry.elastic_energy);
}

void Measurements::observe(double time, std::int64_t step, std::span<const Telemetry> telemetry) {
  const std::lock_guard lock(mutex_);
  const bool due = step >= next_;
  if (due) times_.push_back(time);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    Track& track = tracks_[order_[i]];
    note(track, telemetry[i], time);
    if (due) track.samples.push_back(sample_of(track.row, telemetry[i]));
  }
  if (!due) return;
  next_ = step + interval_;
  if (times_.size() >= capacity_) thin();
}

void Measurements::cut(double time, std::int64_t step) {
  const std::lock_guard lock(mutex_);
  const auto kept = static_cast<std::size_t>(std::ranges::upper_bound(times_, time) - times_.begin());
  if (kept < times_.size()) next_ = step;
  times_.resize(kept);
  for (auto& [id, track] : tracks_) {
    track.missing = std::min(track.missing, kept);
    track.samples.resize(kept - track.missing);
  }
}

void Measurements::thin_out() {
  const std::lock_guard lock(mutex_);
  if (interval_ >= 1024 * first_interval_) return;
  // The next sample continues the rhythm of those that are kept.
  const bool even = times_.size() % 2 == 0;
  thin();
  if (!even) next_ += interval_ / 2;
}

void Measurements::thin() {
  keep_every_second(times_, 0);
  for (auto& [id, track] : tracks_) {
    // Samples with even indices stay. The first sample of the track has the index `missing`.
    keep_every_second(track.samples, track.missing % 2);
    track.missing = (track.missing + 1) / 2;
  }
  interval_ *= 2;
}

Series Measurements::series(RobotId robot) const {
  const std::lock_guard lock(mutex_);
  const auto track = tracks_.find(robot);
  if (track == tracks_.end()) return {};
  return {{times_.begin() + static_cast<std::ptrdiff_t>(track->second.missing), times_.end()}, track->second.samples};
}

double Measurements::distance_at_age(RobotId robot, double age) const {
  const std::lock_guard lock(mutex_);
  const auto track = tracks_.find(robot);
  return track == tracks_.end() ? 0 : distance_at(track->second, age);
}

std::vector<RankingRow> Measurements::ranking() const {
  const std::lock_guard lock(mutex_);
  double youngest = std::numeric_limits<double>::infinity();
  for (const auto& [id, track] : tracks_)
    if (track.row.counts()) youngest = std::min(youngest, track.row.age);
  std::vector<RankingRow> rows;
  rows.reserve(order_.size());
  for (const RobotId id : order_) {
    const Track& track = tracks_.at(id);
    rows.push_back(track.row);
    rows.back().distance_at_equal_age = distance_at(track, youngest);
  }
  return rows;
}

double Measurements::distance_at(const Track& track, double age) const {
  if (age >= track.row.age) return track.row.distance;
  const double time = track.start_time + age;
  const std::span times(times_.begin() + static_cast<std::ptrdiff_t>(track.missing), track.samples.size());
  const auto next = static_cast<std::size_t>(std::ranges::upper_bound(times, time) - times.begin());
  // Before the first sample is the start, and after the last one the present.
  const double before = next > 0 ? times[next - 1] : track.start_time;
  const double after = next < times.size() ? times[next] : track.start_time + track.row.age;
  const double low = next > 0 ? static_cast<double>(track.samples[next - 1].distance) : 0;
  const double high = next < times.size() ? static_cast<double>(track.samples[next].distance) : track.row.distance;
  return after > before ? low + (high - low) * (time - before) / (after - before) : low;
}

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
      "energy [J],largest strain,exploded at [s]\n";
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
