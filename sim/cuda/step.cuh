// SPDX-License-Identifier: Apache-2.0
// The phases of a step for one robot, as one of its threads carries them out. Barriers between them are the kernel's
// (step.cu).
#pragma once

#include "sim/cuda/contacts.cuh"
#include "sim/cuda/faces.cuh"
#include "sim/cuda/springs.cuh"

namespace mercury::cuda {

template <Solver solver, class EnvironmentModel, class Memory, int record_words>
class RobotStepper {
 public:
  using Robot = BlockRobot<solver, Memory, record_words>;
  using Springs = SpringPass<Robot, EnvironmentModel>;
  static constexpr bool has_contacts = EnvironmentModel::has_contacts && Memory::finds_contacts;
  __device__ RobotStepper(const StepArguments& arguments, const EnvironmentModel& model,
                          const BlockContext<solver, Memory>& context)
      : robot_(arguments, context.thread), model_(model), record_(context.record) {}

  __device__ bool alive() const { return batch().statuses[robot_.context().robot].exploded_step < 0; }

  __device__ void load_lengths(float* lengths) const {
    if constexpr (record_words == 1)
      for (std::uint32_t i = robot_.thread(); i < max_lengths; i += robot_.threads())
        lengths[i] = robot_.scale() * batch().lengths[std::size_t{robot_.context().robot} * max_lengths + i];
  }

  __device__ void load_state() {
    for (std::uint32_t tile = robot_.first_tile(); tile < robot_.last_tile(); tile += tiles_at_once)
      load_tiles(tile, min(tiles_at_once, robot_.last_tile() - tile));
    if constexpr (Memory::in_parts) {
      const std::uint32_t end = robot_.header().tiles + batch().parts.headers[blockIdx.x].ghost_tiles;
      for (std::uint32_t tile = robot_.header().tiles + robot_.context().warp; tile < end; tile += robot_.warps())
        load_tiles(tile, 1);
    }
  }

  __device__ void store_state() const {
    for (std::uint32_t tile = robot_.first_tile(); tile < robot_.last_tile(); ++tile) {
      if (Memory::in_parts && !robot_.has_mass(tile)) break;
      float* to = robot_.state(tile);
      for (std::uint32_t field = 0; field < state_fields; ++field)
        to[field * lanes] = robot_.own_mass(tile).value(field);
    }
  }

  // The robot's first thread stores when it exploded, if it did in this launch.
  __device__ void store_status() const {
    if (robot_.thread() != 0 || !record_->failure.happened()) return;
    if (robot_.part() != 0) return;  // all parts have the same failure
    batch().statuses[robot_.context().robot] = {robot_.arguments().clock.step + record_->failure.step(),
                                                record_->failure.bad_mass};
  }

  // After a report, which uses these fields.
  __device__ void clear_sums() const {
    for (std::uint32_t tile = robot_.first_tile(); tile < robot_.last_tile(); ++tile) robot_.own_mass(tile).set_sum(0);
  }

  // All threads of the block must call these, since they have barriers or are followed by one.
  __device__ void begin_contacts() { contacts_.begin(robot_, *record_); }
  __device__ float update_contacts(std::uint32_t step) const { return contacts_.update_list(robot_, *record_, step); }
  // At the end of the launch.
  __device__ void keep_contacts() const {
    if (robot_.arguments().launch.contact_buckets > 0) contacts_.keep_list(robot_, *record_);
  }
  // After update_contacts(), with what it returned.
  __device__ void use_contacts(float reach) { contacts_.use_list(reach); }
  __device__ bool contacts_stale(std::uint32_t step) const { return contacts_.stale(robot_, *record_, step); }

  // Loads early what add_environment() needs first.
  __device__ void prefetch_environment() {
    if constexpr (EnvironmentModel::has_faces) faces_.prefetch(robot_);
  }

  // Adds the forces that depend on more than one mass: perturbations, faces, contacts.
  __device__ void add_environment(std::uint32_t step) {
    if (record_->failure.before(step, phase_environment)) return;
    if (batch().perturbation_count > 0) add_perturbations();
    if constexpr (EnvironmentModel::has_faces)
      if (faces_act())
        faces_.add(robot_, model_, environment_scale(), step, dither_of_step(robot_.arguments().clock.step + step),
                   record_->failure);
    if constexpr (has_contacts) contacts_.add(robot_, *record_);
  }

