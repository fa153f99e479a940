// SPDX-License-Identifier: Apache-2.0
// Robots of about the same size in device memory (layout.h), stepped by one launch.
//
// Chunks and blocks are cut for the largest robot (paper, II.D). If one size served the whole batch, small robots would
// waste memory, and their blocks would wait with idle warps. So the batch is split into size classes:
//
//   class of 2 tiles   | place 0: robot 7 | place 1: robot 0 | place 2: robot 4 | room for more |
//   class of 5 tiles   | place 0: robot 5 | place 1: robot 2 |
//   class of 42 tiles  | place 0: robot 1 | place 1: robot 6 | place 2: robot 3 | place 3: robot 8 |
//
// 1. Each class has a launch configuration and a stream of its own. The launches of all classes run at the same time,
//    the largest robots first, and small robots fill what these leave idle.
// 2. A class stands its robots in places. New robots take the next places, in descending order of their springs, so
//    that the robots of a block end their steps at about the same time. If robots go, the last ones move into the gaps.
//    No robot is read back or uploaded twice.
// 3. A trajectory does not depend on the class or the place of its robot (block_layout.h).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mercury/backend.h"
#include "sim/cuda/actuation.h"
#include "sim/cuda/chunked_array.h"
#include "sim/cuda/chunks.h"
#include "sim/cuda/device_parts.h"
#include "sim/cuda/launch_configuration.h"
#include "sim/cuda/layout.h"
#include "sim/cuda/step.h"
#include "sim/physics/measures.h"

namespace mercury::cuda {

// For a vector whose new elements are unset until they are written. All threads that write them then get their memory
// from the system, not one before them.
template <class T>
struct UnsetAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };
  template <class U>
  void construct(U*) const {}
  template <class U, class Value>
  void construct(U* at, Value&& value) const {
    std::construct_at(at, std::forward<Value>(value));
  }
};

class SizeClass {
 public:
  explicit SizeClass(std::uint32_t record_words) { sizes_.record_words = record_words; }

  std::uint32_t size() const { return static_cast<std::uint32_t>(headers_.size()); }  // robots
  const ChunkSizes& sizes() const { return sizes_; }
  BatchView view() const;
  RobotView robot_view(std::uint32_t place) const;

  // New robots take the next `count` places. Returns the first of them. Each is then to be filled: make room for all
  // chunks, set_robot(), write_chunks(), and publish() for all at the end.
  std::uint32_t append(std::size_t count);
  // Makes room for the chunks of all places, of at least these sizes, of which the first `used` are filled. Throws
  // DeviceError if there is none.
  void make_room(const ChunkSizes& sizes, std::uint32_t used, Solver solver);
  // By which chunks address masses, see offset_of_slot().
  std::uint32_t address_fields() const { return address_fields_; }
  // Safe to call for several places at once.
  void set_robot(std::uint32_t place, const Robot& robot, const RobotMeasures& measures,
                 const Arrangement& arrangement);
  // Queues the copies to the chunks of consecutive places in urgent().
  void write_chunks(std::uint32_t first_place, const Chunks& chunks);
  // Uploads what set_robot() took, from `first_place` on. The robots have not exploded.
  void publish(std::uint32_t first_place, const Configuration& configuration);
  // Gives up all places from `first_place` on.
  void truncate(std::uint32_t first_place);
  // Gives up the places for which `keep` is false. Returns the new place of each of the others, by its old one.
  std::vector<std::uint32_t> compact(const std::vector<bool>& keep);
  // For each place, the index of the robot's first mass among those of the batch.
  void set_first_masses(std::vector<std::uint64_t> first_masses) { first_mass_ = std::move(first_masses); }

