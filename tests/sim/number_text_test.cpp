// SPDX-License-Identifier: Apache-2.0
#include "mercury/number_text.h"

#include <gtest/gtest.h>

namespace mercury {
namespace {

TEST(NumberText, AFloatIsTheShortestDecimalThatReadsBack) {
  EXPECT_EQ(shortest(0.2f), 0.2);
  EXPECT_EQ(shortest_text(0.2f), "0.2");
  EXPECT_EQ(shortest_text(-16777216.0f), "-16777216");
  EXPECT_EQ(shortest_text(1e20f), "1e+20");
}

TEST(NumberText, OnlyATextThatIsANumberToItsEndIsParsed) {
  EXPECT_EQ(parse_number<int>("-12"), -12);
  EXPECT_EQ(parse_number<double>("1e-3"), 1e-3);
  EXPECT_EQ(parse_number<unsigned>("ff", 16), 255u);
  for (const char* text : {"", " 1", "1 ", "+1", "1.5", "x", "99999999999"})
    EXPECT_EQ(parse_number<int>(text), std::nullopt) << text;
  EXPECT_EQ(parse_number<unsigned>("-1"), std::nullopt);
}

}  // namespace
}  // namespace mercury
