// SPDX-License-Identifier: Apache-2.0
#include "app/scene/camera_plan.h"

#include "mercury/error.h"
#include "tests/app/program.h"
#include "tests/refusal.h"

namespace mercury::test {
namespace {

class CameraFile : public FolderTest {};

TEST_F(CameraFile, LoadsWhatWasSaved) {
  const CameraPlan plan{.mode = CameraMode::still,
                        .robot = "eel",
                        .azimuth = 0.1f,
                        .elevation = -0.25f,
                        .zoom = 2,
                        .field_of_view = 0.4f,
                        .period = 8,
                        .target = render::Vector3(1, -2, 0.3f),
                        .distance = 7};
  save_camera(path("a.json"), plan);
  const CameraPlan loaded = load_camera(path("a.json"));
  EXPECT_EQ(loaded.mode, plan.mode);
  EXPECT_EQ(loaded.robot, plan.robot);
  EXPECT_EQ(loaded.azimuth, plan.azimuth);
  EXPECT_EQ(loaded.elevation, plan.elevation);
  EXPECT_EQ(loaded.zoom, plan.zoom);
  EXPECT_EQ(loaded.field_of_view, plan.field_of_view);
  EXPECT_EQ(loaded.period, plan.period);
  EXPECT_EQ(loaded.target, plan.target);
  EXPECT_EQ(loaded.distance, plan.distance);
}

TEST_F(CameraFile, MissingMembersHaveDefaults) {
  write("a.json", R"({"format": "mercury-camera", "version": 1})");
  EXPECT_EQ(load_camera(path("a.json")).mode, CameraMode::group);
  EXPECT_FALSE(load_camera(path("a.json")).azimuth.has_value());
}

TEST_F(CameraFile, ErrorsNameTheMember) {
  const auto message = [&](const std::string& text) -> std::string {
    write("a.json", text);
    return refusal([&] { load_camera(path("a.json")); });
  };
  const std::string file = path("a.json");
  const std::string start = R"({"format": "mercury-camera", "version": 1, )";
  EXPECT_EQ(message("no json"), file + ": is not a camera file; its \"format\" must be \"mercury-camera\"");
  EXPECT_EQ(message("[1, 2]"), file + ": is not a camera file; its \"format\" must be \"mercury-camera\"");
  EXPECT_EQ(message(R"({"format": "mercury-camera", "version": 2})"), file + ": /version must be 1");
  EXPECT_EQ(message(start + R"("mode": "drone"})"),
            file + ": /mode must be one of group, follow, turntable, top, still");
  EXPECT_EQ(message(start + R"("zoom": 0})"), file + ": /zoom must be above 0");
  EXPECT_EQ(message(start + R"("azimuth": "west"})"), file + ": /azimuth is not a number");
  EXPECT_EQ(message(start + R"("target": [1, 2]})"), file + ": /target is not a list of three numbers");
}

TEST(CameraNamed, AcceptsModesAndARobotToFollow) {
  EXPECT_EQ(camera_named("turntable").mode, CameraMode::turntable);
  EXPECT_EQ(camera_named("follow").robot, "");
  EXPECT_EQ(camera_named("follow:eel").robot, "eel");
  EXPECT_THROW(camera_named("top:eel"), InputError);
  EXPECT_THROW(camera_named("drone"), InputError);
  EXPECT_THROW(camera_named("missing.json"), InputError);
}

TEST(CameraBookmarks, AreReadAsTheyWereWritten) {
  CameraBookmarks bookmarks;
  bookmarks[1] = CameraPlan{.mode = CameraMode::still,
                            .azimuth = 0.25f,
                            .elevation = -0.5f,
                            .target = render::Vector3(1, 2, 3),
                            .distance = 4.5f};
  bookmarks[3] = CameraPlan{.mode = CameraMode::follow, .robot = "eel \"2\""};
  const CameraBookmarks read = bookmarks_from(bookmarks_text(bookmarks));
  EXPECT_FALSE(read[0]);
  EXPECT_FALSE(read[2]);
  ASSERT_TRUE(read[1] && read[3]);
  EXPECT_EQ(read[1]->mode, CameraMode::still);
  EXPECT_EQ(read[1]->azimuth, 0.25f);
  EXPECT_EQ(read[1]->distance, 4.5f);
  EXPECT_EQ(*read[1]->target, render::Vector3(1, 2, 3));
  EXPECT_EQ(read[3]->robot, "eel \"2\"");
  EXPECT_EQ(bookmarks_text({}), "");
}

TEST(CameraBookmarks, WhatIsNoListOfCamerasIsRefused) {
  for (const char* text : {"", "{}", "[1]", "[[]]", "[null,null,null,null,null]", R"([{"mode":"fly"}])",
                           R"([{"zoom":0}])", R"([{"target":[1,2]}])", "[{", R"([{"distance":1e99}])"})
    EXPECT_THROW(bookmarks_from(text), ParameterError) << text;
}

}  // namespace
}  // namespace mercury::test
