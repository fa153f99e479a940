// SPDX-License-Identifier: Apache-2.0
// Robots and settings of the CUDA backend.
#include "sim/cuda/backend.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "mercury/cuda_devices.h"
#include "mercury/folding.h"
#include "mercury/parallel.h"
#include "sim/cuda/device_limits.h"

namespace mercury {
namespace cuda {

CudaBackend::CudaBackend(const Device& device, std::shared_ptr<ArrangedRobots> arranged)
    : device_(device.index), arranged_(std::move(arranged)) {
  require_cuda_device(device_);
  use_device();
  memory_ = std::async(std::launch::async, [this] {
    use_device();
    set_up_memory();
  });
  name_ = cuda_device_name(device_);
  owned_ = std::make_unique<Owned>();
}

CudaBackend::~CudaBackend() {
  cudaSetDevice(device_);
  if (queued_) cudaEventSynchronize(owned_->queued.get());
  owned_.reset();
}

std::vector<std::string> CudaBackend::notes() const {
  const auto on_chip = [](const auto& robots) {
    return robots->size() == 0 || robots->launch().on_chip || robots->launch_in_parts();
  };
  if (std::ranges::all_of(classes(), on_chip)) return {};
  return {"the largest robot does not fit on the chip of " + name_ + ": it is stepped in device memory, more slowly"};
}

// The classes share the device: their robots take turns in proportion to their numbers.
std::size_t CudaBackend::robots_at_once() const {
  use_device();
  double rounds = 0;
  for (const auto& robots : classes())
    if (robots->size() > 0)
      rounds += static_cast<double>(robots->size()) /
                (robots->launch_in_parts()
                     ? robots_in_flight(configuration_.solver, model_in_parts(*robots), *robots->launch_in_parts())
                     : robots_in_flight(configuration_.solver, model_for(*robots), robots->launch_of_many()));
  return rounds > 0 ? static_cast<std::size_t>(std::llround(static_cast<double>(places_.size()) / rounds)) : 0;
}

double CudaBackend::spring_limit() const {
  use_device();
  return cuda::spring_limit(configuration_.solver);
}

void CudaBackend::load(std::span<const Robot* const> robots, const Configuration& configuration) {
  begin_exchange();
  places_.clear();
  owned_->classes = {};
  configure(configuration);
  add(robots, 0);
  watch_ = {};
}

void CudaBackend::add(std::span<const Robot* const> robots, std::size_t first_new) {
  begin_exchange();
  const std::vector<Place> places =
      add_robots(owned_->classes, robots.subspan(first_new), configuration_, arranged_.get(), load_times_, watch_);
  places_.insert(places_.end(), places.begin(), places.end());
  number_masses(robots);
  choose_launches();
}

void CudaBackend::keep(std::span<const Robot* const> robots, std::span<const std::size_t> indices) {
  begin_exchange();
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

void CudaBackend::configure(const Configuration& configuration) {
  begin_change();
  rest_valid_ = false;
  configuration_ = configuration;
  constants_ = step_constants(configuration);
  for (const auto& robots : classes()) {
    robots->share_environment();
    robots->configure(configuration);
  }
  choose_launches();
}

void CudaBackend::set_environments(std::span<const std::size_t> robots, std::span<const Environment> environments) {
  begin_change();
  std::vector<std::vector<std::uint32_t>> places_of(owned_->classes.size());
  std::vector<std::vector<Environment>> environments_of(owned_->classes.size());
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Place place = places_[robots[i]];
    places_of[place.size_class].push_back(place.number);
    environments_of[place.size_class].push_back(environments[i]);
  }
  bool launches_change = false;
  for (std::size_t c = 0; c < places_of.size(); ++c)
    if (!places_of[c].empty() && owned_->classes[c].set_environments(places_of[c], environments_of[c], configuration_))
      launches_change = true;
  if (launches_change) choose_launches();
}

void CudaBackend::write_materials(std::span<const Material> tables) {
  begin_change();
  for (std::size_t i = 0; i < places_.size(); ++i)
    std::ranges::copy(tables.subspan(i * max_materials, max_materials), class_of(i).table(places_[i].number).begin());
  for (const auto& robots : classes()) robots->publish_all_materials(configuration_);
  choose_launches();
}

void CudaBackend::write_materials(std::size_t robot, std::span<const Material> table) {
  begin_change();
  std::ranges::copy(table, class_of(robot).table(places_[robot].number).begin());
  class_of(robot).publish_materials(places_[robot].number, configuration_);
  choose_launches();
}

void CudaBackend::set_perturbations(std::span<const Perturbation> perturbations) {
  settle();
  std::vector<std::vector<DevicePerturbation>> of_class(owned_->classes.size());
  for (const Perturbation& perturbation : perturbations) {
    const Place place = places_[perturbation.robot];
    of_class[place.size_class].push_back(
        {place.number, class_of(perturbation.robot).order_of(place.number).slot_of(perturbation.mass),
         perturbation.target, perturbation.stiffness});
  }
  for (std::size_t c = 0; c < of_class.size(); ++c) owned_->classes[c].set_perturbations(of_class[c]);
}

// Applies the settings at once, so that telemetry before the next step shows them.
bool CudaBackend::set_actuation(const ActuationSources& sources) {
  begin_change();
  owned_->brains.clear();
  owned_->actuators.clear();
  std::vector<std::vector<std::uint32_t>> robots_of(owned_->classes.size());  // those with actuators
  for (std::uint32_t i = 0; i < places_.size(); ++i)
    if (std::ranges::any_of(sources.actuator_of.subspan(i * std::size_t{max_materials}, max_materials),
                            [](std::uint8_t actuator) { return actuator != ActuationSources::no_actuator; }))
      robots_of[places_[i].size_class].push_back(i);
  std::vector<DrivenMaterial>& driven = owned_->driven;
  driven.clear();
  driven_of_.assign(places_.size(), {});
  for (std::size_t c = 0; c < robots_of.size(); ++c) {
    SizeClass& robots = owned_->classes[c];
    robots.end_actuation();
    if (robots_of[c].empty()) continue;
    robots.begin_actuation();
    for (const std::size_t i : robots_of[c]) {
      driven_of_[i].first = driven.size();
      for (std::size_t id = 0; id < max_materials; ++id)
        if (const std::uint8_t actuator = sources.actuator_of[i * max_materials + id];
            actuator != ActuationSources::no_actuator && robots.uses(places_[i].number, static_cast<MaterialId>(id)))
          driven.push_back(robots.driven_material(places_[i].number, static_cast<MaterialId>(id),
                                                  static_cast<std::uint32_t>(i * sources.columns + actuator)));
      driven_of_[i].second = driven.size() - driven_of_[i].first;
    }
  }
  choose_launches();
  if (driven.empty()) return true;
  owned_->actuators.set(driven, sources, main().get());
  owned_->actuators.apply({}, false, main().get());
  main().synchronize();
  return true;
}

bool CudaBackend::set_brains(std::span<const BrainPlan* const> plans) {
  settle();
  std::vector<DeviceBrains::Thinker> thinkers;
  for (std::size_t i = 0; i < plans.size(); ++i)
    if (plans[i])
      thinkers.push_back({.robot = i,
                          .body = &class_of(i).robot(places_[i].number),
                          .plan = plans[i],
                          .order = &class_of(i).order_of(places_[i].number),
                          .size_class = places_[i].size_class,
                          .place = places_[i].number,
                          .driven = std::span(owned_->driven).subspan(driven_of_[i].first, driven_of_[i].second),
                          .phases = class_of(i).view().phases + std::size_t{places_[i].number} * max_materials,
                          .columns = owned_->actuators.sources().columns});
  std::vector<std::uint32_t> class_sizes;
  for (const auto& robots : classes()) class_sizes.push_back(robots->size());
  owned_->brains.set(thinkers, class_sizes, main().get());
  choose_launches();
  return true;
}

void CudaBackend::settle_brains() const {
  settle();
  if (owned_->brains.is_shared()) check(cudaStreamSynchronize(cudaStreamLegacy), "waiting for a program's work");
}

BrainArrays CudaBackend::share_brains() {
  settle();
  return owned_->brains.share(device_);
}

void CudaBackend::write_brains(const PackedBrains& brains) {
  settle_brains();
  owned_->brains.write(brains, main().get());
}

PackedBrains CudaBackend::read_brains(bool weights) const {
  settle_brains();
  return owned_->brains.read(weights, main().get());
}

bool CudaBackend::measure_inversion(std::span<const BodyCells* const> cells) {
  begin_change();
  owned_->robot_cells = {};
  if (places_.empty() || cells.empty()) return true;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] && cells[i]->size() > most_cells_per_slot * class_of(i).robot(places_[i].number).masses.size())
      return false;
  std::vector<std::uint32_t> first(cells.size() + 1);
  for (std::size_t i = 0; i < cells.size(); ++i)
    first[i + 1] = first[i] + (cells[i] ? static_cast<std::uint32_t>(cells[i]->size()) : 0);
  std::vector<RobotCells> robots(cells.size());
  std::vector<DeviceCell> all(first.back());
  parallel_for(0, cells.size(), [&](std::size_t i) {
    const auto [size_class, number] = places_[i];
    RobotCells& robot = robots[first_report_[size_class] + number];
    robot = {first[i], first[i + 1] - first[i], std::numeric_limits<double>::quiet_NaN()};
    if (!cells[i]) return;
    robot.volume = robot.count > 0 ? cells[i]->volume() : 1;
    const SlotOrder& order = owned_->classes[size_class].order_of(number);
    for (std::uint32_t cell = 0; cell < robot.count; ++cell) {
      DeviceCell& to = all[robot.first + cell];
      to.volume = cells[i]->volume(cell);
      std::ranges::fill(to.corners, DeviceCell::no_corner);
      std::ranges::transform(cells[i]->corners(cell), to.corners,
                             [&](std::uint16_t mass) { return static_cast<std::uint16_t>(order.slot_of(mass)); });
    }
  });
  owned_->cells = DeviceArray<DeviceCell>(all.size());
  owned_->cells.write(0, all, main().get());
  owned_->robot_cells = DeviceArray<RobotCells>(robots.size());
  owned_->robot_cells.write(0, robots, main().get());
  return true;
}