  // Whether the forces of the environment are to be summed apart from those of springs, by accelerate().
  __device__ bool sums_apart() const {
    if constexpr (EnvironmentModel::real_bodies)
      return model_.sums_apart();
    else
      return false;
  }

  // Force solver: adds the forces of the environment to the velocity.
  __device__ void accelerate(std::uint32_t step) {
    if constexpr (EnvironmentModel::real_bodies) {
      if (record_->failure.before(step, phase_prediction)) return;
      const float inverse_scale = 1 / environment_scale();
      for (std::uint32_t tile = robot_.first_tile(); tile < robot_.last_tile(); ++tile) {
        if (!robot_.has_mass(tile)) continue;
        const Mass<Memory> mass = robot_.own_mass(tile);
        const Vec3 v = mass.vector(field_v);
        const Vec3 force = sum_of(mass, inverse_scale);
        mass.set_vector(field_v, accelerated(v, acceleration(force, v, point_at(tile)), constants()));
      }
    }
  }

  // XPBD: replaces the position by the prediction, and the velocity by v + dt F.
  __device__ void predict(std::uint32_t step) {
    if (record_->failure.before(step, phase_prediction)) return;
    const float inverse_scale = 1 / environment_scale();
    for (std::uint32_t tile = robot_.first_tile(); tile < robot_.last_tile(); ++tile) {
      if (!robot_.has_mass(tile)) continue;
      const Mass<Memory> mass = robot_.own_mass(tile);
      const Vec3 v = mass.vector(field_v);
      const Vec3 predicted = accelerated_by_sum(mass, inverse_scale, v, point_at(tile));
      store(step, phase_prediction, tile, multiply_add(constants().dt, predicted, mass.vector(field_x)), predicted);
    }
  }

  // Adds Algorithm 1's forces or Algorithm 2's corrections.
  __device__ void add_springs(std::uint32_t step) {
    if (record_->failure.before(step, phase_springs)) return;
    const float limit = robot_.header().squared_stretch_limit;
    const float longest = add_all_springs();
    // Padding counts in add_all() and may be long, so a failure is checked again without it.
    if (longest > limit && Springs::longest_spring(robot_.arguments(), robot_.context()) > limit)
      report_failure(step, phase_springs, Failure::never);
  }

  // Copies the state of this warp's masses to where other parts of the robot have ghosts of them. A barrier follows.
  __device__ void export_state() const {
    if constexpr (Memory::in_parts) {
      __syncwarp();
      const PartsView& parts = batch().parts;
      const std::uint32_t* const start = parts.export_start + robot_.chunk() * (batch().tile_stride + 1);
      const Export* const exports = parts.exports + robot_.chunk() * parts.export_stride;
      const bool moving = faces_act() || robot_.arguments().launch.viscous;
      const std::uint32_t end = __ldg(start + robot_.last_tile());
      for (std::uint32_t i = __ldg(start + robot_.first_tile()) + robot_.context().lane; i < end; i += lanes) {
        const uint2 packed = __ldg(reinterpret_cast<const uint2*>(exports + i));
        const Mass<Memory> mass = robot_.mass_at(packed.x & 0xffff);
        const auto ghost = Memory::of_part(robot_.mass_at(packed.x >> 16).at, packed.y);
        for (std::uint32_t field = field_x; field < (moving ? field_v + 3 : field_v); ++field)
          Memory::store_there(ghost, field * field_bytes, mass.value(field));
      }
    }
  }

  // Loads early what end() needs first from device memory.
  __device__ void prefetch_end() { next_point_ = point_at(robot_.first_tile()); }

