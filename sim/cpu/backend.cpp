// SPDX-License-Identifier: Apache-2.0
// The CPU backend: work batches of robots run on a thread pool.
#include "mercury/backend.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>

#include "sim/cpu/advance.h"
#include "sim/cpu/backend.h"
#include "sim/cpu/grouping/cost_model.h"
#include "sim/cpu/telemetry.h"

namespace mercury {
namespace {

using namespace cpu;

class CpuBackend final : public Backend {
 public:
  CpuBackend(const Device& device, const Kernel& kernel)
      : kernel_(kernel), arena_(device.threads > 0 ? device.threads : oneapi::tbb::task_arena::automatic) {
    // Without this, TBB refuses more threads than cores, with a warning on stderr.
    if (device.threads > oneapi::tbb::info::default_concurrency())
      allowance_.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(device.threads));
  }

  std::string device_name() const override {
    const int threads = arena_.max_concurrency();
    return "CPU, " + std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ") + std::string(kernel_.name);
  }
  std::vector<std::string> notes() const override { return {}; }

  std::size_t robots_at_once() const override {
    const bool together = !bodies_.empty() && fits_in_group(bodies_.front());
    return static_cast<std::size_t>(arena_.max_concurrency()) * (together ? kernel_.lanes : 1);
  }
  double spring_limit() const override { return 0; }
  double busy_seconds() const override { return busy_seconds_; }

  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    batches_.clear();
    bodies_.clear();
    bodies_.resize(robots.size());
    for_each_body([&](std::size_t i) {
      bodies_[i] = make_body(*robots[i], kernel_.lanes);
      const std::vector<Vec3> at_rest(robots[i]->masses.size());
      set_state(bodies_[i], robots[i]->masses, at_rest);
    });
    configure(configuration);
  }

  BatchSettings settings() const override {
    BatchSettings now{.configuration = configuration_};
    for (const Body& body : bodies_) {
      now.materials.insert(now.materials.end(), body.materials.begin(), body.materials.end());
      now.perturbations.insert(now.perturbations.end(), body.perturbations.begin(), body.perturbations.end());
    }
    return now;
  }

  void configure(const Configuration& configuration) override {
    configuration_ = configuration;
    setting_ = setting_of(configuration);
    ungroup();
    for_each_body([&](std::size_t i) { update_spring_parameters(bodies_[i], configuration_); });
  }

  void step(const Clock& clock, std::int64_t steps) override {
    const auto start = std::chrono::steady_clock::now();
    std::atomic<std::size_t> broken_up = 0;
    arena_.execute([&] {
      if (batches_.empty())
        batches_ = make_work_batches(bodies_, static_cast<std::size_t>(arena_.max_concurrency()), configuration_);
      oneapi::tbb::parallel_for(std::size_t{0}, batches_.size(), [&](std::size_t i) {
        broken_up += advance(kernel_, batches_[i], bodies_, setting_, clock, steps);
      });
    });
    changes_since_grouping_ += broken_up;
    // New groups exclude the robots that have exploded. They are not worth it at each explosion.
    std::size_t groups = 0;
    for (const WorkBatch& batch : batches_) groups += batch.groups.size();
    if (16 * changes_since_grouping_ > groups) ungroup();
    busy_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    const Body& body = bodies_[robot];
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = body.position(i);
    for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i] = body.velocity(i);
  }

  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    if (bodies_[robot].location.group) cpu::store(*bodies_[robot].location.group);
    set_state(bodies_[robot], positions, velocities);
  }

  void read_positions(std::span<Vec3> out) const override {
    for (const Body& body : bodies_)
      for (std::size_t i = 0; i < body.robot->masses.size(); ++i, out = out.subspan(1)) out.front() = body.position(i);
  }

  void read_velocities(std::span<Vec3> out) const override {
    for (const Body& body : bodies_)
      for (std::size_t i = 0; i < body.robot->masses.size(); ++i, out = out.subspan(1)) out.front() = body.velocity(i);
  }

  RobotStatus status(std::size_t robot) const override { return bodies_[robot].status; }
  std::vector<RobotStatus> statuses() const override {
    std::vector<RobotStatus> all;
    for (const Body& body : bodies_) all.push_back(body.status);
    return all;
  }
  void set_status(std::size_t robot, const RobotStatus& status) override {
    if ((bodies_[robot].status.exploded_step < 0) != (status.exploded_step < 0)) ++changes_since_grouping_;
    bodies_[robot].status = status;
  }

  void write_materials(std::span<const Material> tables) override {
    for_each_body([&](std::size_t i) { replace_table(i, tables.subspan(i * max_materials, max_materials)); });
    for (WorkBatch& batch : batches_) batch.spring_parameters_are_stale = true;
  }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    replace_table(robot, table);
    for (WorkBatch& batch : batches_) batch.spring_parameters_are_stale = true;
  }

  void set_perturbations(std::span<const Perturbation> perturbations) override {
    for (Body& body : bodies_) body.perturbations.clear();
    for (const Perturbation& perturbation : perturbations)
      bodies_[perturbation.robot].perturbations.push_back(perturbation);
  }

  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    for_each_body([&](std::size_t i) {
      telemetry[i] = measure_state(bodies_[i], configuration_, clock);
      statuses[i] = bodies_[i].status;
    });
  }

 private:
  template <class Work>
  void for_each_body(const Work& work) const {
    arena_.execute([&] { oneapi::tbb::parallel_for(std::size_t{0}, bodies_.size(), [&](std::size_t i) { work(i); }); });
  }

  // Brings all states back to the bodies. The next step makes new batches.
  void ungroup() {
    cpu::store(batches_);
    batches_.clear();
    changes_since_grouping_ = 0;
  }

  void replace_table(std::size_t robot, std::span<const Material> table) {
    std::ranges::copy(table, bodies_[robot].materials.begin());
    update_spring_parameters(bodies_[robot], configuration_);
  }

  const Kernel kernel_;
  std::optional<oneapi::tbb::global_control> allowance_;
  mutable oneapi::tbb::task_arena arena_;
  std::vector<Body> bodies_;
  std::vector<WorkBatch> batches_;          // empty = to be made before the next step
  std::size_t changes_since_grouping_ = 0;  // groups broken up, exploded robots set by the caller
  Configuration configuration_;
  StepSetting setting_;
  double busy_seconds_ = 0;
};

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(const Device& device) {
  return cpu::make_backend(device, cpu::kernels().front());
}

std::unique_ptr<Backend> cpu::make_backend(const Device& device, const Kernel& kernel) {
  return std::make_unique<CpuBackend>(device, kernel);
}

}  // namespace mercury