void CudaBackend::settle() const {
  use_device();
  if (queued_) owned_->queued.synchronize();
  queued_ = false;
}

void CudaBackend::begin_change() {
  settle();
  report_valid_ = copy_valid_ = false;
}

void CudaBackend::begin_exchange() {
  begin_change();
  views_valid_ = rest_valid_ = false;
  positions_copy_.reset();
  owned_->brains.clear();
  owned_->actuators.clear();
  owned_->robot_cells = {};
  for (const auto& robots : classes()) robots->end_actuation();
}

void CudaBackend::choose_launches() {
  views_valid_ = false;
  real_bodies_ = std::ranges::any_of(classes(), [](const auto& robots) { return robots->has_real_bodies(); });
  bool brains_elsewhere = false;
  for (std::uint32_t c = 0; c < owned_->classes.size(); ++c) {
    SizeClass& robots = owned_->classes[c];
    if (robots.size() == 0) continue;
    robots.choose_launch(configuration_, places_.size(), owned_->brains.bytes(c));
    prepare_steps(configuration_.solver, model_for(robots), robots.launch());
    if (const auto& in_parts = robots.launch_in_parts()) {
      const StepModel model = model_in_parts(robots);
      if (robots_in_flight(configuration_.solver, model, *in_parts) > 0)
        prepare_steps(configuration_.solver, model, *in_parts);
      else
        robots.step_whole();
    }
    brains_elsewhere = brains_elsewhere || !robots.launch().on_chip;
  }
  if (brains_elsewhere) owned_->brains.reserve_workspace();
  // Reports of the classes follow one another.
  first_report_.assign(1, 0);
  for (const auto& robots : classes()) first_report_.push_back(first_report_.back() + robots->size());
  launch_order_.resize(owned_->classes.size());
  std::iota(launch_order_.begin(), launch_order_.end(), 0u);
  std::ranges::sort(launch_order_, std::greater{}, [&](std::uint32_t c) { return owned_->classes[c].sizes().tiles; });
  std::erase_if(launch_order_, [&](std::uint32_t c) { return owned_->classes[c].size() == 0; });
  divide_memory();
}