  // Updates the scales of the fixed-point sums.
  void configure(const Configuration& configuration);
  // Where robots live, in place of the configuration's environment. Returns whether choose_launch() has to follow.
  bool set_environments(std::span<const std::uint32_t> places, std::span<const Environment> environments,
                        const Configuration& configuration);
  void share_environment() { environments_.assign(size(), std::nullopt); }
  void publish_headers();
  bool environments_differ() const {
    return std::ranges::any_of(environments_, [](const auto& environment) { return environment.has_value(); });
  }
  // One per place; null if the kernel of this class needs none.
  const OwnModel* own_models() const { return own_models_.data(); }
  // Chooses how to launch it beside the other classes; `batch_size` = robots of all classes.
  void choose_launch(const Configuration& configuration, std::size_t batch_size, const BrainBytes& brain = {});
  // Of whole robots.
  const LaunchConfiguration& launch() const { return launch_; }
  // If the class had more robots than the device steps at once.
  const LaunchConfiguration& launch_of_many() const { return launch_of_many_; }
  // If clusters step the robots in parts: those, and their launch. Reports are made of whole robots, without a step.
  const std::optional<LaunchConfiguration>& launch_in_parts() const { return launch_in_parts_; }
  BatchView view_of_parts() const { return parts_.view(view()); }
  void step_whole() { launch_in_parts_.reset(); }
  // The launch that makes the steps.
  const LaunchConfiguration& launch_of_steps() const { return launch_in_parts_ ? *launch_in_parts_ : launch_; }
  void set_shared_percent(std::uint32_t percent) {
    launch_.shared_percent = percent;
    if (launch_in_parts_) launch_in_parts_->shared_percent = percent;
  }

  // The table of a place; publish_materials() or publish_all_materials() uploads it.
  std::span<Material> table(std::uint32_t place) {
    return std::span(materials_).subspan(std::size_t{place} * max_materials, max_materials);
  }
  void publish_materials(std::uint32_t place, const Configuration& configuration);
  void publish_all_materials(const Configuration& configuration);
  // Whether a robot says what its masses are or has springs with a relaxation time.
  bool has_real_bodies() const;
  // Queues a kernel that computes the phases, if materials or the clock's base or dt changed.
  void update_phases(const Clock& clock, cudaStream_t stream);
  // From here on the steps read copies of the materials, some of which actuators drive (actuation.h), and robots have
  // tables of their own. So that these are small, the springs name only materials that springs of the robot have:
  //
  //   materials of a robot    0  1  2  3  4  5  6 ...  used: 2, 3, 6
  //   its driven materials    0        1  2        3   air stays, since padding names it
  //
  void begin_actuation();
  void end_actuation();
  bool uses(std::uint32_t place, MaterialId id) const { return measures_[place].used[id]; }
  DrivenMaterial driven_material(std::uint32_t place, MaterialId id, std::uint32_t setting) const;
  void set_perturbations(std::span<const DevicePerturbation> perturbations);
  // Before each launch of steps: whether the lists of contacts that the last one left are still of these robots. States
  // may have changed.
  bool keeps_lists() { return std::exchange(lists_kept_, true); }

  const Robot& robot(std::uint32_t place) const { return *robots_[place]; }
  const SlotOrder& order_of(std::uint32_t place) const { return *slot_tables_[place]; }
  void read(std::uint32_t place, std::span<Vec3> positions, std::span<Vec3> velocities) const;
  void write(std::uint32_t place, std::span<const Vec3> positions, std::span<const Vec3> velocities);
  // Puts the robots of consecutive places at rest where they began, but lifts[i] [m] higher. They have not exploded.
  void put_at_rest(std::uint32_t first_place, std::span<const Robot* const> robots, std::span<const float> lifts);
  // Writes one vector per mass of all robots to their parts of `out`. Copies whole states, because a kernel would wait
  // for a multiprocessor that other simulations leave free. `first_field` = field_x or field_v.
  void read_all(Field first_field, std::span<Vec3> out) const;
  DeviceStatus status(std::uint32_t place) const;
  std::vector<DeviceStatus> statuses() const;
  void set_status(std::uint32_t place, DeviceStatus status);

  // For launches of the step kernel.
  const Stream& stream() const { return *stream_; }
  // For all else. What the functions above queue there is done when they return, except for write_chunks().
  const Stream& urgent() const { return *urgent_; }
  Event& done() const { return *done_; }

