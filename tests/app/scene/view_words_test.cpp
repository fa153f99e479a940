// SPDX-License-Identifier: Apache-2.0
// The words that describe a picture, and the messages for those that cannot be used.
#include "app/scene/view_words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/refusal.h"

namespace mercury::test {
namespace {

TEST(ViewWords, WithoutWordsSettingsHaveTheirDefaults) {
  const ViewSettings settings = view_settings({});
  EXPECT_EQ(settings.color, &material_color());
  EXPECT_EQ(settings.theme, render::Theme::dark);
  EXPECT_EQ(settings.layout, Layout::grid);
  EXPECT_EQ(settings.camera.mode, CameraMode::group);
  EXPECT_TRUE(settings.shown.skin && settings.shown.clock);
  EXPECT_FALSE(settings.shown.legend || settings.shown.springs || settings.cut || settings.grid);
}

TEST(ViewWords, WordsBecomeSettings) {
  const ViewSettings settings = view_settings({.color = "strain",
                                               .scale = std::pair(-1.0f, 2.0f),
                                               .colormap = "cividis",
                                               .log_scale = true,
                                               .caption = "eels",
                                               .theme = "light",
                                               .plain = true,
                                               .cut = "-y:25%",
                                               .grid = Grid{3, 2},
                                               .camera = "turntable",
                                               .azimuth = 180.0f,
                                               .zoom = 2.0f});
  EXPECT_EQ(settings.color, &color_quantity("strain"));
  EXPECT_EQ(settings.scale, std::pair(-1.0f, 2.0f));
  EXPECT_EQ(settings.colormap, render::Colormap::cividis);
  EXPECT_TRUE(settings.log_scale);
  EXPECT_EQ(settings.caption, "eels");
  EXPECT_EQ(settings.theme, render::Theme::light);
  EXPECT_TRUE(settings.plain);
  EXPECT_EQ(settings.cut, (render::Cut{.axis = 1, .below = true, .percent = 25}));
  EXPECT_EQ(settings.grid->columns, 3);
  EXPECT_EQ(settings.camera.mode, CameraMode::turntable);
  EXPECT_FLOAT_EQ(settings.camera.azimuth.value(), std::numbers::pi_v<float>);
  EXPECT_EQ(settings.camera.zoom, 2);
  EXPECT_TRUE(settings.shown.legend) << "values need a legend";
}

TEST(ViewWords, ACutIsAShareOfEachRobotOrMetersFromItsMiddle) {
  const auto cut = [](const char* text) { return view_settings({.cut = text}).cut.value(); };
  EXPECT_EQ(cut("x"), (render::Cut{.axis = 0, .percent = 50}));
  EXPECT_EQ(cut("z:0%"), (render::Cut{.axis = 2, .percent = 0}));
  EXPECT_EQ(cut("-x:12.5%"), (render::Cut{.axis = 0, .below = true, .percent = 12.5f}));
  // As files before percentages have it.
  EXPECT_EQ(cut("y:-0.25"), (render::Cut{.axis = 1, .percent = 50, .shift = -0.25f}));
}

TEST(ViewWords, ShowIsExact) {
  const Shown shown = view_settings({.color = "strain", .show = "springs,labels,drag"}).shown;
  EXPECT_TRUE(shown.springs && shown.labels && shown.arrows.drag);
  EXPECT_FALSE(shown.skin || shown.clock || shown.legend || shown.arrows.lift);
}

TEST(ViewWords, ErrorsNameTheParameter) {
  const auto refused = [](const std::function<void(ViewWords&)>& change) {
    ViewWords words;
    change(words);
    EXPECT_EQ(refusal([&] { view_settings(words); }).find('\n'), std::string::npos);
    return refused_parameter([&] { view_settings(words); });
  };
  EXPECT_EQ(refused([](ViewWords& w) { w.color = "mood"; }), "color");
  EXPECT_EQ(refused([](ViewWords& w) { w.colormap = "jet"; }), "colormap");
  EXPECT_EQ(refused([](ViewWords& w) { w.theme = "pink"; }), "theme");
  EXPECT_EQ(refused([](ViewWords& w) { w.layout = "heap"; }), "layout");
  EXPECT_EQ(refused([](ViewWords& w) { w.camera = "drone"; }), "camera");
  for (const char* show : {"bones", "", "skin,", "skin,,clock", "skin clock"})
    EXPECT_EQ(refused([&](ViewWords& w) { w.show = show; }), "show") << show;
  for (const char* cut : {"w", "", "-", "xy", "y:", "y:%", "y:here", "y:0.2m", "y:nan", "y:nan%", "y:101%", "y:-1%"})
    EXPECT_EQ(refused([&](ViewWords& w) { w.cut = cut; }), "cut") << cut;
  for (const auto& scale : {std::pair(1.0f, 1.0f), std::pair(2.0f, 1.0f), std::pair(0.0f, INFINITY)})
    EXPECT_EQ(refused([&](ViewWords& w) { w.scale = scale; }), "scale");
  for (const float length : {0.0f, -1.0f, 1000.0f, NAN})
    EXPECT_EQ(refused([&](ViewWords& w) { w.arrow_length = length; }), "arrow_length") << length;
  for (const float density : {0.0f, 1.5f, NAN})
    EXPECT_EQ(refused([&](ViewWords& w) { w.arrow_density = density; }), "arrow_density") << density;
  for (const float threshold : {-0.1f, 1.5f, NAN})
    EXPECT_EQ(refused([&](ViewWords& w) { w.arrow_threshold = threshold; }), "arrow_threshold") << threshold;
  EXPECT_EQ(refused([](ViewWords& w) { w.grid = Grid{0, 3}; }), "grid");
  EXPECT_EQ(refused([](ViewWords& w) { w.azimuth = NAN; }), "azimuth");
  EXPECT_EQ(refused([](ViewWords& w) { w.elevation = 91.0f; }), "elevation");
  EXPECT_EQ(refused([](ViewWords& w) { w.zoom = 0.0f; }), "zoom");
  EXPECT_EQ(refused([](ViewWords& w) {
              w.layout = "race";
              w.grid = Grid{2, 2};
            }),
            "grid");
}

TEST(ViewWords, WhatIsShownIsWrittenAsItIsRead) {
  for (const std::string& word : shown_words()) EXPECT_EQ(shown_text(shown_from(word)), word);
  EXPECT_EQ(shown_text(Shown{}), "skin,clock");
  EXPECT_EQ(shown_text(shown_from("nothing")), "nothing");
  EXPECT_EQ(shown_text(Shown{.arrows = {.contact = true, .force = true}}), "skin,contact,force,clock");
}

}  // namespace
}  // namespace mercury::test
