// SPDX-License-Identifier: Apache-2.0
// Which key gives which command, and the file that changes it.
#include "app/window/toolkit/key_map.h"

#include <gmock/gmock.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "app/window/panels/commands.h"
#include "tests/app/program.h"

namespace mercury::window {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

KeyPress typed(char32_t character) { return {.character = character}; }
KeyPress with_control(char32_t character, bool shift = false) {
  return {.character = character, .control = true, .shift = shift};
}

TEST(KeyMap, TooltipsNameThePresentKeys) {
  KeyMap map;
  EXPECT_EQ(with_keys(map, "reset", Action::reset), "reset (key R)");
  EXPECT_EQ(with_keys(map, "undo", Action::undo), "undo (Ctrl Z)");
  EXPECT_EQ(with_keys(map, "step", Action::step), "step (Right or .)");
  ASSERT_EQ(map.read("reset = Ctrl J\nundo =\n"), "");
  EXPECT_EQ(with_keys(map, "reset", Action::reset), "reset (Ctrl J)");
  EXPECT_EQ(with_keys(map, "undo", Action::undo), "undo");
}

TEST(KeyMap, EveryCommandHasItsOwnNameAndEveryKeyOneCommand) {
  std::vector<std::string> names, keys;
  const KeyMap map;
  for (const KeyBinding& binding : key_bindings()) {
    EXPECT_EQ(std::ranges::count(names, binding.name), 0) << binding.name;
    names.emplace_back(binding.name);
    const std::string given = map.keys_of(binding.action);
    EXPECT_EQ(given, binding.keys);
    EXPECT_TRUE(given.empty() || std::ranges::count(keys, given) == 0) << given;
    keys.push_back(given);
  }
}

TEST(KeyMap, ShiftTellsCommandsWithCtrlApartAndNoOthers) {
  const KeyMap map;
  EXPECT_EQ(map.command_of(with_control(U's')), Action::save_scene);
  EXPECT_EQ(map.command_of(with_control(U's', true)), Action::save);
  EXPECT_EQ(map.command_of(with_control(U'z', true)), Action::redo);
  EXPECT_EQ(map.command_of(typed(U'M')), Action::mutate);
  EXPECT_EQ(map.command_of({.key = GLFW_KEY_DELETE, .shift = true}), Action::remove);
  EXPECT_EQ(map.command_of(with_control(U'=', true)), Action::larger_text);  // "+" of a US keyboard
}

TEST(KeyMap, NumbersColorInTheOrderOfTheQuantities) {
  KeyMap map;
  char32_t key = U'1';
  for (const ColorQuantity& quantity : color_quantities().first(9)) {
    const std::optional<Action> action = map.command_of(typed(key));
    ASSERT_TRUE(action) << quantity.key;
    EXPECT_EQ(quantity_of(*action), &quantity);
    const auto binding = std::ranges::find(key_bindings(), *action, &KeyBinding::action);
    EXPECT_EQ(binding->name, "color_" + std::string(quantity.key));
    EXPECT_EQ(binding->meaning, "color by " + std::string(quantity.key));
    EXPECT_EQ(map.command_of({.character = key++, .repeated = true}), std::nullopt);
  }
  EXPECT_EQ(quantity_of(Action::drag_arrows), nullptr);
  EXPECT_EQ(quantity_of(Action::cells), nullptr);
  ASSERT_EQ(map.read("reset = 3\ncolor_strain = Ctrl 3, Q\n"), "");
  EXPECT_EQ(map.command_of(typed(U'3')), Action::reset);
  EXPECT_EQ(map.command_of(typed(U'q')), Action::color_strain);
  EXPECT_EQ(map.command_of(with_control(U'3')), Action::color_strain);
}

TEST(KeyMap, HeldKeysRepeatOnlyCommandsThatAreMeantTo) {
  const KeyMap map;
  EXPECT_EQ(map.command_of({.key = GLFW_KEY_RIGHT, .repeated = true}), Action::step);
  EXPECT_EQ(map.command_of({.character = U'm', .repeated = true}), std::nullopt);
}

TEST(KeyMap, AFileMovesAKeyFromOneCommandToAnother) {
  KeyMap map;
  EXPECT_THAT(map.read("# mine\r\nreset = M\nstep = Ctrl Right, Comma\n\nfull_screen =\nfaster = =\n"), IsEmpty());
  EXPECT_EQ(map.command_of(typed(U'm')), Action::reset);
  EXPECT_EQ(map.command_of(typed(U'r')), std::nullopt);
  EXPECT_EQ(map.keys_of(Action::mutate), "");
  EXPECT_EQ(map.keys_of(Action::step), "Ctrl Right or Comma");
  EXPECT_EQ(map.command_of(typed(U',')), Action::step);
  EXPECT_EQ(map.command_of(typed(U'=')), Action::faster);
  EXPECT_EQ(map.command_of({.key = GLFW_KEY_F11}), std::nullopt);
  KeyMap again;
  EXPECT_THAT(again.read(map.text()), IsEmpty());
  EXPECT_EQ(again.text(), map.text());
}

TEST(KeyMap, ABadLineIsNamedAndTheOthersCount) {
  const auto problem = [](const std::string& text) { return KeyMap().read(text); };
  EXPECT_THAT(problem("mutat = M"), StartsWith("1: \"mutat\" is no command; did you mean mutate?"));
  EXPECT_THAT(problem("\nreset"), StartsWith("2: \"reset\" is no line COMMAND = KEY"));
  EXPECT_THAT(problem("reset = Strg R"), HasSubstr("\"Strg R\" is no key for a command; write M"));
  EXPECT_THAT(problem("reset = Shift R"), HasSubstr("is no key"));
  EXPECT_THAT(problem("reset = M,"), HasSubstr("\"\" is no key"));
  EXPECT_THAT(problem("reset = J\nmutate = J"), StartsWith("2: J is the key of reset already"));
  EXPECT_THAT(problem("a\nb\nc"), HasSubstr("(2 more lines cannot be used)"));
  EXPECT_EQ(problem("\x1b[2J = M").find('\x1b'), std::string::npos);
  KeyMap map;
  map.read("nothing\nreset = J\n");
  EXPECT_EQ(map.command_of(typed(U'j')), Action::reset);
}

class KeyFileTest : public test::FolderTest {};

TEST_F(KeyFileTest, TheTemplateChangesNothingAndAFileThatIsTooLongIsRefused) {
  KeyMap map;
  EXPECT_THAT(load_keys(map, path("none.txt")), IsEmpty());
  EXPECT_TRUE(write_keys_template(path("keys.txt")));
  EXPECT_THAT(load_keys(map, path("keys.txt")), IsEmpty());
  EXPECT_EQ(map.text(), KeyMap().text());
  std::ofstream(path("keys.txt")) << "reset = J\nfoo = K\n";
  EXPECT_TRUE(write_keys_template(path("keys.txt")));  // leaves a file alone
  EXPECT_THAT(load_keys(map, path("keys.txt")), testing::EndsWith("keys.txt:2: \"foo\" is no command"));
  std::ofstream(path("long.txt")) << std::string(70'000, '#');
  EXPECT_THAT(load_keys(map, path("long.txt")), HasSubstr("longer than 64 KiB"));
}

}  // namespace
}  // namespace mercury::window
