// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/device_parts.h"

#include <algorithm>

#include "mercury/parallel.h"
#include "sim/cuda/device_limits.h"
#include "sim/cuda/kernels.h"

namespace mercury::cuda {
namespace {

std::vector<const Robot*> robots_of(std::span<const DeviceParts::Source> sources) {
  std::vector<const Robot*> robots;
  for (const DeviceParts::Source& source : sources) robots.push_back(source.robot);
  return robots;
}

template <class T>
DeviceArray<T> on_device(std::span<const T> values, cudaStream_t stream) {
  DeviceArray<T> array(values.size());
  array.write(0, values, stream);
  return array;
}

}  // namespace

std::optional<LaunchConfiguration> DeviceParts::choose(std::span<const Source> robots, bool same_robots,
                                                       const ChunkSizes& sizes, const Wanted& wanted) {
  const DeviceLimits limits = device_limits();
  if (!limits.clusters) return std::nullopt;
  const std::uint32_t fields = working_fields(wanted.configuration.solver, true);
  for (std::uint32_t parts = 2; parts <= most_parts; parts *= 2) {
    const bool leaves_idle = parts < most_parts && wanted.batch_size * 2 * parts <= limits.multiprocessors;
    if (leaves_idle || sizes.tiles / parts * fields * field_bytes > limits.shared_per_block) continue;
    if (!same_robots || view_.per_robot != parts || fields_ != fields) {
      split(robots, parts, sizes);
      fields_ = fields;
    }
    BatchView batch{};
    batch.robot_count = static_cast<std::uint32_t>(robots.size());
    batch.record_words = sizes.record_words;
    // Two blocks per multiprocessor, so that one computes while the other waits; or one, if its part is large.
    for (const std::uint32_t blocks : {2u, 1u})
      if (const auto launch = choose_launch_in_parts(wanted.configuration, view(batch), wanted.same_materials,
                                                     wanted.viscous, wanted.table_chunks, blocks))
        return launch;
    same_robots = false;
  }
  return std::nullopt;
}

void DeviceParts::upload(const BatchView& robots, cudaStream_t stream) {
  if (!split_.empty()) upload_parts(stream);
  copy_points(robots, stream);
  find_backs(robots, stream);
  check(cudaStreamSynchronize(stream), "uploading parts of robots");
}

void DeviceParts::split(std::span<const Source> robots, std::uint32_t parts, const ChunkSizes& sizes) {
  sources_.assign(robots.begin(), robots.end());
  record_words_ = sizes.record_words;
  view_.per_robot = parts;
  view_.robot_tile_stride = sizes.tiles;
  tile_stride_ = group_stride_ = face_stride_ = view_.export_stride = 0;
  first_of_topology_ = first_of_topology(robots_of(robots));
  split_.assign(robots.size(), {});
  parallel_for(0, robots.size(), [&](std::size_t i) {
    if (first_of_topology_[i] == i) split_[i] = cuda::split(*robots[i].robot, *robots[i].order, parts);
  });
  for (const std::vector<Part>& of_robot : split_)
    for (const Part& part : of_robot) {
      const auto raise = [](std::uint32_t& stride, std::size_t to) {
        stride = std::max(stride, static_cast<std::uint32_t>(to));
      };
      raise(tile_stride_, part.tiles());
      raise(group_stride_, groups_of(part.arrangement.schedule));
      raise(face_stride_, part.arrangement.faces.size());
      raise(view_.export_stride, part.exports.size());
    }
}

void DeviceParts::upload_parts(cudaStream_t stream) {
  const std::size_t parts = sources_.size() * view_.per_robot, slots = std::size_t{tile_stride_} * lanes;
  const std::size_t words = group_stride_ * words_of_group(record_words_);
  std::vector<PartHeader> headers(parts);
  std::vector<std::uint32_t> springs(parts * words + words_of_group(2)), groups(parts * tile_stride_);
  std::vector<SlotRows> rows(parts * slots);
  std::vector<std::uint32_t> export_start(parts * (tile_stride_ + 1));
  std::vector<std::uint32_t> face_dithers(parts * face_stride_);
  std::vector<std::uint32_t> places(sources_.size() * view_.robot_tile_stride * lanes);
  std::vector<FacePair> faces(parts * face_stride_);
  std::vector<std::uint16_t> slot_map(parts * slots);
  std::vector<Export> exports(parts * view_.export_stride);
  parallel_for(0, parts, [&](std::size_t i) {
    const std::size_t robot = i / view_.per_robot;
    const Source& source = sources_[robot];
    const Part& part = split_[first_of_topology_[robot]][i % view_.per_robot];
    const Schedule& schedule = part.arrangement.schedule;
    headers[i] = {part.own, part.own_tiles(), part.tiles() - part.own_tiles(),
                  static_cast<std::uint32_t>(part.arrangement.faces.size())};
    const RestLengths rest = record_words_ == 1 ? rest_lengths(*source.robot) : RestLengths{};
    fill_records(std::span(springs).subspan(i * words, words), *source.robot, schedule, rest,
                 {part.springs, source.materials, fields_});
    fill_rows(std::span(groups).subspan(i * tile_stride_, tile_stride_), std::span(rows).subspan(i * slots, slots),
              schedule);
    std::ranges::copy(part.export_start, export_start.begin() + static_cast<std::ptrdiff_t>(i * (tile_stride_ + 1)));
    const auto first_face = static_cast<std::ptrdiff_t>(i * face_stride_);
    std::ranges::copy(part.face_dithers, face_dithers.begin() + first_face);
    std::ranges::transform(part.arrangement.faces, faces.begin() + first_face,
                           [&](const FacePair& pair) { return addressed(pair, fields_); });
    std::ranges::copy(part.exports, exports.begin() + static_cast<std::ptrdiff_t>(i * view_.export_stride));
    // Empty slots read some mass at the start, and then have its position. No spring leads there.
    const std::span slots_of_part = std::span(slot_map).subspan(i * slots, slots);
    std::ranges::fill(slots_of_part, source.order->slots[part.masses.front()]);
    for (std::uint32_t mass = 0; mass < part.masses.size(); ++mass) {
      const std::uint32_t slot = part.arrangement.order->slot_of(mass),
                          whole = source.order->slot_of(part.masses[mass]);
      slots_of_part[slot] = static_cast<std::uint16_t>(whole);
      if (mass < part.own)
        places[robot * view_.robot_tile_stride * lanes + whole] =
            static_cast<std::uint32_t>(i % view_.per_robot) << 16 | slot;
    }
  });
  const auto replace = [&]<class T>(DeviceArray<T>& array, const std::vector<T>& values) {
    array = {};
    array = on_device(std::span<const T>(values), stream);
  };
  replace(headers_, headers);
  replace(springs_, springs);
  replace(groups_, groups);
  replace(rows_, rows);
  replace(export_start_, export_start);
  replace(face_dithers_, face_dithers);
  replace(places_, places);
  replace(face_pairs_, faces);
  replace(slots_, slot_map);
  replace(exports_, exports);
  split_.clear();
}

void DeviceParts::copy_points(const BatchView& robots, cudaStream_t stream) {
  if (!robots.points) {
    points_ = {};
    return;
  }
  const std::size_t slots = std::size_t{robots.robot_count} * view_.per_robot * tile_stride_ * lanes;
  if (points_.size() != slots) points_ = DeviceArray<PointProperties>(slots);
  copy_points_to_parts(view(robots), robots.points, points_.data(), stream);
}

// Springs join the mass behind a face to all its corners, so a part that has one of them as its own has that mass, too.
void DeviceParts::find_backs(const BatchView& robots, cudaStream_t stream) {
  face_backs_ = {};
  if (!robots.face_backs) return;
  std::vector<FacePair> pairs(face_pairs_.size());
  std::vector<std::uint16_t> slots(slots_.size());
  face_pairs_.read(0, pairs, stream);
  slots_.read(0, slots, stream);
  std::vector<std::uint32_t> backs(pairs.size());
  parallel_for(0, sources_.size() * view_.per_robot, [&](std::size_t i) {
    const Source& source = sources_[i / view_.per_robot];
    const std::vector<std::uint16_t> masses = source.order->masses();
    std::vector<std::uint16_t> mass_at;
    const std::size_t count = std::size_t{tile_stride_} * lanes;
    for (const std::uint16_t slot : std::span(slots).subspan(i * count, count)) mass_at.push_back(masses[slot]);
    const auto own = [&](auto& all) { return std::span(all).subspan(i * face_stride_, face_stride_); };
    fill_backs(own(backs), *source.robot, mass_at, own(pairs), fields_);
  });
  face_backs_ = on_device(std::span<const std::uint32_t>(backs), stream);
}

BatchView DeviceParts::view(BatchView robots) const {
  robots.springs = springs_.data();
  robots.rows = rows_.data();
  robots.face_pairs = face_pairs_.data();
  robots.groups = groups_.data();
  robots.tile_stride = tile_stride_;
  robots.group_stride = group_stride_;
  robots.face_stride = face_stride_;
  if (face_backs_.size() > 0) robots.face_backs = face_backs_.data();
  robots.parts = view_;
  robots.parts.headers = headers_.data();
  robots.parts.slots = slots_.data();
  robots.parts.face_dithers = face_dithers_.data();
  robots.parts.exports = exports_.data();
  robots.parts.export_start = export_start_.data();
  robots.parts.places = places_.data();
  if (points_.size() > 0) robots.points = points_.data();
  return robots;
}

}  // namespace mercury::cuda