  // After prefetch_end().
  __device__ void end(std::uint32_t step) {
    if (record_->failure.before(step, phase_end)) return;
    Distance farthest;
    // XPBD in water has the registers for two tiles at a time. Left alone, the choice of the compiler changes with
    // unrelated code.
#pragma unroll(solver == Solver::xpbd && Memory::on_chip && !has_contacts ? 2 : 1)
    for (std::uint32_t tile = robot_.first_tile(); tile < robot_.last_tile(); ++tile) {
      if (!robot_.has_mass(tile)) break;  // this lane has none in the last tile
      const Mass<Memory> mass = robot_.own_mass(tile);
      Vec3 x = mass.vector(field_x), v = mass.vector(field_v);
      const PointProperties point = next_point_;
      next_point_ = point_at(min(tile + 1, batch().tile_stride - 1));
      if constexpr (solver == Solver::force) {
        const float inverse_scale = 1 / robot_.header().force_scale;
        if (sums_apart())
          v = accelerated(v, point.inverse_inertia * sum_of(mass, inverse_scale), constants());
        else
          v = accelerated_by_sum(mass, inverse_scale, v, point);
        x = multiply_add(constants().dt, v, x);
      } else {
        Vec3 correction = sum_of(mass, 1 / robot_.header().correction_scale);
        if constexpr (EnvironmentModel::real_bodies) correction = point.inverse_inertia * correction;
        x = x + correction;
        v = multiply_add(constants().inverse_dt, correction, v);
      }
      if constexpr (EnvironmentModel::real_bodies)
        end_step(x, v, point.inverse_inertia, model_, end_constants());
      else
        end_step(x, v, model_, end_constants());
      if constexpr (has_contacts) farthest.add(mass, x);
      store(step, phase_end, tile, x, v);
    }
    if constexpr (has_contacts) contacts_.moved(farthest.bound(constants()));
  }

 private:
  // Tiles of which anything else than the state is on its way at the same time.
  static constexpr std::uint32_t tiles_at_once = 4;
  __device__ void load_tiles(std::uint32_t first, std::uint32_t count) {
    float valences[tiles_at_once];
#pragma unroll
    for (std::uint32_t i = 0; i < tiles_at_once; ++i) {
      const std::uint32_t tile = min(first + i, first + count - 1);
      if (i < count) copy_state(tile);
      if constexpr (solver == Solver::xpbd && Memory::keeps_valence)
        valences[i] = robot_.load_valence(robot_.own_slot(tile));
    }
#pragma unroll
    for (std::uint32_t i = 0; i < tiles_at_once; ++i) {
      if (i >= count) break;
      const Mass<Memory> mass = robot_.own_mass(first + i);
      mass.set_sum(0);
      if constexpr (solver == Solver::xpbd && Memory::keeps_valence) mass.set_value(field_valence, valences[i]);
    }
  }

  // A tile's fields of the state follow one another in both memories. Those of a part lie apart in device memory.
  __device__ void copy_state(std::uint32_t tile) const {
    if constexpr (Memory::in_parts) {
      const float* const from = robot_.state(tile);
      const Vec3 x{from[0], from[lanes], from[2 * lanes]}, v{from[3 * lanes], from[4 * lanes], from[5 * lanes]};
      robot_.own_mass(tile).set_vector(field_x, x);
      robot_.own_mass(tile).set_vector(field_v, v);
      return;
    }
    const std::uint32_t lane = robot_.context().lane;
    const auto to = robot_.own_mass(tile).at - 4 * lane;
    const float* const from = robot_.state(tile) - lane;
    for (std::uint32_t i = lane; i < state_fields * lanes / 4; i += lanes) Memory::copy(to + 16 * i, from + 4 * i);
  }

  __device__ bool faces_act() const {
    if constexpr (EnvironmentModel::has_faces)
      return model_.acts_on_faces();
    else
      return false;
  }

  // The longest |d|^2 of this thread's springs, padding included [m2].
  __device__ float add_all_springs() const {
    const Springs springs(robot_);
    if constexpr (EnvironmentModel::real_bodies)
      if (robot_.arguments().launch.viscous)
        return robot_.stored_header().relaxation_time < 0 ? springs.template add_all<Viscosity::by_material>()
                                                          : springs.template add_all<Viscosity::uniform>();
    return springs.template add_all<Viscosity::none>();
  }

  __device__ PointProperties point_at(std::uint32_t tile) const {
    if constexpr (EnvironmentModel::real_bodies)
      return robot_.point(tile);
    else
      return {};
  }
  // Of all forces on a mass, `force` being those that were summed [m/s2].
  __device__ Vec3 acceleration(Vec3 force, Vec3 v, const PointProperties& point) const {
    if constexpr (EnvironmentModel::real_bodies)
      return point.inverse_inertia * (force + model_.on_mass(v, point.weight));
    else
      return force + model_.on_mass(v);
  }

