// SPDX-License-Identifier: Apache-2.0
// The CUDA backend.
#include "mercury/backend.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mercury/cuda_devices.h"
#include "sim/cuda/batch.h"
#include "sim/cuda/block_layout.h"
#include "sim/cuda/device_limits.h"
#include "sim/cuda/step.h"

namespace mercury {
namespace {

using namespace cuda;

// Keeps launches so short that the same GPU can serve a display.
constexpr std::int64_t max_steps_per_launch = 2000;

class CudaBackend final : public Backend {
 public:
  explicit CudaBackend(const Device& device) : device_(device.index) {
    const int count = cuda_device_count();
    if (count == 0) throw DeviceError("no CUDA device was found; use the device \"cpu\"");
    if (device_ >= count)
      throw DeviceError("CUDA device " + std::to_string(device_) + " is not there, the last one is " +
                        std::to_string(count - 1));
    use_device();
    name_ = cuda_device_name(device_);
  }

  std::string device_name() const override { return name_; }

  std::vector<std::string> notes() const override {
    if (batch_.size() == 0 || launch_.on_chip) return {};
    return {"the largest robot does not fit on the chip of " + name_ + ": it is stepped in device memory, more slowly"};
  }

  std::size_t robots_at_once() const override {
    use_device();
    return batch_.size() == 0 ? 0 : robots_in_flight(configuration_.solver, model_, launch_);
  }
  double spring_limit() const override {
    use_device();
    return cuda::spring_limit(configuration_.solver);
  }
  double busy_seconds() const override { return busy_seconds_; }

  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    begin_change();
    batch_ = Batch();
    batch_ = Batch(robots);
    perturbations_.clear();
    configure(configuration);
  }

  BatchSettings settings() const override {
    const std::span<const Material> tables = batch_.materials();
    return {configuration_, {tables.begin(), tables.end()}, perturbations_};
  }

  void configure(const Configuration& configuration) override {
    begin_change();
    configuration_ = configuration;
    batch_.configure(configuration);
    model_ = solver_model_of(configuration.environment);
    constants_ = {static_cast<float>(configuration.dt), static_cast<float>(1 / configuration.dt),
                  static_cast<float>(std::exp(-configuration.damping * configuration.dt))};
    choose_launch();
  }

