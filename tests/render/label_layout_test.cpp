// SPDX-License-Identifier: Apache-2.0
// Names cover neither each other nor other bodies, and there are few of them when there are many bodies.
#include "render/text/label_layout.h"

#include <gtest/gtest.h>

#include <random>

namespace mercury::render {
namespace {

constexpr Rectangle picture{0, 0, 1280, 720};

bool meet(const Rectangle& a, const Rectangle& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

std::vector<LabelRequest> scattered(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> x(0, 1200), y(0, 660);
  std::vector<LabelRequest> requests;
  for (int i = 0; i < count; ++i)
    requests.push_back({.body = {x(random), y(random), 60, 40},
                        .width = 110,
                        .height = 36,
                        .depth = 5,
                        .priority = static_cast<float>(i)});
  return requests;
}

TEST(LabelLayout, NoNameCoversAnother) {
  for (const int count : {6, 12, 24, 200}) {
    const auto placed = place_labels(scattered(count, 7), picture);
    for (std::size_t a = 0; a < placed.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        EXPECT_FALSE(placed[a] && placed[b] && meet(*placed[a], *placed[b])) << a << ' ' << b << " of " << count;
  }
}

TEST(LabelLayout, NoNameHidesARobot) {
  const auto requests = scattered(12, 3);
  const auto placed = place_labels(requests, picture);
  for (const auto& name : placed)
    for (const LabelRequest& other : requests) {
      if (!name || !meet(*name, other.body)) continue;
      const float width = std::min(name->x + name->width, other.body.x + other.body.width) -
                          std::max(name->x, other.body.x),
                  height = std::min(name->y + name->height, other.body.y + other.body.height) -
                           std::max(name->y, other.body.y);
      EXPECT_LT(width * height, 0.3f * other.body.width * other.body.height);
    }
}

TEST(LabelLayout, NamesStayInThePicture) {
  for (const auto& name : place_labels(scattered(24, 5), picture)) {
    if (!name) continue;
    EXPECT_GE(name->x, 0);
    EXPECT_GE(name->y, 0);
    EXPECT_LE(name->x + name->width, picture.width);
    EXPECT_LE(name->y + name->height, picture.height);
  }
}

TEST(LabelLayout, OfManyOnlyTheBestTenAndTheChosenOnesAreNamed) {
  auto requests = scattered(200, 11);
  for (LabelRequest& request : requests) request.body.width = request.body.height = 1;
  requests[3].forced = requests[8].forced = true;
  const auto placed = place_labels(requests, picture);
  EXPECT_TRUE(placed[3]);
  EXPECT_TRUE(placed[8]);
  for (std::size_t i = 0; i < 190; ++i) EXPECT_EQ(placed[i].has_value(), i == 3 || i == 8) << i;
  int best = 0;
  for (std::size_t i = 190; i < 200; ++i) best += placed[i].has_value();
  EXPECT_GE(best, 8) << "bodies of one pixel leave room for nearly all";
}

TEST(LabelLayout, NamesLeaveWhatIsCoveredFree) {
  const std::vector<LabelRequest> one{{.body = {600, 300, 80, 60}, .width = 100, .height = 20, .forced = true}};
  const Rectangle above{0, 200, 1280, 100}, below{0, 360, 1280, 360}, sides{0, 300, 600, 60}, all{0, 0, 1280, 720};
  const auto at = [&](std::vector<Rectangle> covered) { return place_labels(one, picture, covered)[0]; };
  ASSERT_TRUE(at({above}));
  EXPECT_EQ(at({above})->y, 360) << "below its body";
  ASSERT_TRUE(at({above, below, sides}));
  EXPECT_EQ(at({above, below, sides})->x, 680) << "at its right";
  EXPECT_FALSE(at({all}));
}

TEST(LabelLayout, TheNameOfALoneRobotIsAboveIt) {
  const std::vector<LabelRequest> one{{.body = {600, 300, 80, 60}, .width = 100, .height = 20}};
  const auto placed = place_labels(one, picture);
  ASSERT_TRUE(placed[0]);
  EXPECT_EQ(placed[0]->y + placed[0]->height, 300);
  EXPECT_EQ(placed[0]->x + 50, 640);
}

}  // namespace
}  // namespace mercury::render