  // The velocity after all forces, of which `inverse_scale` newtons are a unit of the sum. That is a power of two:
  // multiplying by it is exact, so it does not matter when that happens.
  __device__ Vec3 accelerated_by_sum(const Mass<Memory>& mass, float inverse_scale, Vec3 v,
                                     const PointProperties& point) const {
    if constexpr (EnvironmentModel::still_water)
      return multiply_add(constants().dt * inverse_scale, sum_of(mass, 1), v);
    else
      return accelerated(v, acceleration(sum_of(mass, inverse_scale), v, point), constants());
  }

  __device__ const BatchView& batch() const { return robot_.arguments().batch; }
  __device__ const StepConstants& constants() const { return robot_.arguments().constants; }
  __device__ StepConstants end_constants() const {
    StepConstants own = constants();
    if constexpr (requires { model_.drift; }) own.drift = model_.drift;
    return own;
  }

  __device__ void add_perturbations() {
    if (robot_.thread() != 0) return;
    for (std::uint32_t p = 0; p < batch().perturbation_count; ++p) {
      const DevicePerturbation& perturbation = batch().perturbations[p];
      if (perturbation.robot != robot_.context().robot) continue;
      std::uint32_t slot = perturbation.slot;
      if constexpr (Memory::in_parts) {
        const std::uint32_t place = robot_.place_of(slot);
        if (place >> 16 != robot_.part()) continue;
        slot = place & 0xffff;
      }
      const Vec3 units =
          perturbation.stiffness * environment_scale() * (perturbation.target - robot_.mass_at(slot).vector(field_x));
      if (fits(units)) robot_.mass_at(slot).add_to_sum(units);
    }
  }

  // How far masses move in a step at most. In XPBD, working memory has their predictions and predicted velocities.
  struct Distance {
    float squared_step = 0, squared_speed = 0;  // [m2], [m2/s2]

    __device__ void add(const Mass<Memory>& mass, Vec3 x) {
      squared_step = fmaxf(squared_step, squared_length(x - mass.vector(field_x)));
      if constexpr (solver == Solver::xpbd) squared_speed = fmaxf(squared_speed, squared_length(mass.vector(field_v)));
    }
    __device__ float bound(const StepConstants& constants) const {
      return sqrtf(squared_step) + (solver == Solver::xpbd ? constants.dt * sqrtf(squared_speed) : 0);
    }
  };

  // Units per newton of what add_environment() adds.
  __device__ float environment_scale() const {
    if constexpr (EnvironmentModel::real_bodies)
      return robot_.header().environment_scale;
    else
      return robot_.header().force_scale;
  }

  __device__ static Vec3 sum_of(const Mass<Memory>& mass, float inverse_scale) {
    return {static_cast<float>(mass.take_sum(0)) * inverse_scale, static_cast<float>(mass.take_sum(1)) * inverse_scale,
            static_cast<float>(mass.take_sum(2)) * inverse_scale};
  }

  __device__ void report_failure(std::uint32_t step, Phase phase, std::uint32_t mass) {
    record_->failure.report<Memory>(robot_.arguments().launch, step, phase, mass);
  }

  // Stores a mass's new state if it is finite. If not, the mass stays where it is, and the robot has exploded.
  __device__ void store(std::uint32_t step, Phase phase, std::uint32_t tile, Vec3 x, Vec3 v) {
    if (within_reach(x)) {
      robot_.own_mass(tile).set_vector(field_x, x);
      robot_.own_mass(tile).set_vector(field_v, v);
    } else {
      report_failure(step, phase, robot_.number_of(robot_.own_slot(tile)));
    }
  }

  const Robot robot_;
  const EnvironmentModel& model_;
  PointProperties next_point_;  // of the tile that end() comes to next
  // Kernels of real bodies have no register left for a pair, and would wait to store it elsewhere.
  FacePass<!EnvironmentModel::real_bodies> faces_;
  ContactPass<Robot> contacts_;
  RobotRecord* const record_;
};

}  // namespace mercury::cuda
