// SPDX-License-Identifier: Apache-2.0
// The CPU backend: work batches of robots run on a thread pool.
#include "mercury/backend.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <unordered_set>

#include "mercury/error.h"
#include "mercury/parallel.h"
#include "mercury/stopwatch.h"
#include "mercury/threads.h"
#include "mercury/work_counter.h"
#include "sim/cpu/backend.h"
#include "sim/cpu/grouping/cost_model.h"

namespace mercury {
namespace {

using namespace cpu;

class CpuBackend final : public Backend {
 public:
  CpuBackend(const Device& device, const Kernel& kernel) : kernel_(kernel), pool_(device.threads) {}

  std::string device_name() const override {
    const std::size_t threads = pool_.threads();
    return "CPU, " + std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ") + std::string(kernel_.name);
  }
  std::vector<std::string> notes() const override { return {}; }

  std::size_t robots_at_once() const override {
    const bool together = !bodies_.empty() && fits_in_group(*bodies_.front());
    return pool_.threads() * (together ? kernel_.lanes : 1);
  }
  double spring_limit() const override { return 0; }
  double busy_seconds() const override { return busy_seconds_; }
  LoadTimes load_times() const override { return load_times_; }

  void set_watch(const WorkWatch& watch) override { watch_ = watch; }

  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    batches_.clear();
    loose_.clear();
    bodies_.clear();
    configuration_ = configuration;
    ungroup();
    append(robots);
  }

  void add(std::span<const Robot* const> robots, std::size_t first_new) override {
    drive_nothing();
    append(robots.subspan(first_new));
  }

  void keep(std::span<const Robot* const>, std::span<const std::size_t> indices) override {
    drive_nothing();
    std::vector<std::unique_ptr<Body>> kept;
    kept.reserve(indices.size());
    for (const std::size_t i : indices) kept.push_back(std::move(bodies_[i]));
    std::swap(bodies_, kept);
    for (const auto& body : bodies_) body->perturbations.clear();
    std::unordered_set<const Body*> gone;
    for (const auto& body : kept)
      if (body) gone.insert(body.get());
    if (gone.empty()) return;
    std::erase_if(loose_, [&](const Body* body) { return gone.contains(body); });
    std::ranges::copy(take_out(gone, batches_), std::back_inserter(loose_));
    if (batches_.empty()) ungroup();
  }

  BatchSettings settings() const override {
    BatchSettings now{.configuration = configuration_};
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const Body& body = *bodies_[i];
      now.materials.insert(now.materials.end(), body.materials.begin(), body.materials.end());
      now.materials.resize((i + 1) * max_materials);
      for (const DrivenMaterial& driven : body.drives.materials)
        now.materials[i * max_materials + driven.id] = driven.own;
      now.perturbations.insert(now.perturbations.end(), body.perturbations.begin(), body.perturbations.end());
    }
    return now;
  }

  void configure(const Configuration& configuration) override {
    configuration_ = configuration;
    for (const auto& body : bodies_) body->own.reset();
    choose_model();
    ungroup();
    for_each_body([&](std::size_t i) { update_spring_parameters(*bodies_[i], configuration_); });
  }

