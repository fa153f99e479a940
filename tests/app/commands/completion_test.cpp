// SPDX-License-Identifier: Apache-2.0
// Completion in real shells, and man pages in real formatters. Shells and formatters that are not installed are
// skipped.
#include <gmock/gmock.h>

#include "tests/app/program.h"

namespace mercury::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::Not;
using testing::UnorderedElementsAre;

bool is_installed(const std::string& program) {
  return run_program("sh", {"-c", "command -v " + program + " >/dev/null"}).status == 0;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

// A folder with files to complete.
class Completion : public FolderTest {
 protected:
  Completion() {
    for (const char* file : {"eel.json", "eel.txt", "ray.cbor", "swim.h5", "a.toml"}) write(file, "");
    std::filesystem::create_directories(folder_ / "robots");
  }

  void write_script(const std::string& shell) {
    const std::string command = std::string(MERCURY_PROGRAM) + " describe-options " + shell + " > " + path("script");
    succeeded(run_program("sh", {"-c", command}));
  }

  std::vector<std::string> run_script(const std::string& shell, const std::string& text) {
    write("test", text);
    const Outcome outcome = run_program("sh", {"-c", "cd " + folder_.string() + " && " + shell + " test"});
    EXPECT_EQ(outcome.messages, "");
    return lines_of(outcome.output);
  }
};

class BashCompletion : public Completion {
 protected:
  void SetUp() override {
    if (!is_installed("bash")) GTEST_SKIP() << "bash is not installed";
    write_script("bash");
  }

  // What bash offers for the last word.
  std::vector<std::string> offers(const std::string& words) {
    return run_script("bash", "source ./script\nCOMP_WORDS=(mercury " + words +
                                  ")\nCOMP_CWORD=$(( ${#COMP_WORDS[@]} - 1 ))\n_mercury\n"
                                  "printf '%s\\n' \"${COMPREPLY[@]}\"\ncomplete -p mercury >/dev/null\n");
  }
};

TEST_F(BashCompletion, KnowsCommandsAndKinds) {
  EXPECT_THAT(offers("ru"), ElementsAre("run"));
  EXPECT_THAT(offers("new ''"), ElementsAre("voxel", "nn", "shell", "cppn", "tapered"));
  EXPECT_THAT(offers("help mu"), ElementsAre("mutate"));
  EXPECT_THAT(offers("-q --solver xpbd be"), ElementsAre("bench"));
  EXPECT_THAT(offers("''"), Contains("describe-options"));
}

TEST_F(BashCompletion, KnowsOptionsOfTheCommand) {
  EXPECT_THAT(offers("run --sol"), ElementsAre("--solver"));
  EXPECT_THAT(offers("new voxel --sym"), ElementsAre("--symmetry"));
  EXPECT_THAT(offers("new shell --sym"), ElementsAre());
}

TEST_F(BashCompletion, KnowsValues) {
  EXPECT_THAT(offers("run --solver ''"), ElementsAre("force", "xpbd"));
  EXPECT_THAT(offers("run --solver = x"), ElementsAre("xpbd"));  // as bash splits --solver=x
  EXPECT_THAT(offers("render --color str"), ElementsAre("strain"));
  EXPECT_THAT(offers("run --random s"), ElementsAre("shell"));
  EXPECT_THAT(offers("run --dt ''"), ElementsAre());
}

TEST_F(BashCompletion, KnowsWhichFilesAnArgumentTakes) {
  EXPECT_THAT(offers("run e"), ElementsAre("eel.json"));
  EXPECT_THAT(offers("mutate ''"), testing::IsSupersetOf({"eel.json", "ray.cbor", "robots", "sample:eel"}));
  EXPECT_THAT(offers("mutate ''"), Not(Contains("eel.txt")));
  EXPECT_THAT(offers("run --record ''"), UnorderedElementsAre("swim.h5", "robots"));
  EXPECT_THAT(offers("run --config ''"), UnorderedElementsAre("a.toml", "robots"));
  EXPECT_THAT(offers("evolve ''"), ElementsAre("robots"));
}

// bash splits words at colons, and replaces what follows the last one.
TEST_F(BashCompletion, KnowsSamples) {
  EXPECT_THAT(offers("run sample:ee"), ElementsAre("sample:eel"));
  EXPECT_THAT(offers("run sample : ee"), ElementsAre("eel"));
  EXPECT_THAT(offers("run sample :"), Contains("eel"));
  EXPECT_THAT(offers("evolve swim --from sample : ee"), ElementsAre("eel"));
  EXPECT_THAT(offers("run --random sample : ee"), ElementsAre());
}

TEST_F(Completion, FishOffersTheSame) {
  if (!is_installed("fish")) GTEST_SKIP() << "fish is not installed";
  write_script("fish");
  const auto offers = [&](const std::string& line) {
    return run_script("env HOME=" + folder_.string() + " fish",
                      "source ./script\ncomplete -C '" + line + "' | string replace -r '\\t.*' ''\n");
  };
  EXPECT_THAT(offers("mercury ru"), ElementsAre("run"));
  EXPECT_THAT(offers("mercury new "), UnorderedElementsAre("voxel", "nn", "shell", "cppn", "tapered"));
  EXPECT_THAT(offers("mercury run --sol"), ElementsAre("--solver"));
  EXPECT_THAT(offers("mercury run --solver "), UnorderedElementsAre("force", "xpbd"));
  EXPECT_THAT(offers("mercury run e"), ElementsAre("eel.json"));
}

// zsh completes in terminals only; what can be tested without one is that it reads the script.
TEST_F(Completion, ZshReadsItsScript) {
  if (!is_installed("zsh")) GTEST_SKIP() << "zsh is not installed";
  write_script("zsh");
  EXPECT_EQ(run_program("zsh", {"-n", path("script")}).messages, "");
}

class ManPages : public FolderTest {
 protected:
  void SetUp() override { succeeded(mercury({"describe-options", "man", path("man")})); }
};

TEST_F(ManPages, ThereIsOneForEachCommandAndKind) {
  const std::vector<std::string> pages = listing("man");
  for (const char* name : {"mercury.1", "mercury-run.1", "mercury-new.1", "mercury-new-voxel.1", "mercury-info.1"})
    EXPECT_THAT(pages, Contains(name));
}

TEST_F(ManPages, FormatWithoutWarningsAndHoldEveryOption) {
  if (!is_installed("groff")) GTEST_SKIP() << "groff is not installed";
  for (const std::string& page : listing("man")) {
    const Outcome outcome =
        run_program("sh", {"-c", "groff -man -Tascii -P-c -P-b -P-u -rLL=300n -ww " + path("man/" + page)});
    EXPECT_EQ(outcome.messages, "") << page;
    std::vector<std::string> command{"help"};
    std::istringstream words(std::filesystem::path(page).stem().string());
    std::string word;
    std::getline(words, word, '-');
    while (std::getline(words, word, '-')) command.push_back(word);
    for (const std::string& line : lines_of(mercury(command).output)) {
      if (!line.starts_with("  -")) continue;
      std::string option = line.substr(2, line.find_first_of(", ", 2) - 2);
      EXPECT_NE(outcome.output.find(option), std::string::npos) << page << " lacks " << option;
    }
  }
}

TEST_F(ManPages, PassMandoc) {
  if (!is_installed("mandoc")) GTEST_SKIP() << "mandoc is not installed";
  for (const std::string& page : listing("man"))
    EXPECT_EQ(run_program("mandoc", {"-Tlint", "-Werror", path("man/" + page)}).status, 0) << page;
}

}  // namespace
}  // namespace mercury::test
