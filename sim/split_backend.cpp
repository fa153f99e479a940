// SPDX-License-Identifier: Apache-2.0
#include "mercury/backend.h"

#include <algorithm>
#include <exception>
#include <future>
#include <memory>
#include <mutex>
#include <utility>

#include "sim/devices.h"

namespace mercury {
namespace {

// Which part has which robots. Within a part, robots stand in the order of the batch.
//
//     batch    0  1  2  3  4  5  6
//     part 0   0        3  4     6      four robots, three runs: 0, 3-4 and 6
//     part 1      1  2        5
class Shares {
 public:
  struct Place {
    std::size_t part, index;  // index in the part
  };

  explicit Shares(std::size_t parts) : parts_(parts) {}

  std::size_t size() const { return places_.size(); }
  std::size_t size(std::size_t part) const { return parts_[part].robots.size(); }
  std::size_t masses(std::size_t part) const { return parts_[part].masses; }
  std::span<const Robot* const> robots(std::size_t part) const { return parts_[part].robots; }
  Place place(std::size_t robot) const { return places_[robot]; }
  std::span<const std::size_t> in_batch(std::size_t part) const { return parts_[part].in_batch; }  // indices
  // How many robots of a part stand before this one in the batch.
  std::size_t count_before(std::size_t part, std::size_t robot) const {
    const std::vector<std::size_t>& robots = parts_[part].in_batch;
    return static_cast<std::size_t>(std::ranges::lower_bound(robots, robot) - robots.begin());
  }
  std::span<const std::size_t> first_mass() const { return first_mass_; }  // by robot, then the number of all masses

  // Takes the next robot of the batch into a part.
  void append(std::size_t part, const Robot& robot) {
    Part& to = parts_[part];
    places_.push_back({part, to.robots.size()});
    to.robots.push_back(&robot);
    to.in_batch.push_back(places_.size() - 1);
    to.masses += robot.masses.size();
    to.springs += robot.springs.size();
    first_mass_.push_back(first_mass_.back() + robot.masses.size());
  }

  // The part with the least work. Robots without springs count by their masses.
  std::size_t least() const {
    const auto work = [](const Part& part) { return std::pair(part.springs, part.masses); };
    return static_cast<std::size_t>(std::ranges::min_element(parts_, {}, work) - parts_.begin());
  }

  // Calls visit(first in the part, first in the batch, count) for each run: robots that follow each other in both.
  template <class Visit>
  void for_each_run(std::size_t part, const Visit& visit) const {
    const std::vector<std::size_t>& robots = parts_[part].in_batch;
    for (std::size_t first = 0, last = 0; first < robots.size(); first = last) {
      for (++last; last < robots.size() && robots[last] == robots[last - 1] + 1;) ++last;
      visit(first, robots[first], last - first);
    }
  }

 private:
  struct Part {
    std::vector<const Robot*> robots;
    std::vector<std::size_t> in_batch;  // their indices
    std::size_t masses = 0, springs = 0;
  };

  std::vector<Part> parts_;
  std::vector<Place> places_;
  std::vector<std::size_t> first_mass_{0};
};

class SplitBackend final : public Backend {
 public:
  explicit SplitBackend(std::vector<std::unique_ptr<Backend>> parts)
      : parts_(std::move(parts)), shares_(parts_.size()) {}

  std::string device_name() const override {
    std::vector<std::string> names;
    for (const auto& part : parts_) names.push_back(part->device_name());
    return joined_device_names(names);
  }

  std::vector<std::string> notes() const override {
    std::vector<std::string> all;
    for (const auto& part : parts_)
      for (const std::string& note : part->notes())
        if (std::ranges::find(all, note) == all.end()) all.push_back(note);
    return all;
  }

  std::size_t robots_at_once() const override {
    std::size_t sum = 0;
    for (const auto& part : parts_) sum += part->robots_at_once();
    return sum;
  }
  double spring_limit() const override {
    double sum = 0;
    for (const auto& part : parts_) sum += part->spring_limit();
    return sum;
  }
  double busy_seconds() const override {
    double longest = 0;
    for (const auto& part : parts_) longest = std::max(longest, part->busy_seconds());
    return longest;
  }
  LoadTimes load_times() const override {
    LoadTimes longest;
    for (const auto& part : parts_) {
      const LoadTimes times = part->load_times();
      longest.schedule = std::max(longest.schedule, times.schedule);
      longest.upload = std::max(longest.upload, times.upload);
    }
    return longest;
  }

