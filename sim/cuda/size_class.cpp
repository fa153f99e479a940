// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/size_class.h"

#include <algorithm>

#include "mercury/parallel.h"
#include "sim/cuda/block_layout.h"
#include "sim/cuda/device_limits.h"
#include "sim/cuda/kernels.h"

namespace mercury::cuda {
namespace {

std::size_t grown(std::size_t needed, std::size_t present) {
  return needed <= present ? present : std::max(needed, present + present / 2);
}

// The robots that leave gaps are replaced by the last ones: (from, to).
std::vector<uint2> moves_into_gaps(const std::vector<bool>& keep) {
  const auto kept = static_cast<std::uint32_t>(std::ranges::count(keep, true));
  std::vector<uint2> moves;
  std::uint32_t gap = 0;
  for (std::uint32_t place = kept; place < keep.size(); ++place) {
    if (!keep[place]) continue;
    while (keep[gap]) ++gap;
    moves.push_back({place, gap++});
  }
  return moves;
}

}  // namespace

// Visits the arrays that have a chunk per place, each with the length of that chunk.
template <class Visit>
void SizeClass::for_each_array(const Visit& visit) {
  visit(device_headers_, 1);
  visit(statuses_, 1);
  visit(device_materials_, max_materials);
  visit(phases_, max_materials);
  visit(swings_, max_materials);
  visit(state_, sizes_.state());
  visit(valences_, sizes_.slots());
  visit(masses_, sizes_.slots());
  visit(rows_, sizes_.slots());
  visit(lengths_, sizes_.lengths());
  visit(groups_, sizes_.tiles);
  visit(springs_, sizes_.springs());
  visit(face_pairs_, sizes_.face_pairs);
}

std::uint32_t SizeClass::append(std::size_t count) {
  lists_kept_ = false;
  parts_stale_ = true;
  const std::uint32_t first = size();
  headers_.resize(first + count);
  robots_.resize(first + count);
  measures_.resize(first + count);
  environments_.resize(first + count);
  point_properties_.resize(first + count);
  slot_tables_.resize(first + count);
  materials_.resize((first + count) * max_materials);
  return first;
}

void SizeClass::make_room(const ChunkSizes& sizes, std::uint32_t used, Solver solver) {
  if (capacity_ == 0) {
    // As the launch will want it, most likely.
    const std::uint32_t fields = working_fields(solver, true);
    address_fields_ = sizes.tiles * fields * field_bytes <= device_limits().shared_per_block ? fields : 0;
  }
  const auto fits = [](std::uint32_t needed, std::uint32_t present) { return needed <= present; };
  if (size() <= capacity_ && fits(sizes.tiles, sizes_.tiles) && fits(sizes.groups, sizes_.groups) &&
      fits(sizes.face_pairs, sizes_.face_pairs))
    return;
  const ChunkSizes old_sizes = sizes_;
  const std::size_t old_capacity = capacity_;
  const auto reshape = [&] {
    for_each_array([&](auto& array, std::size_t stride) { array.reshape(capacity_, stride, used, urgent_->get()); });
  };
  // Some room to spare, for robots that need a little more than those before.
  const auto enlarge = [](std::uint32_t needed, std::uint32_t& present) {
    if (needed > present) present = present == 0 ? needed : needed + needed / 16;
  };
  sizes_.tiles = std::max(sizes.tiles, sizes_.tiles);
  enlarge(sizes.groups, sizes_.groups);
  enlarge(sizes.face_pairs, sizes_.face_pairs);
  capacity_ = grown(size(), capacity_);
  try {
    reshape();
  } catch (const DeviceError&) {
    sizes_ = old_sizes;
    capacity_ = old_capacity;
    reshape();
    throw;
  }
}

void SizeClass::set_robot(std::uint32_t place, const Robot& robot, const RobotMeasures& measures,
                          const Arrangement& arrangement) {
  robots_[place] = &robot;
  measures_[place] = measures;
  slot_tables_[place] = arrangement.order;
  double mass = 0;
  for (std::size_t i = 0; i < robot.masses.size(); ++i) mass += static_cast<double>(mass_of(robot, i));
  headers_[place] = {.masses = static_cast<std::uint32_t>(robot.masses.size()),
                     .tiles = arrangement.schedule.tiles(),
                     .face_pairs = static_cast<std::uint32_t>(arrangement.faces.size()),
                     .springs = static_cast<std::uint32_t>(robot.springs.size()),
                     .force_scale = 1,  // publish() sets these, by describe()
                     .correction_scale = 1,
                     .squared_stretch_limit = measures.squared_stretch_limit(),
                     .environment_scale = 1,
                     .contact_distance = 0,
                     .contact_units = 0,
                     .list_radius = 0,
                     .highest_length_rate = 0,
                     .relaxation_time = 0,
                     .mass = mass};
  const auto to = table(place);
  const auto rest = std::ranges::copy(materials_of(robot), to.begin()).out;
  std::fill(rest, to.end(), Material{});
}

void SizeClass::write_chunks(std::uint32_t first_place, const Chunks& chunks) {
  const auto copy = [&]<class T>(const ChunkedArray<T>& to, std::span<const T> values) {
    if (values.empty()) return;
    upload(to.chunk(first_place), values.data(), values.size_bytes(), urgent_->get(), "uploading robots");
  };
  copy(state_, std::span<const float>(chunks.state));
  copy(valences_, std::span<const float>(chunks.valences));
  copy(masses_, std::span<const std::uint16_t>(chunks.masses));
  copy(lengths_, std::span<const float>(chunks.lengths));
  copy(springs_, std::span<const std::uint32_t>(chunks.springs));
  copy(groups_, std::span<const std::uint32_t>(chunks.groups));
  copy(rows_, std::span<const SlotRows>(chunks.rows));
  copy(face_pairs_, std::span<const FacePair>(chunks.face_pairs));
}

void SizeClass::publish(std::uint32_t first_place, const Configuration& configuration) {
  const std::size_t count = size() - first_place;
  if (count == 0) return;
  lists_kept_ = false;
  find_same_materials(first_place);
  // Trials of one robot stand side by side.
  const auto is_repeated = [&](std::size_t place) {
    return place > first_place && robots_[place] == robots_[place - 1];
  };
  parallel_for(first_place, size(), [&](std::size_t place) {
    if (!is_repeated(place)) describe(static_cast<std::uint32_t>(place), configuration);
  });
  for (std::size_t place = first_place; place < size(); ++place)
    if (is_repeated(place)) {
      headers_[place] = headers_[place - 1];
      point_properties_[place] = point_properties_[place - 1];
    }
  points_stale_ = true;
  const cudaStream_t stream = urgent_->get();
  device_headers_.write(first_place, std::span(headers_).subspan(first_place), stream);
  statuses_.write(first_place, std::vector<DeviceStatus>(count, DeviceStatus{-1, no_mass}), stream);
  device_materials_.write(first_place, std::span(materials_).subspan(std::size_t{first_place} * max_materials), stream);
}

void SizeClass::truncate(std::uint32_t first_place) {
  lists_kept_ = false;
  parts_stale_ = true;
  headers_.resize(first_place);
  robots_.resize(first_place);
  measures_.resize(first_place);
  environments_.resize(first_place);
  point_properties_.resize(first_place);
  points_stale_ = true;
  slot_tables_.resize(first_place);
  materials_.resize(std::size_t{first_place} * max_materials);
}

std::vector<std::uint32_t> SizeClass::compact(const std::vector<bool>& keep) {
  std::vector<std::uint32_t> new_place(keep.size());
  for (std::uint32_t place = 0; place < keep.size(); ++place) new_place[place] = place;
  const std::vector<uint2> moves = moves_into_gaps(keep);
  for (const uint2 move : moves) {
    new_place[move.x] = move.y;
    headers_[move.y] = headers_[move.x];
    robots_[move.y] = robots_[move.x];
    measures_[move.y] = measures_[move.x];
    environments_[move.y] = environments_[move.x];
    point_properties_[move.y] = std::move(point_properties_[move.x]);
    slot_tables_[move.y] = slot_tables_[move.x];
    std::ranges::copy(table(move.x), table(move.y).begin());
  }
  truncate(static_cast<std::uint32_t>(std::ranges::count(keep, true)));
  if (moves.empty()) return new_place;
  DeviceArray<uint2> device_moves(moves.size());
  device_moves.write(0, moves, urgent_->get());
  for_each_array([&]<class T>(const ChunkedArray<T>& array, std::size_t stride) {
    move_chunks(reinterpret_cast<std::uint32_t*>(array.data()), stride * sizeof(T) / 4, device_moves.data(),
                moves.size(), urgent_->get());
  });
  urgent_->synchronize();
  return new_place;
}

void SizeClass::configure(const Configuration& configuration) {
  lists_kept_ = false;
  parallel_for(0, size(), [&](std::size_t place) { describe(static_cast<std::uint32_t>(place), configuration); });
  points_stale_ = true;
  publish_headers();
}

void SizeClass::publish_headers() { device_headers_.write(0, headers_, urgent_->get()); }

bool SizeClass::set_environments(std::span<const std::uint32_t> places, std::span<const Environment> environments,
                                 const Configuration& configuration) {
  lists_kept_ = false;
  const bool kernel_changes = launch_in_parts_ && !environments_differ();
  parallel_for(0, places.size(), [&](std::size_t i) {
    environments_[places[i]] = environments[i];
    describe(places[i], configuration);
  });
  for (const std::uint32_t place : places) points_stale_ = points_stale_ || !point_properties_[place].empty();
  const bool launches_change = own_models_.size() == 0 || points_stale_ || kernel_changes;
  constexpr std::size_t few = 16;
  if (places.size() > few || launches_change) {
    publish_headers();
    if (!launches_change) publish_own_models(configuration);
    return launches_change;
  }
  for (const std::uint32_t place : places) {
    const OwnModel model(configuration_of(place, configuration));
    device_headers_.write(place, std::span(headers_).subspan(place, 1), urgent_->get());
    own_models_.write(place, std::span(&model, 1), urgent_->get());
  }
  return false;
}

Configuration SizeClass::configuration_of(std::uint32_t place, Configuration configuration) const {
  if (environments_[place]) configuration.environment = *environments_[place];
  return configuration;
}

void SizeClass::publish_own_models(const Configuration& configuration) {
  const bool needed = launch_in_parts_ || needs_own_models(launch_) || environments_differ();
  const std::size_t count = needed ? size() : 0;
  if (own_models_.size() != count) own_models_ = DeviceArray<OwnModel>(count);
  std::vector<OwnModel> models(count, OwnModel(configuration));
  for (std::uint32_t place = 0; place < count; ++place)
    if (environments_[place]) models[place] = OwnModel(configuration_of(place, configuration));
  own_models_.write(0, models, urgent_->get());
}

void SizeClass::choose_launch(const Configuration& configuration, std::size_t batch_size, const BrainBytes& brain) {
  lists_kept_ = false;
  if (points_stale_) publish_backs(configuration);
  publish_points();
  const bool same_materials = same_materials_ && driven_materials_.size() == 0;
  const bool viscous =
      std::ranges::any_of(headers_, [](const RobotHeader& header) { return header.highest_length_rate > 0; });
  const std::uint32_t chunks = table_chunks();
  const auto choose = [&](const BatchView& robots, std::size_t batch) {
    return choose_launch_configuration(configuration, robots, same_materials, viscous, batch, chunks, brain);
  };
  launch_ = choose(view(), batch_size);
  BatchView many = view();
  many.robot_count = many_robots;
  launch_of_many_ = choose(many, many_robots + (batch_size - size()));
  const std::uint32_t fields = working_fields(configuration.solver, launch_.valence_on_chip);
  const std::uint32_t old_fields = std::exchange(address_fields_, launch_.on_chip ? fields : 0);
  address_masses(old_fields, address_fields_);
  std::size_t workspace = 0;
  if (!launch_.on_chip) workspace += std::size_t{sizes_.tiles} * fields * field_bytes;
  if (!launch_.contacts_on_chip) workspace += contact_grid_bytes(launch_.contact_buckets, sizes_.tiles);
  if (launch_.contact_buckets > 0) workspace += contact_workspace_bytes(sizes_.tiles);
  choose_launch_in_parts(configuration, batch_size, brain);
  if (launch_in_parts_ && launch_.contact_buckets > 0)
    workspace =
        std::max(workspace, contact_workspace_bytes_in_parts(launch_.contact_buckets, sizes_.tiles,
                                                             launch_in_parts_->parts, view_of_parts().tile_stride));
  reserve_workspace(workspace);
  publish_own_models(configuration);
}

void SizeClass::choose_launch_in_parts(const Configuration& configuration, std::size_t batch_size,
                                       const BrainBytes& brain) {
  launch_in_parts_.reset();
  // A brain reads all masses of its robot.
  if (brain.scratch == 0 && (!launch_.on_chip || is_faster_in_parts(launch_, sizes_.tiles, batch_size))) {
    std::vector<DeviceParts::Source> sources;
    for (std::uint32_t place = 0; place < size(); ++place) {
      const std::size_t first = driven_ids_.empty() ? 0 : std::size_t{place} * max_materials;
      sources.push_back({robots_[place], slot_tables_[place].get(),
                         std::span(driven_ids_).subspan(first, driven_ids_.empty() ? 0 : max_materials)});
    }
    launch_in_parts_ = parts_.choose(sources, !parts_stale_, sizes_,
                                     {.configuration = configuration,
                                      .same_materials = launch_.shared_table,
                                      .viscous = launch_.viscous,
                                      .table_chunks = launch_.table_chunks,
                                      .batch_size = batch_size});
  }
  parts_stale_ = !launch_in_parts_;
  if (launch_in_parts_)
    parts_.upload(view(), urgent_->get());
  else
    parts_ = {};
}

void SizeClass::address_masses(std::uint32_t old_fields, std::uint32_t new_fields) {
  if (old_fields == new_fields || size() == 0) return;
  const std::size_t records = size() * sizes_.springs() / sizes_.record_words, pairs = size() * sizes_.face_pairs;
  if (records > 0)
    readdress_partners(springs_.data(), records, sizes_.record_words, old_fields, new_fields, urgent_->get());
  if (pairs > 0) readdress_corners({face_pairs_.data(), pairs}, old_fields, new_fields, urgent_->get());
  urgent_->synchronize();
}

void SizeClass::reserve_workspace(std::size_t bytes_per_robot) {
  const std::size_t bytes = bytes_per_robot * size();
  if (bytes_per_robot == workspace_stride_ && bytes <= workspace_.size()) return;
  workspace_ = DeviceArray<char>();  // frees the old one first
  workspace_ = DeviceArray<char>(bytes_per_robot * capacity_);
  workspace_stride_ = bytes_per_robot;
}

void SizeClass::set_perturbations(std::span<const DevicePerturbation> perturbations) {
  if (perturbations.size() > perturbations_.size())
    perturbations_ = DeviceArray<DevicePerturbation>(perturbations.size());
  perturbations_.write(0, perturbations, urgent_->get());
  perturbation_count_ = perturbations.size();
}

BatchView SizeClass::view() const {
  return {.robots = device_headers_.data(),
          .statuses = statuses_.data(),
          .state = state_.data(),
          .springs = springs_.data(),
          .lengths = lengths_.data(),
          .groups = groups_.data(),
          .rows = rows_.data(),
          .face_pairs = face_pairs_.data(),
          .valences = valences_.data(),
          .masses = masses_.data(),
          .face_backs = face_backs_.data(),
          .points = points_.data(),
          .point_masses = point_masses_.data(),
          .materials = driven_materials_.size() > 0 ? driven_materials_.data() : device_materials_.data(),
          .phases = phases_.data(),
          .swings = swings_.data(),
          .perturbations = perturbations_.data(),
          .workspace = workspace_.data(),
          .robot_count = size(),
          .tile_stride = sizes_.tiles,
          .group_stride = sizes_.groups,
          .face_stride = sizes_.face_pairs,
          .perturbation_count = static_cast<std::uint32_t>(perturbation_count_),
          .workspace_stride = static_cast<std::uint32_t>(workspace_stride_),
          .record_words = sizes_.record_words};
}

}  // namespace mercury::cuda
