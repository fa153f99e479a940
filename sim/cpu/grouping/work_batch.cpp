// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/grouping/work_batch.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "mercury/parallel.h"
#include "mercury/work_counter.h"
#include "sim/cpu/grouping/cost_model.h"
#include "sim/cpu/grouping/group_plan.h"

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

std::vector<LockstepGroup> make_groups(std::span<Body* const> bodies, std::vector<GroupPlan>& plans, bool contacts,
                                       const WorkWatch& watch) {
  std::vector<LockstepGroup> groups(plans.size());
  WorkCounter counter(watch, "grouping robots", plans.size());
  parallel_for(0, plans.size(), [&](std::size_t g) {
    std::vector<Body*> members;
    for (const std::size_t i : plans[g].bodies) members.push_back(bodies[i]);
    groups[g] = make_lockstep_group(std::move(members), std::move(plans[g].merged), contacts);
    counter.add_one();
  });
  return groups;
}

}  // namespace

std::vector<WorkBatch> make_work_batches(std::span<Body* const> bodies, std::size_t threads,
                                         const Configuration& configuration, const WorkWatch& watch) {
  std::vector<GroupPlan> plans = plan_lockstep_groups(bodies, threads, configuration, watch);
  const bool contacts = has_contacts(configuration.environment);
  std::vector<std::uint8_t> is_member(bodies.size());
  for (const GroupPlan& plan : plans)
    for (const std::size_t i : plan.bodies) is_member[i] = 1;
  WorkCounter counter(watch, "scheduling springs", bodies.size());
  parallel_for(0, bodies.size(), [&](std::size_t i) {
    if (contacts) prepare_contacts(*bodies[i]);
    if (!is_member[i]) prepare_to_step_alone(*bodies[i]);
    counter.add_one();
  });

  BatchFiller filler(std::max<std::size_t>(1, bodies.size() / (limits.batches_per_thread * threads)));
  for (LockstepGroup& group : make_groups(bodies, plans, contacts, watch)) {
    std::size_t muscles = 0;
    for (const Body* body : group.bodies) muscles += max_muscles_of(*body);
    const std::size_t bytes = footprint(*group.topology, group.lanes);
    filler.batch_for(group.bodies.size(), muscles, bytes).groups.push_back(std::move(group));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (!is_member[i])
      filler.batch_for(1, max_muscles_of(*bodies[i]), footprint(*bodies[i])).bodies.push_back(bodies[i]);
  return filler.take();
}

std::vector<Body*> take_out(const std::unordered_set<const Body*>& bodies, std::vector<WorkBatch>& batches) {
  const auto is_out = [&](const Body* body) { return bodies.contains(body); };
  std::vector<Body*> loose;
  for (WorkBatch& batch : batches) {
    std::erase_if(batch.bodies, is_out);
    for (LockstepGroup& group : batch.groups) {
      if (std::ranges::none_of(group.bodies, is_out)) continue;
      store(group);
      std::ranges::copy_if(group.bodies, std::back_inserter(loose), std::not_fn(is_out));
      group = {};
    }
  }
  std::erase_if(batches, [](const WorkBatch& batch) {
    return batch.bodies.empty() &&
           std::ranges::all_of(batch.groups, [](const LockstepGroup& group) { return group.bodies.empty(); });
  });
  return loose;
}

}  // namespace mercury::cpu