  // Parts load at the same time, and the watch is called by one thread at a time.
  void set_watch(const WorkWatch& watch) override {
    const auto mutex = std::make_shared<std::mutex>();
    for (const auto& part : parts_)
      part->set_watch([watch, mutex](const char* what, std::size_t done, std::size_t total) {
        const std::lock_guard lock(*mutex);
        watch(what, done, total);
      });
  }

  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    shares_ = Shares(parts_.size());
    for (const Robot* robot : robots) shares_.append(shares_.least(), *robot);
    for_each_part([&](std::size_t p) { parts_[p]->load(shares_.robots(p), configuration); });
  }

  void add(std::span<const Robot* const> robots, std::size_t first_new) override {
    std::vector<std::size_t> before;
    for (std::size_t p = 0; p < parts_.size(); ++p) before.push_back(shares_.size(p));
    for (const Robot* robot : robots.subspan(first_new)) shares_.append(shares_.least(), *robot);
    for_each_part([&](std::size_t p) {
      if (shares_.size(p) > before[p]) parts_[p]->add(shares_.robots(p), before[p]);
    });
  }

  void keep(std::span<const Robot* const> robots, std::span<const std::size_t> indices) override {
    Shares remaining(parts_.size());
    std::vector<std::vector<std::size_t>> kept(parts_.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const Shares::Place before = shares_.place(indices[i]);
      kept[before.part].push_back(before.index);
      remaining.append(before.part, *robots[i]);
    }
    for_each_part([&](std::size_t p) {
      if (kept[p].size() == shares_.size(p) && std::ranges::is_sorted(kept[p]))
        parts_[p]->set_perturbations({});
      else
        parts_[p]->keep(remaining.robots(p), kept[p]);
    });
    shares_ = std::move(remaining);
  }