// Kernels that share a multiprocessor must divide its memory alike, or one waits until the others are gone; those of
// other simulations on the device, too. So a class alone divides it as it needs, but several classes by one of few
// levels, which simulations of such robots choose alike: by the memory that their blocks need on average, each class
// counted by its warps. A few blocks less at once are slower by less than more cache is faster (docs/experiments.md).
void CudaBackend::divide_memory() {
  if (launch_order_.size() < 2) return;
  constexpr std::uint32_t levels[] = {50, 75, 100}, least_with_common_tables = 75, may_lack = 10;  // [%]
  const DeviceLimits limits = device_limits();
  double warps = 0, needed = 0;
  std::uint32_t least = 0;  // that common tables take, and the largest block
  for (const std::uint32_t c : launch_order_) {
    const SizeClass& robots = owned_->classes[c];
    const LaunchConfiguration& launch = robots.launch_of_steps();
    const double own = static_cast<double>(robots.size()) * launch.parts * launch.warps_per_robot;
    warps += own;
    needed += own * launch.shared_percent;
    const auto block = static_cast<std::uint32_t>(launch.shared_bytes) + limits.reserved_per_block;
    least = std::max({least, launch.shared_table ? least_with_common_tables : 0,
                      std::min(100u, 100 * block / limits.shared_per_multiprocessor + 1)});
  }
  const std::uint32_t common = *std::ranges::find_if(levels, [&](std::uint32_t level) {
    return level == 100 || (level >= least && level + may_lack >= needed / warps);
  });
  for (const std::uint32_t c : launch_order_) owned_->classes[c].set_shared_percent(common);
}

void CudaBackend::number_masses(std::span<const Robot* const> robots) {
  std::vector<std::vector<std::uint64_t>> first_masses;
  for (const auto& each : classes()) first_masses.emplace_back(each->size());
  std::uint64_t masses = 0;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    first_masses[places_[i].size_class][places_[i].number] = masses;
    masses += robots[i]->masses.size();
  }
  for (std::size_t c = 0; c < first_masses.size(); ++c) owned_->classes[c].set_first_masses(std::move(first_masses[c]));
}

}  // namespace cuda

std::unique_ptr<Backend> make_cuda_backend(const Device& device) { return make_cuda_backend(device, nullptr); }

std::unique_ptr<Backend> make_cuda_backend(const Device& device, std::shared_ptr<PreparedRobots> prepared) {
  return std::make_unique<cuda::CudaBackend>(device, std::dynamic_pointer_cast<cuda::ArrangedRobots>(prepared));
}

}  // namespace mercury
