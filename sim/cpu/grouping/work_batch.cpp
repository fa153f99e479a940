// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/grouping/work_batch.h"

#include <algorithm>
#include <utility>

#include "sim/cpu/grouping/cost_model.h"
#include "sim/cpu/grouping/group_plan.h"
#include "sim/physics/environments.h"

namespace mercury::cpu {
namespace {

// Fills one batch after the other.
class BatchFiller {
 public:
  explicit BatchFiller(std::size_t max_bodies) : max_bodies_(max_bodies) {}

  // The batch for the next bodies: how many, the muscles that they may have, and the bytes that their steps touch.
  WorkBatch& batch_for(std::size_t bodies, std::size_t muscles, std::size_t bytes) {
    if (batches_.empty() || bodies_ + bodies > max_bodies_ || muscles_ + muscles > limits.batch_muscles ||
        bytes_ + bytes > limits.batch_bytes) {
      batches_.emplace_back();
      bodies_ = muscles_ = bytes_ = 0;
    }
    bodies_ += bodies;
    muscles_ += muscles;
    bytes_ += bytes;
    return batches_.back();
  }
  std::vector<WorkBatch> take() { return std::move(batches_); }

 private:
  std::size_t max_bodies_, bodies_ = 0, muscles_ = 0, bytes_ = 0;
  std::vector<WorkBatch> batches_;
};

std::size_t max_muscles_of(const Body& body) {
  return static_cast<std::size_t>(std::ranges::count(body.measures.used, true));
}

}  // namespace

std::vector<WorkBatch> make_work_batches(std::span<const Body> bodies, std::size_t threads,
                                         const Configuration& configuration) {
  std::vector<GroupPlan> plans = plan_lockstep_groups(bodies, threads, configuration);
  const bool contacts = has_contacts(configuration.environment);
  std::vector<bool> is_member(bodies.size());
  BatchFiller filler(std::max<std::size_t>(1, bodies.size() / (limits.batches_per_thread * threads)));
  for (GroupPlan& plan : plans) {
    std::size_t muscles = 0;
    for (const std::size_t i : plan.bodies) {
      is_member[i] = true;
      muscles += max_muscles_of(bodies[i]);
    }
    const std::size_t bytes = footprint(*plan.merged.topology, bodies[plan.bodies.front()].slots.lanes);
    WorkBatch& batch = filler.batch_for(plan.bodies.size(), muscles, bytes);
    batch.groups.push_back(make_lockstep_group(bodies, std::move(plan.bodies), std::move(plan.merged), contacts));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (!is_member[i]) filler.batch_for(1, max_muscles_of(bodies[i]), footprint(bodies[i])).bodies.push_back(i);
  return filler.take();
}

}  // namespace mercury::cpu
