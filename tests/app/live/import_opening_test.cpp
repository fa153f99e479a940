// SPDX-License-Identifier: Apache-2.0
// Files of other simulators that are opened in the window or dropped on it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/live/scene_robots.h"
#include "tests/app/live/live_scene_setup.h"
#include "tests/app/program.h"
#include "tests/robots/importers/documents.h"

namespace mercury {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

class LiveImports : public test::FolderTest {};

TEST_F(LiveImports, RobotsOfOtherSimulatorsAreOpenedAndTheirReportIsSummedUp) {
  write("crawler.vxa", VxaParts{}.text());
  write("bad.vxa", "<VXA/>");
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {path("crawler.vxa"), path("bad.vxa")});
  EXPECT_THAT(test::names_of(scene), ElementsAre("crawler"));
  EXPECT_EQ(*scene.document().robots[0].body.robot, import_file(path("crawler.vxa")).robots.front());
  EXPECT_TRUE(scene.robots().entries()[0].unsaved);
  const auto messages = scene.take_messages();
  ASSERT_THAT(messages, SizeIs(2));
  EXPECT_THAT(messages[0].text, HasSubstr("crawler.vxa: 1 robot imported"));
  EXPECT_THAT(messages[0].text, HasSubstr("mapped"));
  EXPECT_THAT(messages[1].text, HasSubstr("bad.vxa: /VXA: has no element VXC"));
}

TEST_F(LiveImports, FoldersAreSearchedForThemToo) {
  std::filesystem::create_directories(path("evolved"));
  write("evolved/base.vxa", VxaParts{}.text());
  LiveScene scene(test::on_cpu());
  test::open_and_wait(scene, {path("evolved")});
  EXPECT_THAT(test::names_of(scene), ElementsAre("base"));
}

}  // namespace
}  // namespace mercury
