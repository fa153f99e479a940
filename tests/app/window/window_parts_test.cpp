// SPDX-License-Identifier: Apache-2.0
// Parts of the window that work without a display.
#include <gmock/gmock.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "app/window/dialogs/folder_listing.h"
#include "app/window/toolkit/frame_times.h"
#include "app/window/toolkit/window.h"
#include "app/window/viewport/orbit_controller.h"
#include "mercury/random.h"
#include "tests/app/program.h"

namespace mercury::window {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Kind = InputEvent::Kind;

std::vector<std::string> names(const std::vector<FolderItem>& items) {
  std::vector<std::string> names;
  for (const FolderItem& item : items) names.push_back(item.name);
  return names;
}

class FolderListingTest : public test::FolderTest {
 protected:
  void write(const std::string& name, std::size_t bytes = 1) { std::ofstream(path(name)) << std::string(bytes, 'x'); }
  void SetUp() override {
    std::filesystem::create_directories(path("zoo/deep"));
    for (const char* name : {"eel.json", "Fish.JSON", "ray.cbor", "notes.txt", ".hidden.json"}) write(name);
  }
  FolderListing view_{{".json", ".cbor"}};
};

TEST_F(FolderListingTest, ListsFoldersFirstAndOnlyMatchingFiles) {
  ASSERT_TRUE(view_.enter(folder_));
  EXPECT_THAT(names(view_.items()), ElementsAre("zoo", "eel.json", "Fish.JSON", "ray.cbor"));
  EXPECT_EQ(view_.file_count(), 3u);
}

TEST_F(FolderListingTest, AnUnreadableFolderSetsTheErrorAndKeepsTheListing) {
  ASSERT_TRUE(view_.enter(folder_));
  EXPECT_FALSE(view_.enter(folder_ / "nowhere"));
  EXPECT_THAT(view_.error(), HasSubstr("nowhere"));
  EXPECT_EQ(view_.folder(), folder_);
  EXPECT_EQ(view_.items().size(), 4u);
}

TEST_F(FolderListingTest, GoingUpMarksThePreviousFolder) {
  ASSERT_TRUE(view_.enter(folder_ / "zoo" / ""));
  ASSERT_TRUE(view_.up());
  EXPECT_EQ(view_.folder(), folder_);
  EXPECT_THAT(names(view_.marked()), ElementsAre("zoo"));
  ASSERT_TRUE(view_.enter("/"));
  EXPECT_FALSE(view_.up());
}

TEST_F(FolderListingTest, FilterIgnoresCase) {
  view_.enter(folder_);
  view_.mark(1);
  view_.set_filter("FI");
  EXPECT_THAT(names(view_.items()), ElementsAre("Fish.JSON"));
  EXPECT_THAT(view_.marked(), IsEmpty());
  view_.set_filter("");
  EXPECT_EQ(view_.items().size(), 4u);
}

TEST_F(FolderListingTest, SortingKeepsFoldersAboveFilesAndKeepsMarks) {
  write("ray.cbor", 900);
  write("eel.json", 20);
  view_.enter(folder_);
  view_.mark(3);
  view_.sort(FolderListing::Order::size, true);
  EXPECT_THAT(names(view_.items()), ElementsAre("zoo", "ray.cbor", "eel.json", "Fish.JSON"));
  EXPECT_THAT(names(view_.marked()), ElementsAre("ray.cbor"));
  EXPECT_EQ(view_.cursor(), 1u);
}

TEST_F(FolderListingTest, KeysAndClicksMoveMarks) {
  view_.enter(folder_);
  view_.move(1);
  EXPECT_THAT(names(view_.marked()), ElementsAre("zoo"));
  view_.move(2);
  EXPECT_THAT(names(view_.marked()), ElementsAre("Fish.JSON"));
  view_.move(100);
  EXPECT_THAT(names(view_.marked()), ElementsAre("ray.cbor"));
  view_.mark_to(1);
  EXPECT_THAT(names(view_.marked()), ElementsAre("eel.json", "Fish.JSON", "ray.cbor"));
  view_.toggle(2);
  EXPECT_THAT(names(view_.marked()), ElementsAre("eel.json", "ray.cbor"));
  view_.mark(99);  // past the end
  EXPECT_THAT(view_.marked(), IsEmpty());
}

TEST(TypedPath, IsResolvedAsInAShell) {
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  EXPECT_EQ(typed_path("/robots", "eel.json"), "/robots/eel.json");
  EXPECT_EQ(typed_path("/robots", "  ../eel.json "), "/eel.json");
  EXPECT_EQ(typed_path("/robots", "/a/b"), "/a/b");
  EXPECT_EQ(typed_path("/robots", "~/a"), home.empty() ? "/robots/~/a" : home + "/a");
  EXPECT_EQ(typed_path("/robots", "   "), "");
}

InputEvent moved(double x) { return {.kind = Kind::move, .x = x}; }
InputEvent button(int action) { return {.kind = Kind::button, .code = GLFW_MOUSE_BUTTON_LEFT, .action = action}; }
InputEvent key(int code, int action, bool types) {
  return {.kind = Kind::key, .code = code, .action = action, .types = types};
}
InputEvent letter(char32_t c) { return {.kind = Kind::character, .code = static_cast<int>(c)}; }

TEST(InputQueue, AClickKeepsItsPositionWhenThePointerMovesOn) {
  InputQueue queue;
  for (const InputEvent& event :
       {moved(1), moved(2), button(GLFW_PRESS), moved(3), moved(4), button(GLFW_RELEASE), moved(5)})
    queue.push(event);
  const std::vector<InputEvent> down = queue.take();
  ASSERT_EQ(down.size(), 2u);
  EXPECT_EQ(down[0].x, 2);
  EXPECT_EQ(down[1].action, GLFW_PRESS);
  EXPECT_TRUE(queue.has_backlog());
  const std::vector<InputEvent> up = queue.take();
  ASSERT_EQ(up.size(), 2u);
  EXPECT_EQ(up[0].x, 4);
  EXPECT_EQ(up[1].action, GLFW_RELEASE);
  ASSERT_EQ(queue.take().size(), 1u);
  EXPECT_FALSE(queue.has_backlog());
  EXPECT_EQ(queue.taken(), 1u);
}

TEST(InputQueue, TheWheelKeepsThePositionOfThePointer) {
  InputQueue queue;
  for (const InputEvent& event :
       {moved(1), InputEvent{.kind = Kind::scroll, .y = 1}, InputEvent{.kind = Kind::scroll, .y = 1}, moved(2)})
    queue.push(event);
  const std::vector<InputEvent> turned = queue.take();
  ASSERT_EQ(turned.size(), 3u);
  EXPECT_EQ(turned[0].x, 1);
  EXPECT_EQ(queue.take().size(), 1u);
}

TEST(InputQueue, TextIsTakenAtOnceAndInputAfterACommandWaits) {
  InputQueue queue;
  for (const char32_t c : {U'e', U'e', U'l'}) {
    queue.push(key(static_cast<int>(c), GLFW_PRESS, true));
    queue.push(letter(c));
    queue.push(key(static_cast<int>(c), GLFW_RELEASE, true));
  }
  queue.push(key(GLFW_KEY_ENTER, GLFW_PRESS, false));
  queue.push(key(GLFW_KEY_ENTER, GLFW_RELEASE, false));
  queue.push(letter(U'x'));
  queue.push(button(GLFW_PRESS));
  EXPECT_EQ(queue.take().size(), 10u);
  EXPECT_EQ(queue.take().size(), 2u);  // the letter is taken before the button
  EXPECT_EQ(queue.take().size(), 1u);
  EXPECT_EQ(queue.taken(), 5u);
}

TEST(KeyPresses, AreCharactersForKeysThatTypeAndKeysOtherwise) {
  InputEvent control = key(GLFW_KEY_S, GLFW_PRESS, false);
  control.mods = GLFW_MOD_CONTROL;
  control.name = U's';
  const std::vector<KeyPress> presses =
      key_presses_in({key(GLFW_KEY_D, GLFW_PRESS, true), letter(U'd'), key(GLFW_KEY_D, GLFW_RELEASE, true),
                      key(GLFW_KEY_F1, GLFW_PRESS, false), key(GLFW_KEY_F1, GLFW_RELEASE, false), control});
  ASSERT_EQ(presses.size(), 3u);
  EXPECT_EQ(presses[0].character, U'd');
  EXPECT_EQ(presses[1].key, GLFW_KEY_F1);
  EXPECT_EQ(presses[1].character, 0u);
  EXPECT_TRUE(presses[2].control);
  EXPECT_EQ(presses[2].character, U's');
}

TEST(Pacing, LeavesThirtyFramesPerSecondToARendererOnTheProcessorAndSixtyToAGpu) {
  constexpr double spent = 0.010;  // since the last frame began [s]
  EXPECT_NEAR(Pacing(true, true).wait(spent, false) + spent, 1.0 / 30, 1e-9);
  EXPECT_NEAR(Pacing(true, false).wait(spent, false) + spent, 1.0 / 60, 1e-9);
  EXPECT_EQ(Pacing(true, true).wait(0.05, false), 0) << "a slow frame is not slowed down";
  EXPECT_EQ(Pacing(false, true).wait(spent, false), 0) << "unpaced";
}

// Otherwise the view would be drawn again and again for moves that nobody sees.
TEST(OrbitController, AGlideToTheGroupIsSeenUntilItEnds) {
  const auto eye = [](OrbitController& camera, float side) {
    const render::Bounds box{{side, 0, 0}, {side + 1, 1, 1}};
    return camera.at({&box, 1}, 1.5f, 1.0 / 30).eye;
  };
  OrbitController camera;
  const render::Bounds first{{0, 0, 0}, {1, 1, 1}};
  camera.set_mode(CameraMode::group);
  camera.start({&first, 1}, 1.5f);
  render::Vector3 before = eye(camera, 0.5f);
  std::vector<float> moves;  // per distance
  for (int i = 0; i < 150; ++i) {
    const render::Vector3 now = eye(camera, 0.5f);
    moves.push_back((now - before).norm() / camera.orbit().distance);
    before = now;
  }
  const auto end = std::find(moves.begin(), moves.end(), 0.0f);
  ASSERT_NE(end, moves.end()) << "it ends within 5 s";
  for (auto move = moves.begin(); move + 1 < end; ++move) EXPECT_GT(*move, 2e-4f) << move - moves.begin();
  for (auto move = end; move != moves.end(); ++move) EXPECT_EQ(*move, 0);
}

TEST(OrbitController, StaysAboveTheFloor) {
  OrbitController camera;
  camera.floor = -0.5f;
  Random random(1);
  const auto some = [&] { return static_cast<float>(random.uniform(-1, 1)); };
  bool looked_up = false;
  for (int i = 0; i < 1000; ++i) {
    if (random.chance(0.5)) camera.turn(some(), some());
    if (random.chance(0.3)) camera.pan(0.2f * some(), 0.2f * some());
    if (random.chance(0.3)) camera.zoom(1 + 0.3f * some());
    if (random.chance(0.05))
      camera.go_to({.mode = CameraMode::still, .elevation = -1.4f, .target = render::Vector3{0, 0, -3}}, std::nullopt);
    const render::Camera now = camera.at({}, 1.5f, 0.1);
    EXPECT_GT(now.eye.z, *camera.floor) << i;
    looked_up |= now.target.z > now.eye.z;
  }
  EXPECT_TRUE(looked_up) << "below a robot that is high above the floor, the camera may go";
}

}  // namespace
}  // namespace mercury::window
