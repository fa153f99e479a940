// SPDX-License-Identifier: Apache-2.0
// Finding texts by some letters, and the part of a plot that is shown.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

std::string best_of(std::string_view query, const std::vector<std::string>& texts) {
  std::string best;
  int most = -1'000'000;
  for (const std::string& text : texts)
    if (const auto score = fuzzy_match(query, text); score && *score > most) {
      most = *score;
      best = text;
    }
  return best;
}

TEST(FuzzyMatch, LettersMustAppearInOrderInAnyCase) {
  EXPECT_TRUE(fuzzy_match("dpl", "Duplicate"));
  EXPECT_TRUE(fuzzy_match("DUP", "duplicate"));
  EXPECT_TRUE(fuzzy_match("sel all", "select all"));
  EXPECT_FALSE(fuzzy_match("lpd", "duplicate"));
  EXPECT_FALSE(fuzzy_match("duplicates", "duplicate"));
  EXPECT_FALSE(fuzzy_match("a", ""));
  EXPECT_EQ(fuzzy_match("", "anything"), fuzzy_match("", "x"));
}

TEST(FuzzyMatch, BeginningsAndRunsOfLettersComeFirst) {
  EXPECT_EQ(best_of("undo", {"sound of water", "undo", "undo everything"}), "undo");
  EXPECT_EQ(best_of("ts", {"fastest", "time step", "lots"}), "time step");
  EXPECT_EQ(best_of("ray", {"array", "ray", "drag by"}), "ray");
  EXPECT_EQ(best_of("dra", {"damping ratio", "drag arrows", "add radius"}), "drag arrows");
}

TEST(WordsMatch, EachWordBeginsAWordInAnyOrder) {
  EXPECT_TRUE(words_match("race", "layout race: one lane each"));
  EXPECT_TRUE(words_match("ra LAY", "layout race: one lane each"));
  EXPECT_TRUE(words_match("", "anything"));
  EXPECT_TRUE(words_match("  one ", "layout race: one lane each"));
  EXPECT_FALSE(words_match("ace", "layout race: one lane each"));
  EXPECT_FALSE(words_match("race two", "layout race: one lane each"));
  EXPECT_FALSE(words_match("open", ""));
}

TEST(FuzzyMatch, LongAndStrangeTextsEnd) {
  EXPECT_FALSE(fuzzy_match(std::string(5000, 'b'), std::string(5000, 'a')));
  EXPECT_TRUE(fuzzy_match("\xc3\xa9", "caf\xc3\xa9"));
}

TEST(PlotView, ZoomKeepsThePointUnderTheMouseAndStaysInside) {
  PlotView view;
  view.zoom(4, 0.5, 0, 10);
  ASSERT_TRUE(view.range);
  EXPECT_NEAR(view.range->second - view.range->first, 5, 1e-12);
  EXPECT_NEAR((4 - view.range->first) / 5, 0.4, 1e-12);
  view.zoom(view.range->first, 0.5, 0, 10);
  EXPECT_NEAR(view.range->first, 2, 1e-12);
  view.pan(100, 0, 10);
  EXPECT_NEAR(view.range->second, 10, 1e-12);
  view.pan(-100, 0, 10);
  EXPECT_NEAR(view.range->first, 0, 1e-12);
  view.zoom(1, 100, 0, 10);
  EXPECT_FALSE(view.range);
  for (int i = 0; i < 500; ++i) view.zoom(5, 0.5, 0, 10);
  EXPECT_GT(view.range->second, view.range->first);
}

}  // namespace
}  // namespace mercury::window
