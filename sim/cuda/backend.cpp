// SPDX-License-Identifier: Apache-2.0
// The CUDA backend.
#include "mercury/backend.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "mercury/cuda_devices.h"
#include "sim/cuda/device_limits.h"
#include "sim/cuda/intake.h"
#include "sim/cuda/step.h"

namespace mercury {
namespace {

using namespace cuda;

// Keeps launches so short that the same GPU can serve a display.
constexpr std::int64_t max_steps_per_launch = 2000;

// Reports that step_and_report() makes before it reads them.
constexpr std::size_t most_reports = std::size_t{1} << 19;

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
    owned_ = std::make_unique<Owned>();
  }
  ~CudaBackend() override {
    cudaSetDevice(device_);
    owned_.reset();
  }

  std::string device_name() const override { return name_; }

  std::vector<std::string> notes() const override {
    const auto on_chip = [](const auto& robots) { return robots->size() == 0 || robots->launch().on_chip; };
    if (std::ranges::all_of(classes(), on_chip)) return {};
    return {"the largest robot does not fit on the chip of " + name_ + ": it is stepped in device memory, more slowly"};
  }

  // The classes share the device: their robots take turns in proportion to their numbers.
  std::size_t robots_at_once() const override {
    use_device();
    double rounds = 0;
    for (const auto& robots : classes())
      if (robots->size() > 0)
        rounds +=
            static_cast<double>(robots->size()) / robots_in_flight(configuration_.solver, model_, robots->launch());
    return rounds > 0 ? static_cast<std::size_t>(std::llround(static_cast<double>(places_.size()) / rounds)) : 0;
  }
  double spring_limit() const override {
    use_device();
    return cuda::spring_limit(configuration_.solver);
  }
  double busy_seconds() const override { return busy_seconds_; }
  LoadTimes load_times() const override { return load_times_; }

  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    begin_change();
    places_.clear();
    owned_->classes = {};
    configure(configuration);
    add(robots, 0);
  }

  void add(std::span<const Robot* const> robots, std::size_t first_new) override {
    begin_change();
    const std::vector<Place> places =
        add_robots(owned_->classes, robots.subspan(first_new), configuration_, load_times_);
    places_.insert(places_.end(), places.begin(), places.end());
    number_masses(robots);
    choose_launches();
  }

  void keep(std::span<const Robot* const> robots, std::span<const std::size_t> indices) override {
    begin_change();
    set_perturbations({});
    std::vector<std::vector<bool>> kept;
    for (const auto& each : classes()) kept.emplace_back(each->size(), false);
    for (const std::size_t i : indices) kept[places_[i].size_class][places_[i].number] = true;
    std::vector<std::vector<std::uint32_t>> new_places;
    for (std::size_t c = 0; c < kept.size(); ++c) new_places.push_back(owned_->classes[c].compact(kept[c]));
    std::vector<Place> places;
    for (const std::size_t i : indices)
      places.push_back({places_[i].size_class, new_places[places_[i].size_class][places_[i].number]});
    places_ = std::move(places);
    if (!places_.empty()) owned_->classes.free_empty();  // an empty batch is about to be filled again
    number_masses(robots);
    choose_launches();
  }

  void configure(const Configuration& configuration) override {
    begin_change();
    configuration_ = configuration;
    model_ = solver_model_of(configuration.environment);
    constants_ = {static_cast<float>(configuration.dt), static_cast<float>(1 / configuration.dt),
                  static_cast<float>(std::exp(-configuration.damping * configuration.dt))};
    for (const auto& robots : classes()) robots->configure(configuration);
    choose_launches();
  }

  void step(const Clock& clock, std::int64_t steps) override {
    if (places_.empty()) return;
    use_device();
    // The caller that requested a report after the last call is expected to request it again.
    DeviceTelemetry* const report = std::exchange(report_expected_, false) ? reports_on_device() : nullptr;
    report_valid_ = false;
    begin_launches(clock);
    launch(clock, steps, report);
    end_launches(owned_->end);
    report_valid_ = report != nullptr && steps > 0;
  }

  // The launches of all portions follow one another in the streams of their classes, without a pause. (A kernel that
  // reports on the way was 1 to 6 % slower.)
  void step_and_report(const Clock& clock, std::int64_t steps, std::int64_t every, std::span<Telemetry> samples,
                       std::span<RobotStatus> statuses) override {
    if (places_.empty()) return;
    use_device();
    report_valid_ = false;
    const std::size_t robots = places_.size(), most = std::max(std::size_t{1}, most_reports / robots);
    const auto all = static_cast<std::size_t>(steps / every);
    DeviceArray<DeviceTelemetry>& on_device = owned_->samples;
    const std::size_t largest = std::min(most, all) * robots;
    if (on_device.size() < largest) on_device = DeviceArray<DeviceTelemetry>(largest);
    const auto reports = std::make_unique_for_overwrite<DeviceTelemetry[]>(largest);
    Clock now = clock;
    for (std::size_t first = 0; first < all; first += most) {
      const std::size_t count = std::min(most, all - first);
      begin_launches(now);
      for (std::size_t k = 0; k < count; ++k, now.step += every) launch(now, every, on_device.data() + k * robots);
      end_launches(owned_->sleepy_end);
      on_device.read(0, std::span(reports.get(), count * robots), main().get());
      oneapi::tbb::parallel_for(std::size_t{0}, count, [&](std::size_t k) {
        const std::size_t at = (first + k) * robots;
        copy_reports([&](std::size_t i) -> const DeviceTelemetry& { return reports[k * robots + i]; },
                     samples.subspan(at, robots), statuses.subspan(at, robots));
      });
    }
  }

  void read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const override {
    use_device();
    class_of(robot).read(places_[robot].number, positions, velocities);
  }
  void write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) override {
    begin_change();
    class_of(robot).write(places_[robot].number, positions, velocities);
  }

  // A run of consecutive places at a time.
  void put_at_rest(std::span<const Robot* const> robots, std::size_t first, std::span<const float> lifts) override {
    begin_change();
    std::vector<std::size_t> order(lifts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto place = [&](std::size_t k) { return places_[first + order[k]]; };
    std::ranges::sort(
        order, {}, [&](std::size_t i) { return std::pair(places_[first + i].size_class, places_[first + i].number); });
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      std::vector<const Robot*> run;
      std::vector<float> run_lifts;
      for (end = begin; end < order.size() && place(end).size_class == place(begin).size_class &&
                        place(end).number == place(begin).number + (end - begin);
           ++end) {
        run.push_back(robots[order[end]]);
        run_lifts.push_back(lifts[order[end]]);
      }
      owned_->classes[place(begin).size_class].put_at_rest(place(begin).number, run, run_lifts);
    }
  }

  void read_positions(std::span<Vec3> out) const override {
    use_device();
    for (const auto& robots : classes()) robots->read_all(field_x, out);
  }
  void read_velocities(std::span<Vec3> out) const override {
    use_device();
    for (const auto& robots : classes()) robots->read_all(field_v, out);
  }
  int cuda_device() const override { return device_; }
  void copy_positions(float* device_out) const override {
    use_device();
    for (const auto& robots : classes())
      if (robots->size() > 0) robots->gather(device_out, field_x, cudaStreamLegacy);
    owned_->gathered.record(cudaStreamLegacy);
    gather_pending_ = true;
  }

  RobotStatus status(std::size_t robot) const override {
    use_device();
    return status_of(class_of(robot).status(places_[robot].number));
  }
  std::vector<RobotStatus> statuses() const override {
    use_device();
    std::vector<std::vector<DeviceStatus>> of_class;
    for (const auto& robots : classes()) of_class.push_back(robots->statuses());
    std::vector<RobotStatus> all;
    for (const Place place : places_) all.push_back(status_of(of_class[place.size_class][place.number]));
    return all;
  }
  void set_status(std::size_t robot, const RobotStatus& status) override {
    begin_change();
    class_of(robot).set_status(places_[robot].number, {status.exploded_step, status.bad_mass});
  }

  void write_materials(std::span<const Material> tables) override {
    begin_change();
    for (std::size_t i = 0; i < places_.size(); ++i)
      std::ranges::copy(tables.subspan(i * max_materials, max_materials), class_of(i).table(places_[i].number).begin());
    for (const auto& robots : classes()) robots->publish_all_materials(configuration_);
    choose_launches();
  }
  void write_materials(std::size_t robot, std::span<const Material> table) override {
    begin_change();
    std::ranges::copy(table, class_of(robot).table(places_[robot].number).begin());
    class_of(robot).publish_materials(places_[robot].number, configuration_);
    choose_launches();
  }

  void set_perturbations(std::span<const Perturbation> perturbations) override {
    use_device();
    std::vector<std::vector<DevicePerturbation>> of_class(owned_->classes.size());
    for (const Perturbation& perturbation : perturbations) {
      const Place place = places_[perturbation.robot];
      of_class[place.size_class].push_back(
          {place.number, class_of(perturbation.robot).order_of(place.number).slot_of(perturbation.mass),
           perturbation.target, perturbation.stiffness});
    }
    for (std::size_t c = 0; c < of_class.size(); ++c) owned_->classes[c].set_perturbations(of_class[c]);
  }

  void report(const Clock& clock, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const override {
    if (telemetry.empty()) return;
    use_device();
    report_expected_ = true;
    if (!report_valid_) {
      begin_launches(clock);
      launch(clock, 0, reports_on_device());
      join_launches();
      main().synchronize();
      report_valid_ = true;
    }
    copy_reports([&](std::size_t i) -> const DeviceTelemetry& { return owned_->reports[i]; }, telemetry, statuses);
  }

 private:
  // What must be released while the device is the present one.
  struct Owned {
    SizeClasses classes;
    Event start, end, sleepy_end{true}, gathered;
    MappedArray<DeviceTelemetry> reports;  // of the present state if report_valid_
    DeviceArray<DeviceTelemetry> samples;  // of step_and_report()
  };

  const SizeClasses& classes() const { return owned_->classes; }
  // The stream of the largest robots. Those of the other classes start after it, and it ends after them.
  const Stream& main() const { return owned_->classes[launch_order_.front()].stream(); }
  SizeClass& class_of(std::size_t robot) const { return owned_->classes[places_[robot].size_class]; }
  static RobotStatus status_of(const DeviceStatus& status) { return {status.exploded_step, status.bad_mass}; }

  void use_device() const { check(cudaSetDevice(device_), "choosing the device"); }

  void choose_launches() {
    for (const auto& robots : classes())
      if (robots->size() > 0) robots->choose_launch(configuration_, places_.size());
    // Reports of the classes follow one another.
    first_report_.assign(1, 0);
    for (const auto& robots : classes()) first_report_.push_back(first_report_.back() + robots->size());
    launch_order_.resize(owned_->classes.size());
    std::iota(launch_order_.begin(), launch_order_.end(), 0u);
    std::ranges::sort(launch_order_, std::greater{}, [&](std::uint32_t c) { return owned_->classes[c].sizes().tiles; });
    std::erase_if(launch_order_, [&](std::uint32_t c) { return owned_->classes[c].size() == 0; });
  }

  void number_masses(std::span<const Robot* const> robots) {
    std::vector<std::vector<std::uint64_t>> first_masses;
    for (const auto& each : classes()) first_masses.emplace_back(each->size());
    std::uint64_t masses = 0;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      first_masses[places_[i].size_class][places_[i].number] = masses;
      masses += robots[i]->masses.size();
    }
    for (std::size_t c = 0; c < first_masses.size(); ++c)
      owned_->classes[c].set_first_masses(std::move(first_masses[c]));
  }

  // To be called before every change by the caller: it invalidates the last report.
  void begin_change() {
    use_device();
    if (std::exchange(gather_pending_, false)) owned_->gathered.synchronize();
    report_valid_ = false;
  }

  // Makes the streams of all classes wait for what is under way, and marks the start.
  void begin_launches(const Clock& clock) const {
    if (std::exchange(gather_pending_, false)) main().wait_for(owned_->gathered);
    owned_->start.record(main().get());
    for (const std::uint32_t c : launch_order_) {
      SizeClass& robots = owned_->classes[c];
      if (c != launch_order_.front()) robots.stream().wait_for(owned_->start);
      robots.update_phases(clock);
    }
  }

  // Queues launches of all classes. `report` = null or one element per robot, for after the last step.
  void launch(const Clock& clock, std::int64_t steps, DeviceTelemetry* report) const {
    for (const std::uint32_t c : launch_order_) {
      const SizeClass& robots = owned_->classes[c];
      StepArguments arguments{robots.view(),  clock, constants_, stiffness_scale_of(configuration_.environment), 0, 0,
                              robots.launch()};
      if (const Land* land = std::get_if<Land>(&configuration_.environment))
        arguments.contact_stiffness = contact_stiffness_of(*land, configuration_.solver, configuration_.dt);
      std::int64_t done = 0;
      do {
        arguments.clock.step = clock.step + done;
        arguments.steps = static_cast<std::uint32_t>(std::min(steps - done, max_steps_per_launch));
        done += arguments.steps;
        arguments.report = done == steps && report ? report + first_report_[c] : nullptr;
        launch_steps(configuration_.solver, model_, arguments, robots.stream().get());
      } while (done < steps);
    }
  }

  void join_launches() const {
    for (const std::uint32_t c : std::span(launch_order_).subspan(1)) {
      const SizeClass& robots = owned_->classes[c];
      robots.done().record(robots.stream().get());
      main().wait_for(robots.done());
    }
  }

  void end_launches(Event& end) {
    join_launches();
    end.record(main().get());
    busy_seconds_ += end.seconds_since(owned_->start);
  }

  DeviceTelemetry* reports_on_device() const {
    if (owned_->reports.size() != places_.size()) owned_->reports = MappedArray<DeviceTelemetry>(places_.size());
    return owned_->reports.on_device();
  }

  // `report_at(k)` = the k-th report, in the order of classes and places.
  template <class ReportAt>
  void copy_reports(const ReportAt& report_at, std::span<Telemetry> telemetry, std::span<RobotStatus> statuses) const {
    for (std::size_t i = 0; i < telemetry.size(); ++i) {
      const DeviceTelemetry& from = report_at(first_report_[places_[i].size_class] + places_[i].number);
      Telemetry& to = telemetry[i];  // field by field, which avoids building a Telemetry and copying it
      to.center_of_mass = from.center_of_mass;
      to.velocity = from.velocity;
      to.kinetic_energy = from.kinetic_energy;
      to.elastic_energy = from.elastic_energy;
      to.muscle_power = static_cast<double>(from.muscle_power);
      to.largest_strain = from.largest_strain;
      to.strained_share = from.strained_share;
      statuses[i] = {from.exploded_step, from.bad_mass};
    }
  }

  int device_;
  std::string name_;
  std::unique_ptr<Owned> owned_;
  std::vector<Place> places_;                // [robot]
  std::vector<std::size_t> first_report_;    // [class]
  std::vector<std::uint32_t> launch_order_;  // classes that have robots, the largest robots first
  mutable bool report_valid_ = false, report_expected_ = false;
  mutable bool gather_pending_ = false;  // copy_positions() may still read
  Configuration configuration_;
  AnyEnvironmentModel model_ = OceanModel(Ocean{});
  StepConstants constants_;
  double busy_seconds_ = 0;
  LoadTimes load_times_;
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend(const Device& device) { return std::make_unique<CudaBackend>(device); }

}  // namespace mercury