  void step(const Clock& clock, std::int64_t steps) override {
    if (batch_.size() == 0) return;
    use_device();
    StepArguments arguments = prepare(clock);
    // The caller that requested a report after the last call is expected to request it again.
    DeviceTelemetry* const report = std::exchange(report_expected_, false) ? reports_on_device() : nullptr;
    report_valid_ = false;
    Event start, end;
    start.record();
    for (std::int64_t done = 0; done < steps; done += arguments.steps) {
      arguments.clock.step = clock.step + done;
      arguments.steps = static_cast<std::uint32_t>(std::min(steps - done, max_steps_per_launch));
      arguments.report = done + arguments.steps == steps ? report : nullptr;
      launch_steps(configuration_.solver, model_, arguments, nullptr);
    }
    end.record();
    busy_seconds_ += end.seconds_since(start);
    report_valid_ = report != nullptr && steps > 0;
  }

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    use_device();
    batch_.read(robot, positions, velocities);
  }

  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    begin_change();
    batch_.write(robot, positions, velocities);
  }

  void read_positions(std::span<Vec3> out) const override { gather(out, field_x); }
  void read_velocities(std::span<Vec3> out) const override { gather(out, field_v); }
  int cuda_device() const override { return device_; }
  void copy_positions(float* device_out) const override {
    use_device();
    batch_.gather(device_out, field_x);
  }

  RobotStatus status(std::size_t robot) const override {
    use_device();
    const DeviceStatus status = batch_.status(robot);
    return {status.exploded_step, status.bad_mass};
  }
  std::vector<RobotStatus> statuses() const override {
    use_device();
    std::vector<RobotStatus> all;
    for (const DeviceStatus& status : batch_.statuses()) all.push_back({status.exploded_step, status.bad_mass});
    return all;
  }
  void set_status(std::size_t robot, const RobotStatus& status) override {
    begin_change();
    batch_.set_status(robot, {status.exploded_step, status.bad_mass});
  }

  void write_materials(std::span<const Material> tables) override {
    begin_change();
    batch_.set_materials(0, tables, configuration_);
    choose_launch();
  }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    begin_change();
    batch_.set_materials(robot, table, configuration_);
    choose_launch();
  }

  void set_perturbations(std::span<const Perturbation> perturbations) override {
    use_device();
    batch_.set_perturbations(perturbations);
    perturbations_.assign(perturbations.begin(), perturbations.end());
  }

  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    if (telemetry.empty()) return;
    use_device();
    report_expected_ = true;
    if (!report_valid_) {
      StepArguments arguments = prepare(clock);
      arguments.report = reports_on_device();
      launch_steps(configuration_.solver, model_, arguments, nullptr);
      check(cudaDeviceSynchronize(), "reading telemetry");
      report_valid_ = true;
    }
    for (std::size_t i = 0; i < telemetry.size(); ++i) {
      const DeviceTelemetry& from = reports_[i];
      Telemetry& to = telemetry[i];  // field by field, which avoids building a Telemetry and copying it
      to.center_of_mass = from.center_of_mass;
      to.velocity = from.velocity;
      to.kinetic_energy = from.kinetic_energy;
      to.elastic_energy = from.elastic_energy;
      to.largest_strain = from.largest_strain;
      statuses[i] = {from.exploded_step, from.bad_mass};
    }
  }

 private:
  void use_device() const { check(cudaSetDevice(device_), "choosing the device"); }

  void choose_launch() {
    if (batch_.size() == 0) return;
    launch_ = choose_launch_configuration(configuration_.solver, configuration_.environment, batch_.view(),
                                          batch_.same_materials());
    const std::uint32_t fields = working_fields(configuration_.solver, launch_.valence_on_chip);
    batch_.address_partners(launch_.on_chip ? fields : 0);
    std::size_t workspace = 0;
    if (!launch_.on_chip) workspace += std::size_t{batch_.tiles()} * fields * field_bytes;
    if (!launch_.contacts_on_chip) workspace += contact_bytes(launch_.contact_buckets, batch_.tiles());
    batch_.reserve_workspace(workspace);
  }

  void gather(std::span<Vec3> out, Field first_field) const {
    if (out.empty()) return;
    use_device();
    if (packed_.size() != 3 * out.size()) packed_ = DeviceArray<float>(3 * out.size());
    batch_.gather(packed_.data(), first_field);
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    packed_.read(0, std::span(&out.front().x, 3 * out.size()));
  }

  // To be called before every change by the caller: it invalidates the last report.
  void begin_change() {
    use_device();
    report_valid_ = false;
  }

  // Arguments of a launch at this clock, with 0 steps.
  StepArguments prepare(const Clock& clock) const {
    batch_.update_phases(clock);
    StepArguments arguments{batch_.view(), clock, constants_, stiffness_scale_of(configuration_.environment), 0, 0,
                            launch_};
    if (const Land* land = std::get_if<Land>(&configuration_.environment))
      arguments.contact_stiffness = contact_stiffness_of(*land, configuration_.solver, configuration_.dt);
    return arguments;
  }

  DeviceTelemetry* reports_on_device() const {
    if (reports_.size() != batch_.size()) reports_ = MappedArray<DeviceTelemetry>(batch_.size());
    return reports_.on_device();
  }

  int device_;
  std::string name_;
  mutable Batch batch_;                           // prepare() updates its phases
  mutable MappedArray<DeviceTelemetry> reports_;  // [robot], of the present state if report_valid_
  mutable bool report_valid_ = false, report_expected_ = false;
  mutable DeviceArray<float> packed_;  // vectors of all masses, on their way to the host
  std::vector<Perturbation> perturbations_;
  Configuration configuration_;
  AnyEnvironmentModel model_ = OceanModel(Ocean{});
  StepConstants constants_;
  LaunchConfiguration launch_;
  double busy_seconds_ = 0;
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend(const Device& device) { return std::make_unique<CudaBackend>(device); }

ChipFit chip_fit(const Robot& robot, const Configuration& configuration, int device) {
  if (device < 0 || device >= cuda_device_count())
    throw DeviceError("CUDA device " + std::to_string(device) + " is not there");
  check(cudaSetDevice(device), "choosing the device");
  constexpr std::uint32_t many_robots = 1u << 20;
  BatchView batch{};
  batch.robot_count = many_robots;
  batch.tile_stride = tiles_for(robot.masses.size());
  batch.record_words = lengths_of(robot).size() <= max_lengths ? 1 : 2;
  const LaunchConfiguration launch =
      choose_launch_configuration(configuration.solver, configuration.environment, batch, true);
  const AnyEnvironmentModel model = solver_model_of(configuration.environment);
  return {device_limits().shared_per_block, launch.on_chip, launch.on_chip && launch.contacts_on_chip,
          robots_in_flight(configuration.solver, model, launch)};
}

int cuda_device_count() {
  int count = 0;
  if (cudaGetDeviceCount(&count) != cudaSuccess) {
    (void)cudaGetLastError();
    return 0;
  }
  return count;
}

std::string cuda_device_name(int index) {
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, index), "querying a device's name");
  return properties.name;
}

std::size_t free_cuda_memory(int index) {
  check(cudaSetDevice(index), "choosing the device");
  std::size_t free = 0, total = 0;
  check(cudaMemGetInfo(&free, &total), "asking for free memory");
  return free;
}

bool built_with_cuda() { return true; }

}  // namespace mercury
