// SPDX-License-Identifier: Apache-2.0
#include "app/base/suggestion.h"

#include <gtest/gtest.h>

namespace mercury::test {
namespace {

const std::vector<std::string> names{"--seconds", "--seed", "--solver", "--damping", "--density"};

TEST(Suggestion, NamesTheNearestOption) {
  EXPECT_EQ(suggestion("--secnds", names), "; did you mean --seconds?");
  EXPECT_EQ(suggestion("--sede", names), "; did you mean --seed?");
  EXPECT_EQ(suggestion("--dam", names), "; did you mean --damping?");
}

TEST(Suggestion, IsEmptyWhenNothingIsNear) {
  EXPECT_EQ(suggestion("--frobnicate", names), "");
  EXPECT_EQ(suggestion("x", {}), "");
}

}  // namespace
}  // namespace mercury::test
