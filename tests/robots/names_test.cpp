// SPDX-License-Identifier: Apache-2.0
#include "mercury/names.h"

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

TEST(Names, AreListed) {
  EXPECT_EQ(list_of({}), "");
  EXPECT_EQ(list_of({"a"}, " or "), "a");
  EXPECT_EQ(list_of({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(list_of({"a", "b", "c"}, " or "), "a, b or c");
}

}  // namespace
}  // namespace mercury::test
