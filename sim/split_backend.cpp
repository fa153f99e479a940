// SPDX-License-Identifier: Apache-2.0
#include "mercury/backend.h"

#include <algorithm>
#include <exception>
#include <future>

namespace mercury {
namespace {

class SplitBackend final : public Backend {
 public:
  explicit SplitBackend(std::vector<std::unique_ptr<Backend>> parts) : parts_(std::move(parts)) {}

  std::string device_name() const override {
    std::string names;
    for (std::size_t first = 0, last = 0; first < parts_.size(); first = last) {
      const std::string name = parts_[first]->device_name();
      while (last < parts_.size() && parts_[last]->device_name() == name) ++last;
      names += (names.empty() ? "" : ", ") + (last - first > 1 ? std::to_string(last - first) + " x " : "") + name;
    }
    return names;
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

  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    first_robot_.assign(1, 0);
    first_mass_.assign(1, 0);
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      first_robot_.push_back(robots.size() * (p + 1) / parts_.size());
      std::size_t masses = first_mass_.back();
      for (std::size_t i = first_robot_[p]; i < first_robot_[p + 1]; ++i) masses += robots[i]->masses.size();
      first_mass_.push_back(masses);
    }
    for_each_part([&](std::size_t p) {
      parts_[p]->load(robots.subspan(first_robot_[p], first_robot_[p + 1] - first_robot_[p]), configuration);
    });
  }

  void configure(const Configuration& configuration) override {
    for_each_part([&](std::size_t p) { parts_[p]->configure(configuration); });
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
  void read_positions(std::span<Vec3> out) const override {
    for_each_part([&](std::size_t p) { parts_[p]->read_positions(masses_of(p, out)); });
  }
  void read_velocities(std::span<Vec3> out) const override {
    for_each_part([&](std::size_t p) { parts_[p]->read_velocities(masses_of(p, out)); });
  }

  RobotStatus status(std::size_t robot) const override { return part_of(robot).status(index_in_part(robot)); }
  std::vector<RobotStatus> statuses() const override {
    return gather<RobotStatus>([](const Backend& part) { return part.statuses(); });
  }
  void set_status(std::size_t robot, const RobotStatus& status) override {
    part_of(robot).set_status(index_in_part(robot), status);
  }

  void write_materials(std::span<const Material> tables) override {
    for_each_part([&](std::size_t p) {
      parts_[p]->write_materials(
          tables.subspan(first_robot_[p] * max_materials, (first_robot_[p + 1] - first_robot_[p]) * max_materials));
    });
  }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    part_of(robot).write_materials(index_in_part(robot), table);
  }

  void set_perturbations(std::span<const Perturbation> perturbations) override {
    std::vector<std::vector<Perturbation>> shares(parts_.size());
    for (Perturbation perturbation : perturbations) {
      const std::size_t p = part_index(perturbation.robot);
      perturbation.robot -= first_robot_[p];
      shares[p].push_back(perturbation);
    }
    for (std::size_t p = 0; p < parts_.size(); ++p) parts_[p]->set_perturbations(shares[p]);
  }

  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    for_each_part([&](std::size_t p) {
      const std::size_t first = first_robot_[p], count = first_robot_[p + 1] - first;
      parts_[p]->report(clock, telemetry.subspan(first, count), statuses.subspan(first, count));
    });
  }

 private:
  std::size_t part_index(std::size_t robot) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(first_robot_, robot) - first_robot_.begin()) - 1;
  }
  Backend& part_of(std::size_t robot) const { return *parts_[part_index(robot)]; }
  std::size_t index_in_part(std::size_t robot) const { return robot - first_robot_[part_index(robot)]; }
  std::span<Vec3> masses_of(std::size_t p, std::span<Vec3> all) const {
    return all.subspan(first_mass_[p], first_mass_[p + 1] - first_mass_[p]);
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

  template <class T, class Ask>
  std::vector<T> gather(const Ask& ask) const {
    std::vector<std::vector<T>> shares(parts_.size());
    for_each_part([&](std::size_t p) { shares[p] = ask(*parts_[p]); });
    std::vector<T> all;
    for (const std::vector<T>& share : shares) all.insert(all.end(), share.begin(), share.end());
    return all;
  }

  std::vector<std::unique_ptr<Backend>> parts_;
  std::vector<std::size_t> first_robot_{0}, first_mass_{0};  // of each part, then the end
};

}  // namespace

std::unique_ptr<Backend> make_split_backend(std::vector<std::unique_ptr<Backend>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<SplitBackend>(std::move(parts));
}

}  // namespace mercury