  // Bodies with an environment of their own step alone.
  void set_environments(std::span<const std::size_t> robots, std::span<const Environment> environments) override {
    bool regroups = false;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      Body& body = *bodies_[robots[i]];
      regroups = regroups || !body.own;
      body.own = OwnEnvironment{.environment = environments[i], .setting = {}};
      update_spring_parameters(body, configuration_);
    }
    if (regroups) ungroup();
    choose_model();
  }

  void step(const Clock& clock, std::int64_t steps) override {
    pool_.execute([&] { group_bodies(); });
    watch_ = {};
    const double start = wall_now();
    std::atomic<std::size_t> broken_up = 0;
    pool_.execute([&] {
      parallel_for(0, batches_.size(),
                   [&](std::size_t i) { broken_up += advance(kernel_, batches_[i], setting_, clock, steps); });
    });
    changes_since_grouping_ += broken_up;
    // New groups exclude the robots that have exploded. They are not worth it at each explosion.
    std::size_t groups = 0;
    for (const WorkBatch& batch : batches_) groups += batch.groups.size();
    if (16 * changes_since_grouping_ > groups) ungroup();
    busy_seconds_ += wall_now() - start;
  }

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    const Body& body = *bodies_[robot];
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = body.position(i);
    for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i] = body.velocity(i);
  }

  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    Body& body = *bodies_[robot];
    if (body.location.group) cpu::store(*body.location.group);
    set_state(body, positions, velocities);
  }

  void put_at_rest(std::span<const Robot* const> robots, std::size_t first, std::span<const float> lifts) override {
    for (std::size_t i = 0; i < lifts.size(); ++i) {
      Body& body = *bodies_[first + i];
      if (body.location.group) cpu::store(*body.location.group);
      set_status(first + i, {});
    }
    const auto set_down = [&](std::size_t i) {
      std::vector<Vec3> positions = robots[i]->masses;
      for (Vec3& x : positions) x += Vec3{0, 0, lifts[i]};
      set_state(*bodies_[first + i], positions, start_velocities(*robots[i]));
    };
    pool_.execute([&] { parallel_for(0, lifts.size(), set_down); });
  }

  void read_positions(std::span<Vec3> out) const override { read_all(out, &Body::position); }
  void read_velocities(std::span<Vec3> out) const override { read_all(out, &Body::velocity); }

  RobotStatus status(std::size_t robot) const override { return bodies_[robot]->status; }
  std::vector<RobotStatus> statuses() const override {
    std::vector<RobotStatus> all;
    for (const auto& body : bodies_) all.push_back(body->status);
    return all;
  }
  void set_status(std::size_t robot, const RobotStatus& status) override {
    RobotStatus& current = bodies_[robot]->status;
    if ((current.exploded_step < 0) != (status.exploded_step < 0)) ++changes_since_grouping_;
    current = status;
  }

  void write_materials(std::span<const Material> tables) override {
    for_each_body([&](std::size_t i) { replace_table(i, tables.subspan(i * max_materials, max_materials)); });
    materials_changed();
  }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    replace_table(robot, table);
    materials_changed();
  }
  bool set_actuation(const ActuationSources& sources) override {
    for_each_body([&](std::size_t i) { set_drives(*bodies_[i], sources, i); });
    materials_changed();
    return true;
  }

  void set_perturbations(std::span<const Perturbation> perturbations) override {
    for (const auto& body : bodies_) body->perturbations.clear();
    for (const Perturbation& perturbation : perturbations)
      bodies_[perturbation.robot]->perturbations.push_back(perturbation);
  }

  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    for_each_body([&](std::size_t i) {
      telemetry[i] = measure_state(kernel_, *bodies_[i], configuration_, clock);
      statuses[i] = bodies_[i]->status;
    });
  }

 private:
  template <class Work>
  void for_each_body(const Work& work) const {
    pool_.execute([&] { parallel_for(0, bodies_.size(), [&](std::size_t i) { work(i); }); });
  }

  void read_all(std::span<Vec3> out, Vec3 (Body::*value)(std::size_t) const) const {
    std::vector<std::size_t> first_mass{0};
    for (const auto& body : bodies_) first_mass.push_back(first_mass.back() + body->robot->masses.size());
    for_each_body([&](std::size_t i) {
      const Body& body = *bodies_[i];
      for (std::size_t mass = 0; mass < body.robot->masses.size(); ++mass)
        out[first_mass[i] + mass] = (body.*value)(mass);
    });
  }

  void append(std::span<const Robot* const> robots) {
    const Stopwatch stopwatch(load_times_.schedule);
    const std::size_t first = bodies_.size();
    bodies_.resize(first + robots.size());
    WorkCounter counter(watch_, "arranging robots", robots.size());
    const auto make = [&](std::size_t i) {
      const Robot& robot = *robots[i - first];
      bodies_[i] = std::make_unique<Body>(make_body(robot, kernel_.lanes));
      update_spring_parameters(*bodies_[i], configuration_);
      set_state(*bodies_[i], robot.masses, start_velocities(robot));
      counter.add_one();
    };
    pool_.execute([&] { parallel_for(first, bodies_.size(), make); });
    choose_model();
    if (batches_.empty()) return;
    for (std::size_t i = first; i < bodies_.size(); ++i) loose_.push_back(bodies_[i].get());
  }

  // Puts all bodies into work batches. Bodies that come later get batches of their own. When they have become a quarter
  // of all since the last time, everything is grouped again: with the new bodies there may be better groups.
  void group_bodies() {
    const Stopwatch stopwatch(load_times_.schedule);
    loosened_since_grouping_ += loose_.size();
    if (4 * loosened_since_grouping_ > bodies_.size()) ungroup();
    const auto threads = pool_.threads();
    if (batches_.empty()) {
      std::vector<Body*> all;
      for (const auto& body : bodies_) all.push_back(body.get());
      batches_ = make_work_batches(all, threads, configuration_, watch_);
    } else if (!loose_.empty()) {
      std::ranges::move(make_work_batches(loose_, 1, configuration_), std::back_inserter(batches_));
    }
    loose_.clear();
  }

  // Brings all states back to the bodies. The next step makes new batches.
  void ungroup() {
    cpu::store(batches_);
    batches_.clear();
    loose_.clear();
    loosened_since_grouping_ = changes_since_grouping_ = 0;
  }

  void drive_nothing() {
    bool driven = false;
    for (const auto& body : bodies_) {
      driven = driven || !body->drives.materials.empty();
      remove_drives(*body);
    }
    if (driven) materials_changed();
  }

  void choose_model() {
    const bool real_bodies =
        std::ranges::any_of(bodies_, [](const auto& body) { return body->viscous || has_own_points(*body->robot); });
    setting_ = setting_of(configuration_, real_bodies);
    for (const auto& body : bodies_)
      if (body->own) body->own->setting = setting_of(configuration_of(*body, configuration_), real_bodies);
  }

  void materials_changed() {
    choose_model();
    for (WorkBatch& batch : batches_) batch.spring_parameters_are_stale = true;
  }

  void replace_table(std::size_t robot, std::span<const Material> table) {
    set_materials(*bodies_[robot], table);
    update_spring_parameters(*bodies_[robot], configuration_);
  }

  const Kernel kernel_;
  WorkWatch watch_;  // until the first step
  ThreadPool pool_;
  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<WorkBatch> batches_;           // empty = all are to be made before the next step
  std::vector<Body*> loose_;                 // in no batch, if there are batches
  std::size_t loosened_since_grouping_ = 0;  // bodies that came, or whose groups broke up when others went
  std::size_t changes_since_grouping_ = 0;   // groups broken up, exploded robots set by the caller
  Configuration configuration_;
  StepSetting setting_;
  double busy_seconds_ = 0;
  LoadTimes load_times_;
};

}  // namespace

std::unique_ptr<Backend> make_cpu_backend(const Device& device) {
  if (cpu::kernels().empty())
    throw DeviceError("the CPU lacks SSSE3 instructions, which x86 processors have since 2011");
  return cpu::make_backend(device, cpu::kernels().front());
}

std::unique_ptr<Backend> cpu::make_backend(const Device& device, const Kernel& kernel) {
  require_possible_threads(device);
  return std::make_unique<CpuBackend>(device, kernel);
}

}  // namespace mercury
