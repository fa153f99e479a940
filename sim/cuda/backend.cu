// SPDX-License-Identifier: Apache-2.0
// The CUDA backend.
#include "mercury/backend.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mercury/cuda_devices.h"
#include "sim/cuda/batch.h"
#include "sim/cuda/block.cuh"
#include "sim/cuda/step.h"

namespace mercury {
namespace {

using namespace cuda;

// A launch stays short enough for a display to be served by the same GPU.
constexpr std::int64_t most_steps_a_launch = 2000;

class CudaBackend final : public Backend {
 public:
  explicit CudaBackend(const Device& device) : device_(device.index) {
    const int count = cuda_device_count();
    if (count == 0) throw DeviceError("no CUDA device was found: use --device cpu");
    if (device_ >= count)
      throw DeviceError("CUDA device " + std::to_string(device_) + " is not there, the last one is " +
                        std::to_string(count - 1));
    use_device();
    name_ = cuda_device_name(device_);
  }

  std::string device_name() const override { return name_; }

  std::vector<std::string> notes() const override {
    if (batch_.size() == 0 || shape_.on_chip) return {};
    return {"the largest robot does not fit on the chip of " + name_ + ": it is stepped in device memory, more slowly"};
  }

  std::size_t robots_at_once() const override {
    use_device();
    return batch_.size() == 0 ? 0 : robots_in_flight(configuration_.solver, model_, shape_);
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
    configure(configuration);
  }

  void configure(const Configuration& configuration) override {
    begin_change();
    configuration_ = configuration;
    batch_.configure(configuration);
    model_ =
        std::visit([](const auto& kind) { return AnyEnvironmentModel(model_of(kind)); }, configuration.environment);
    constants_ = {static_cast<float>(configuration.dt), static_cast<float>(1 / configuration.dt),
                  static_cast<float>(std::exp(-configuration.damping * configuration.dt))};
    choose();
  }

  void step(const Clock& clock, std::int64_t steps) override {
    if (batch_.size() == 0) return;
    use_device();
    StepArguments arguments = prepare(clock);
    // Who asked for a report after the last call will ask again.
    DeviceTelemetry* const report = std::exchange(report_expected_, false) ? reports_on_device() : nullptr;
    report_made_ = false;
    Event start, end;
    start.record();
    for (std::int64_t done = 0; done < steps; done += arguments.steps) {
      arguments.clock.step = clock.step + done;
      arguments.steps = static_cast<std::uint32_t>(std::min(steps - done, most_steps_a_launch));
      arguments.report = done + arguments.steps == steps ? report : nullptr;
      launch_steps(configuration_.solver, model_, arguments, nullptr);
    }
    end.record();
    busy_seconds_ += end.seconds_since(start);
    report_made_ = report != nullptr && steps > 0;
  }

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    use_device();
    batch_.read(robot, positions, velocities);
  }

  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    begin_change();
    batch_.write(robot, positions, velocities);
  }

  void read_positions(std::span<Vec3> out) const override { gather(out, 0); }
  void read_velocities(std::span<Vec3> out) const override { gather(out, 3); }
  int cuda_device() const override { return device_; }
  void copy_positions(float* device_out) const override {
    use_device();
    batch_.gather(device_out, 0);
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
    choose();
  }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    begin_change();
    batch_.set_materials(robot, table, configuration_);
    choose();
  }

  void set_perturbations(std::span<const Perturbation> perturbations) override {
    use_device();
    batch_.set_perturbations(perturbations);
  }

  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    if (telemetry.empty()) return;
    use_device();
    report_expected_ = true;
    if (!report_made_) {
      StepArguments arguments = prepare(clock);
      arguments.report = reports_on_device();
      launch_steps(configuration_.solver, model_, arguments, nullptr);
      check(cudaDeviceSynchronize(), "reading telemetry");
      report_made_ = true;
    }
    for (std::size_t i = 0; i < telemetry.size(); ++i) {
      const DeviceTelemetry& device = reports_[i];
      Telemetry& told = telemetry[i];  // field by field: a whole one would be built beside it, and copied
      told.center_of_mass = device.center_of_mass;
      told.velocity = device.velocity;
      told.kinetic_energy = device.kinetic_energy;
      told.elastic_energy = device.elastic_energy;
      told.largest_strain = device.largest_strain;
      statuses[i] = {device.exploded_step, device.bad_mass};
    }
  }

 private:
  void use_device() const { check(cudaSetDevice(device_), "choosing the device"); }

  void choose() {
    if (batch_.size() == 0) return;
    shape_ = choose_shape(configuration_.solver, configuration_.environment, batch_.view(), batch_.same_materials());
    const std::uint32_t rows = working_rows(configuration_.solver, shape_.splits_on_chip);
    batch_.place_records(shape_.on_chip ? rows : 0);
    std::size_t workspace = 0;
    if (!shape_.on_chip) workspace += std::size_t{batch_.groups()} * rows * row_bytes;
    if (!shape_.contacts_on_chip) workspace += contact_bytes(shape_.contact_buckets, batch_.groups());
    batch_.reserve_workspace(workspace);
  }

  void gather(std::span<Vec3> out, std::uint32_t first_row) const {
    if (out.empty()) return;
    use_device();
    if (packed_.size() != 3 * out.size()) packed_ = DeviceArray<float>(3 * out.size());
    batch_.gather(packed_.data(), first_row);
    static_assert(sizeof(Vec3) == 3 * sizeof(float));
    packed_.read(0, std::span(&out.front().x, 3 * out.size()));
  }

  // What the caller changes makes a report that was made before void.
  void begin_change() {
    use_device();
    report_made_ = false;
  }

  // No steps yet, from the clock on.
  StepArguments prepare(const Clock& clock) const {
    batch_.update_phases(clock);
    StepArguments arguments{batch_.view(), clock, constants_, stiffness_scale_of(configuration_.environment), 0, 0,
                            shape_};
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
  mutable Batch batch_;                           // its phases follow the clock when somebody asks
  mutable MappedArray<DeviceTelemetry> reports_;  // of the present state, once made
  mutable bool report_made_ = false, report_expected_ = false;
  mutable DeviceArray<float> packed_;  // what is read of all masses
  Configuration configuration_;
  AnyEnvironmentModel model_ = OceanModel(Ocean{});
  StepConstants constants_;
  Shape shape_;
  double busy_seconds_ = 0;
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend(const Device& device) { return std::make_unique<CudaBackend>(device); }

ChipFit chip_fit(const Robot& robot, const Configuration& configuration, int device) {
  if (device < 0 || device >= cuda_device_count())
    throw DeviceError("CUDA device " + std::to_string(device) + " is not there");
  check(cudaSetDevice(device), "choosing the device");
  constexpr std::uint32_t many = 1u << 20;  // robots
  BatchView batch{};
  batch.robot_count = many;
  batch.group_stride = groups_of(robot);
  batch.record_words = lengths_of(robot).size() <= max_lengths ? 1 : 2;
  const Shape shape = choose_shape(configuration.solver, configuration.environment, batch, true);
  const AnyEnvironmentModel model =
      std::visit([](const auto& kind) { return AnyEnvironmentModel(model_of(kind)); }, configuration.environment);
  return {most_shared_bytes(), shape.on_chip, shape.on_chip && shape.contacts_on_chip,
          robots_in_flight(configuration.solver, model, shape)};
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
  check(cudaGetDeviceProperties(&properties, index), "asking for a device's name");
  return properties.name;
}

bool built_with_cuda() { return true; }

}  // namespace mercury
