// SPDX-License-Identifier: Apache-2.0
// The CPU backend: robots are shared out over the cores, each stepped by one of them.
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

#include "sim/cpu/backend.h"
#include "sim/cpu/pack.h"
#include "sim/cpu/party.h"
#include "sim/cpu/telemetry.h"

namespace mercury {
namespace {

using namespace cpu;

class CpuBackend final : public Backend {
 public:
  CpuBackend(const Device& device, const Kernel& kernel)
      : kernel_(kernel), arena_(device.threads > 0 ? device.threads : oneapi::tbb::task_arena::automatic) {
    // Without this, more threads than cores are refused, with a warning on stderr.
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
    const bool together = !bodies_.empty() && fits_in_party(bodies_.front());
    return static_cast<std::size_t>(arena_.max_concurrency()) * (together ? kernel_.lanes : 1);
  }
  double spring_limit() const override { return 0; }
  double busy_seconds() const override { return busy_seconds_; }

  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    packs_.clear();
    bodies_.clear();
    bodies_.resize(robots.size());
    for_each_body([&](std::size_t i) {
      bodies_[i] = make_body(*robots[i], kernel_.lanes);
      const std::vector<Vec3> at_rest(robots[i]->masses.size());
      set_state(bodies_[i], robots[i]->masses, at_rest);
    });
    configure(configuration);
  }

  void configure(const Configuration& configuration) override {
    configuration_ = configuration;
    setting_ = setting_of(configuration);
    unpack();
    for_each_body([&](std::size_t i) { update_laws(bodies_[i], configuration_); });
  }

  void step(const Clock& clock, std::int64_t steps) override {
    const auto start = std::chrono::steady_clock::now();
    std::atomic<std::size_t> broken = 0;
    arena_.execute([&] {
      if (packs_.empty()) packs_ = pack(bodies_, static_cast<std::size_t>(arena_.max_concurrency()), configuration_);
      oneapi::tbb::parallel_for(std::size_t{0}, packs_.size(), [&](std::size_t i) {
        broken += advance(kernel_, packs_[i], bodies_, setting_, clock, steps);
      });
    });
    out_of_place_ += broken;
    // Groups are made anew of the robots that are whole, but not at every explosion.
    std::size_t groups = 0;
    for (const Pack& pack : packs_) groups += pack.groups.size();
    if (16 * out_of_place_ > groups) unpack();
    busy_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    const Body& body = bodies_[robot];
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = body.position(i);
    for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i] = body.velocity(i);
  }

  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    if (bodies_[robot].residence.group) cpu::store(*bodies_[robot].residence.group);
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
    if ((bodies_[robot].status.exploded_step < 0) != (status.exploded_step < 0)) ++out_of_place_;
    bodies_[robot].status = status;
  }

  void write_materials(std::span<const Material> tables) override {
    for_each_body([&](std::size_t i) { replace_table(i, tables.subspan(i * max_materials, max_materials)); });
    for (Pack& pack : packs_) pack.laws_are_stale = true;
  }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    replace_table(robot, table);
    for (Pack& pack : packs_) pack.laws_are_stale = true;
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

  // Robots are shared out anew before the next step.
  void unpack() {
    cpu::store(packs_);
    packs_.clear();
    out_of_place_ = 0;
  }

  void replace_table(std::size_t robot, std::span<const Material> table) {
    std::ranges::copy(table, bodies_[robot].materials.begin());
    update_laws(bodies_[robot], configuration_);
  }

  const Kernel kernel_;
  std::optional<oneapi::tbb::global_control> allowance_;
  mutable oneapi::tbb::task_arena arena_;
  std::vector<Body> bodies_;
  std::vector<Pack> packs_;       // empty = to be made before the next step
  std::size_t out_of_place_ = 0;  // groups broken up, robots made whole again or exploded by order
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