  void configure(const Configuration& configuration) override {
    for_each_part([&](std::size_t p) { parts_[p]->configure(configuration); });
  }
  void set_environments(std::span<const std::size_t> robots, std::span<const Environment> environments) override {
    std::vector<std::vector<std::size_t>> robots_of(parts_.size());
    std::vector<std::vector<Environment>> environments_of(parts_.size());
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const auto [part, index] = shares_.place(robots[i]);
      robots_of[part].push_back(index);
      environments_of[part].push_back(environments[i]);
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p]->set_environments(robots_of[p], environments_of[p]);
  }
  void step(const Clock& clock, std::int64_t steps) override {
    for_each_part([&](std::size_t p) { parts_[p]->step(clock, steps); });
  }

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    part_of(robot).read(index_in_part(robot), positions, velocities);
  }
  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    part_of(robot).write(index_in_part(robot), positions, velocities);
  }
  void put_at_rest(std::span<const Robot* const> robots, std::size_t first, std::span<const float> lifts) override {
    for_each_part([&](std::size_t p) {
      const std::size_t before = shares_.count_before(p, first),
                        count = shares_.count_before(p, first + lifts.size()) - before;
      std::vector<const Robot*> robots_of_part;
      std::vector<float> lifts_of_part;
      for (const std::size_t robot : shares_.in_batch(p).subspan(before, count)) {
        robots_of_part.push_back(robots[robot - first]);
        lifts_of_part.push_back(lifts[robot - first]);
      }
      if (count > 0) parts_[p]->put_at_rest(robots_of_part, before, lifts_of_part);
    });
  }
  void read_positions(std::span<Vec3> out) const override {
    gather_masses(out, [](const Backend& part, std::span<Vec3> share) { part.read_positions(share); });
  }
  void read_velocities(std::span<Vec3> out) const override {
    gather_masses(out, [](const Backend& part, std::span<Vec3> share) { part.read_velocities(share); });
  }

  RobotStatus status(std::size_t robot) const override { return part_of(robot).status(index_in_part(robot)); }
  std::vector<RobotStatus> statuses() const override {
    std::vector<RobotStatus> all(shares_.size());
    for_each_part([&](std::size_t p) { scatter<RobotStatus>(p, parts_[p]->statuses(), all); });
    return all;
  }
  void set_status(std::size_t robot, const RobotStatus& status) override {
    part_of(robot).set_status(index_in_part(robot), status);
  }

  void write_materials(std::span<const Material> tables) override {
    for_each_part([&](std::size_t p) {
      std::vector<Material> share;
      share.reserve(shares_.size(p) * max_materials);
      shares_.for_each_run(p, [&](std::size_t, std::size_t robot, std::size_t count) {
        const auto run = tables.subspan(robot * max_materials, count * max_materials);
        share.insert(share.end(), run.begin(), run.end());
      });
      parts_[p]->write_materials(share);
    });
  }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    part_of(robot).write_materials(index_in_part(robot), table);
  }

  void set_perturbations(std::span<const Perturbation> perturbations) override {
    std::vector<std::vector<Perturbation>> shares(parts_.size());
    for (Perturbation perturbation : perturbations) {
      const auto [part, index] = shares_.place(perturbation.robot);
      perturbation.robot = index;
      shares[part].push_back(perturbation);
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p]->set_perturbations(shares[p]);
  }

  bool measure_inversion(std::span<const BodyCells* const> cells) override {
    bool is_measured = true;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      std::vector<const BodyCells*> share;
      if (!cells.empty())
        for (const std::size_t robot : shares_.in_batch(p)) share.push_back(cells[robot]);
      is_measured = parts_[p]->measure_inversion(share) && is_measured;
    }
    return is_measured;
  }

  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    for_each_part([&](std::size_t p) {
      std::vector<Telemetry> share(shares_.size(p));
      std::vector<RobotStatus> share_statuses(share.size());
      parts_[p]->report(clock, share, share_statuses);
      scatter<Telemetry>(p, share, telemetry);
      scatter<RobotStatus>(p, share_statuses, statuses);
    });
  }

  // Parts do not wait for each other between the samples that are visited together.
  void step_and_report(const Clock& clock, std::int64_t steps, std::int64_t every, bool from_now,
                       const VisitReports& visit) override {
    const auto at_once = static_cast<std::int64_t>(std::max<std::size_t>(1, most_reports / shares_.size()));
    std::vector<Telemetry> all;
    std::vector<RobotStatus> all_statuses;
    Clock now = clock;
    for (std::int64_t left = steps / every; left > 0; left -= at_once) {
      const std::int64_t reports = std::min(left, at_once);
      const bool and_now = from_now && now.step == clock.step;
      all.assign(static_cast<std::size_t>(reports + and_now) * shares_.size(), {});
      all_statuses.resize(all.size());
      for_each_part([&](std::size_t p) {
        std::size_t first = 0;  // of the part's next reports
        parts_[p]->step_and_report(now, reports * every, every, and_now, [&](auto samples, auto statuses) {
          const std::size_t robots = shares_.size(p);
          for (std::size_t i = 0; i < samples.size(); i += robots, first += shares_.size()) {
            scatter<Telemetry>(p, samples.subspan(i, robots), std::span(all).subspan(first));
            scatter<RobotStatus>(p, statuses.subspan(i, robots), std::span(all_statuses).subspan(first));
          }
        });
      });
      visit(all, all_statuses);
      now.step += reports * every;
    }
  }

 private:
  static constexpr std::size_t most_reports = std::size_t{1} << 16;  // of all robots, at a time

  Backend& part_of(std::size_t robot) const { return *parts_[shares_.place(robot).part]; }
  std::size_t index_in_part(std::size_t robot) const { return shares_.place(robot).index; }

  // Writes one value per robot of a part to the robots' places in the batch.
  template <class T>
  void scatter(std::size_t p, std::span<const T> share, std::span<T> all) const {
    shares_.for_each_run(p, [&](std::size_t first, std::size_t robot, std::size_t count) {
      std::ranges::copy(share.subspan(first, count), all.subspan(robot, count).begin());
    });
  }

  // read(part, one vector per mass of that part) for all parts.
  template <class Read>
  void gather_masses(std::span<Vec3> out, const Read& read) const {
    for_each_part([&](std::size_t p) {
      std::vector<Vec3> share(shares_.masses(p));
      read(*parts_[p], share);
      std::span<const Vec3> left = share;
      shares_.for_each_run(p, [&](std::size_t, std::size_t robot, std::size_t count) {
        const std::size_t first = shares_.first_mass()[robot], masses = shares_.first_mass()[robot + count] - first;
        std::ranges::copy(left.first(masses), out.subspan(first, masses).begin());
        left = left.subspan(masses);
      });
    });
  }

  // Runs work(part) for all parts at once. If parts throw, the last exception is thrown when all are done.
  template <class Work>
  void for_each_part(const Work& work) const {
    std::vector<std::future<void>> others;
    for (std::size_t p = 1; p < parts_.size(); ++p)
      others.push_back(std::async(std::launch::async, [&work, p] { work(p); }));
    std::exception_ptr error;
    const auto keep_error = [&](const auto& done) {
      try {
        done();
      } catch (...) {
        error = std::current_exception();
      }
    };
    keep_error([&] { work(0); });
    for (std::future<void>& other : others) keep_error([&] { other.get(); });
    if (error) std::rethrow_exception(error);
  }

  std::vector<std::unique_ptr<Backend>> parts_;
  Shares shares_;
};

}  // namespace

std::unique_ptr<Backend> make_split_backend(std::vector<std::unique_ptr<Backend>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<SplitBackend>(std::move(parts));
}

}  // namespace mercury