 private:
  // Computes what depends on the batch's configuration, the environment and the materials of a robot.
  void describe(std::uint32_t place, const Configuration& of_batch);
  Configuration configuration_of(std::uint32_t place, Configuration configuration) const;
  void publish_own_models(const Configuration& configuration);
  // Uploads the properties of all masses if one of them is not a free mass of 1 kg, and XPBD's valences with them.
  void publish_points();
  // Uploads which masses are behind faces, if a robot lives in one-sided water.
  void publish_backs(const Configuration& configuration);
  // To be called when tables from a place on have changed.
  void find_same_materials(std::uint32_t first_changed);
  // Rewrites how spring records and face pairs address masses: by offsets in working memory with this many fields per
  // tile, or by slots (0).
  void address_masses(std::uint32_t old_fields, std::uint32_t new_fields);
  void reserve_workspace(std::size_t bytes_per_robot);
  void choose_launch_in_parts(const Configuration& configuration, std::size_t batch_size, const BrainBytes& brain);
  // Replaces the material that each spring record names; `ids` = [place][max_materials], the new id by the old one.
  void rename_materials(std::span<const MaterialId> ids);
  // LaunchConfiguration::table_chunks: enough for the materials that springs name.
  std::uint32_t table_chunks() const;
  // Those of a place that springs have, after air; max_materials elements.
  std::vector<Material> driven_table(std::uint32_t place) const;
  template <class Visit>
  void for_each_array(const Visit& visit);

  ChunkSizes sizes_;
  std::size_t capacity_ = 0;
  // [place]
  std::vector<RobotHeader> headers_;
  std::vector<const Robot*> robots_;
  std::vector<RobotMeasures> measures_;
  std::vector<std::optional<Environment>> environments_;        // nothing = the configuration's
  std::vector<std::vector<PointProperties>> point_properties_;  // by mass; empty = free masses of 1 kg
  std::vector<std::shared_ptr<const SlotOrder>> slot_tables_;
  std::vector<std::uint64_t> first_mass_;                      // as in set_first_masses()
  std::vector<Material, UnsetAllocator<Material>> materials_;  // [place][max_materials], set by set_robot()
  LaunchConfiguration launch_, launch_of_many_;
  std::optional<LaunchConfiguration> launch_in_parts_;
  DeviceParts parts_;
  bool parts_stale_ = true;
  std::uint32_t address_fields_ = 0;  // by which spring records and face pairs address masses; 0 = slots
  std::size_t workspace_stride_ = 0, perturbation_count_ = 0;
  bool same_materials_ = false;  // all robots have the same table
  bool points_stale_ = true, valences_have_masses_ = false;
  bool phases_stale_ = true;
  bool lists_kept_ = false;  // see keeps_lists()
  Clock phase_clock_;

  ChunkedArray<RobotHeader> device_headers_;
  ChunkedArray<DeviceStatus> statuses_;
  ChunkedArray<float> state_, valences_, lengths_;
  ChunkedArray<std::uint32_t> springs_{words_of_group(2)}, groups_;
  ChunkedArray<SlotRows> rows_;
  ChunkedArray<std::uint16_t> masses_;
  ChunkedArray<FacePair> face_pairs_;
  ChunkedArray<Material> device_materials_;
  ChunkedArray<MusclePhase> phases_;
  ChunkedArray<MuscleSwing> swings_;
  DeviceArray<OwnModel> own_models_;        // [place], or empty
  DeviceArray<PointProperties> points_;     // [place][slot], or empty
  DeviceArray<std::uint32_t> face_backs_;   // [place][pair], or empty
  DeviceArray<float> point_masses_;         // [place][slot] [kg], or empty
  DeviceArray<Material> driven_materials_;  // [place][max_materials] while actuators drive them, else empty
  std::vector<MaterialId> driven_ids_;      // the same: the index among them, by id
  DeviceArray<DevicePerturbation> perturbations_;
  DeviceArray<char> workspace_;
  std::unique_ptr<Stream> stream_ = std::make_unique<Stream>(), urgent_ = std::make_unique<Stream>(true);
  std::unique_ptr<Event> done_ = std::make_unique<Event>();
};

}  // namespace mercury::cuda
