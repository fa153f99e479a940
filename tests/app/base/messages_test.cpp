// SPDX-License-Identifier: Apache-2.0
#include "app/base/messages.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <initializer_list>
#include <string>

namespace mercury::test {
namespace {

TEST(Printable, LeavesPlainTextAndOtherScriptsAlone) {
  EXPECT_EQ(printable("eel.json: 3 masses"), "eel.json: 3 masses");
  EXPECT_EQ(printable("Qualle ü, 水母, 🪼"), "Qualle ü, 水母, 🪼");
}

TEST(Printable, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(printable("a\nb\tc\r"), "a\\nb\\tc\\r");
  EXPECT_EQ(printable("\x1b[2J"), "\\x1b[2J");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\x7f\xc2\x9b"), "\\x7f\\x9b");  // DEL, and the one-byte form of ESC [
  EXPECT_EQ(printable("a\u202eb"), "a\\u202eb");       // the text after it would run from right to left
}

TEST(Printable, EscapesBytesThatAreNotUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xc3"), "\\xc3");                    // ends early
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");           // longer than needed
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
}

TEST(Printable, KeepsBothEndsOfALongText) {
  const std::string text = "begin " + std::string(10'000'000, 'x') + " end";
  const std::string line = printable(text, 100);
  EXPECT_LE(line.size(), 100u);
  EXPECT_TRUE(line.starts_with("begin xxx"));
  EXPECT_TRUE(line.ends_with("xxx end"));
}

TEST(Printable, CutsNoCharacterInTwo) {
  std::string text;
  for (int i = 0; i < 200; ++i) text += "水";
  for (std::size_t longest = 0; longest < 40; ++longest) {
    const std::string line = printable(text, longest);
    for (std::string_view rest = line; !rest.empty(); rest.remove_prefix(utf8_length(rest)))
      ASSERT_GT(utf8_length(rest), 0u) << line;
  }
}

// Restores standard error.
class StandardError {
 public:
  StandardError() : kept_(dup(STDERR_FILENO)) {}
  ~StandardError() {
    dup2(kept_, STDERR_FILENO);
    close(kept_);
    set_verbosity(Verbosity::normal);
  }

 private:
  int kept_;
};

TEST(Messages, AreDroppedWhenTheyCannotBeWritten) {
  const StandardError restored;
  const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
  dup2(full, STDERR_FILENO);
  close(full);
  EXPECT_NO_THROW(warn("dropped"));
  close(STDERR_FILENO);
  EXPECT_NO_THROW(warn("dropped too"));
}

TEST(Messages, FollowTheVerbosity) {
  const StandardError restored;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  dup2(ends[1], STDERR_FILENO);
  close(ends[1]);
  for (const Verbosity level : {Verbosity::quiet, Verbosity::normal, Verbosity::verbose}) {
    set_verbosity(level);
    warn("warn");
    say("say");
    say_detail("detail");
  }
  close(STDERR_FILENO);
  std::string text(4096, '\0');
  text.resize(static_cast<std::size_t>(read(ends[0], text.data(), text.size())));
  close(ends[0]);
  EXPECT_EQ(text,
            "mercury: warn\n"
            "mercury: warn\nmercury: say\n"
            "mercury: warn\nmercury: say\nmercury: detail\n");
}

}  // namespace
}  // namespace mercury::test
