// SPDX-License-Identifier: Apache-2.0
// When the robots begin that an evaluator gets while it steps others.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "bodies.h"
#include "evaluations.h"
#include "mercury/error.h"
#include "mercury/evaluator.h"
#include "plain_backend.h"
#include "tests/nap.h"

namespace mercury {
namespace {

constexpr std::size_t at_once = 8;

// What the devices of a test have in common. Robots of the first batch are `early`, others `late`.
struct Course {
  const std::shared_ptr<const Robot> early = std::make_shared<Robot>(bodies::point()),
                                     late = std::make_shared<Robot>(bodies::point());
  std::int64_t last_alone = 0;  // early robots make no more steps than these until late ones have begun
  bool fails = false;           // the device, when early robots have made those steps
  std::atomic<bool> early_are_loaded = false, late_are_loaded = false, late_have_begun = false;
  std::atomic<std::int64_t> early_steps = 0, early_steps_when_late_began = -1;

  RobotSource source(std::size_t count) const {
    return [this, count](std::size_t i) { return i < count ? early : late; };
  }
};

void raise(std::atomic<bool>& flag) {
  flag = true;
  flag.notify_all();
}

class CourseBackend final : public test::PlainBackend {
 public:
  explicit CourseBackend(Course& course) : course_(course) {}
  std::size_t robots_at_once() const override { return at_once; }
  void load(std::span<const Robot* const> robots, const Configuration& configuration) override {
    PlainBackend::load(robots, configuration);
    first_ = robots.empty() ? nullptr : robots.front();
    if (first_ == course_.early.get()) raise(course_.early_are_loaded);
    if (first_ == course_.late.get()) raise(course_.late_are_loaded);
  }
  void step(const Clock& clock, std::int64_t steps) override {
    if (first_ == course_.late.get()) {
      std::int64_t none = -1;
      course_.early_steps_when_late_began.compare_exchange_strong(none, course_.early_steps);
      raise(course_.late_have_begun);
    } else if (clock.step == course_.last_alone) {
      if (course_.fails) throw DeviceError("the device fell off the bus");
      course_.late_have_begun.wait(false);
    } else {
      test::nap();  // late robots that may begin do
    }
    PlainBackend::step(clock, steps);
    if (first_ == course_.early.get()) course_.early_steps += steps;
  }

 private:
  Course& course_;
  const Robot* first_ = nullptr;
};

EvaluationRequest batches_of_points(int workers) {
  EvaluationRequest request = usual(OceanSimple{});
  request.settling = 0;
  request.steps = 160;
  request.sample_every = 10;
  request.portion = at_once;
  request.workers = workers;
  request.grows = true;
  return request;
}

std::vector<Evaluator::MakeBackend> device_of(Course& course) {
  return {[&] { return std::make_unique<CourseBackend>(course); }};
}

TEST(EvaluatorBatches, ABatchBeginsWhenThoseBeforeItHaveNextToNoStepsLeft) {
  // An eighth of 8 robots' steps: of two portions of 8 after step 150 of 160, of one of 4 after step 120.
  struct Case {
    std::size_t early, portions;
    std::int64_t last_alone;
  };
  for (const Case& one : {Case{2 * at_once, 2, 150}, Case{at_once / 2, 1, 120}}) {
    Course course{.last_alone = one.last_alone};
    Evaluator evaluator(batches_of_points(3), course.source(one.early), one.early, device_of(course));
    course.early_are_loaded.wait(false);  // else one portion may have robots of both batches
    evaluator.extend(at_once);
    EXPECT_EQ(rest_of(evaluator).size(), one.early + at_once);
    EXPECT_EQ(course.early_steps_when_late_began, static_cast<std::int64_t>(one.portions) * one.last_alone);
  }
}

TEST(EvaluatorBatches, ABatchDoesNotWaitForATinyOrALargeOne) {
  for (const std::size_t early : {std::size_t{1}, 3 * at_once + 1}) {
    Course course{.last_alone = 0};
    Evaluator evaluator(batches_of_points(5), course.source(early), early, device_of(course));
    course.early_are_loaded.wait(false);
    evaluator.extend(at_once);
    EXPECT_EQ(rest_of(evaluator).size(), early + at_once);
    EXPECT_EQ(course.early_steps_when_late_began, 0);
  }
}

TEST(EvaluatorBatches, StopLeavesOutABatchThatWaits) {
  Course course{.last_alone = 20};
  Evaluator evaluator(batches_of_points(3), course.source(2 * at_once), 2 * at_once, device_of(course));
  evaluator.extend(at_once);
  course.late_are_loaded.wait(false);
  while (course.early_steps < 2 * course.last_alone) test::nap();
  evaluator.stop();
  raise(course.late_have_begun);
  EXPECT_EQ(rest_of(evaluator).size(), 2 * at_once);
  EXPECT_EQ(course.early_steps_when_late_began, -1);
}

TEST(EvaluatorBatches, ABatchDoesNotWaitForOneThatFailed) {
  Course course{.last_alone = 20, .fails = true};
  Evaluator evaluator(batches_of_points(3), course.source(2 * at_once), 2 * at_once, device_of(course));
  evaluator.extend(at_once);
  EXPECT_THROW(rest_of(evaluator), DeviceError);
}

}  // namespace
}  // namespace mercury
