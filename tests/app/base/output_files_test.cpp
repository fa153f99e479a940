// SPDX-License-Identifier: Apache-2.0
// Which files a command may write.
#include "app/base/output_files.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "app/base/file_name.h"
#include "mercury/file_links.h"
#include "robots/file/whole_file.h"
#include "tests/app/program.h"
#include "tests/refusal.h"

namespace mercury::test {
namespace {

using testing::HasSubstr;

class OutputFilesTest : public FolderTest {
 protected:
  static std::string refusal(const OutputFiles& outputs) {
    return mercury::refusal([&] { outputs.check(); });
  }
  std::string refusal_of(const std::string& name, bool force = false) const {
    OutputFiles outputs(force, false);
    outputs.add_stream("--csv", path(name));
    return refusal(outputs);
  }
  OutputFiles forced() const { return OutputFiles(true, false); }
};

TEST_F(OutputFilesTest, NewFilesNeedNoForceAndTheirFoldersAreMade) {
  OutputFiles outputs(false, false);
  outputs.add_stream("--csv", path("x/y/a.csv"));
  outputs.add_new_folder("-o", path("z/frames/"));
  EXPECT_FALSE(outputs.check());
  EXPECT_EQ(listing(), std::vector<std::string>{});
  outputs.make_folders();
  EXPECT_EQ(listing(), (std::vector<std::string>{"x", "z"}));
  EXPECT_EQ(listing("x"), std::vector<std::string>{"y"});
  EXPECT_EQ(listing("z"), std::vector<std::string>{"frames"});
}

TEST_F(OutputFilesTest, ExistingFilesNeedForce) {
  write("a.csv", "mine");
  EXPECT_EQ(refusal_of("a.csv"),
            "--csv: " + path("a.csv") + " exists already; use --force to replace it, or give another name");
  EXPECT_EQ(refusal_of("a.csv", true), "");
}

TEST_F(OutputFilesTest, FoldersAreNoFiles) {
  std::filesystem::create_directory(path("folder"));
  EXPECT_EQ(refusal_of("folder", true), "--csv: " + path("folder") + " is a folder; give a file");
  EXPECT_EQ(refusal_of("", true), "--csv: " + path("") + " is a folder; give a file");
  write("file", "");
  EXPECT_EQ(refusal_of("file/a.csv", true),
            "--csv: " + path("file/a.csv") + " cannot be written: " + path("file") + " is no folder");
  OutputFiles outputs = forced();
  outputs.add_folder("-o", path("file"));
  EXPECT_EQ(refusal(outputs), "-o: " + path("file") + " is a file, not a folder");
}

// The superuser could replace it all the same.
TEST_F(OutputFilesTest, WriteProtectedFilesStay) {
  write("a.csv", "mine");
  chmod(path("a.csv").c_str(), 0444);
  EXPECT_EQ(refusal_of("a.csv", true), "--csv: " + path("a.csv") + " is write-protected; give another name");
}

TEST_F(OutputFilesTest, FoldersWithoutPermissionAreNoticed) {
  if (geteuid() == 0) GTEST_SKIP() << "the superuser may write into every folder";
  std::filesystem::create_directory(path("closed"));
  chmod(path("closed").c_str(), 0555);
  EXPECT_THAT(refusal_of("closed/a.csv"), HasSubstr("cannot be written: " + path("closed") + ": Permission denied"));
  EXPECT_THAT(refusal_of("closed/new/a.csv"), HasSubstr("Permission denied"));
}

// By whichever name: links, other paths, as a file of a folder that is read.
TEST_F(OutputFilesTest, InputsAreNeverWritten) {
  std::filesystem::create_directory(path("robots"));
  write("robots/eel.json", "{}");
  std::filesystem::create_symlink(path("robots/eel.json"), path("soft"));
  std::filesystem::create_hard_link(path("robots/eel.json"), path("hard"));
  for (const char* input : {"robots/eel.json", "robots", "soft"})
    for (const char* output : {"robots/eel.json", "robots/../robots/eel.json", "soft", "hard"}) {
      OutputFiles outputs = forced();
      outputs.add_input(path(input));
      outputs.add_stream("--csv", path(output));
      EXPECT_EQ(refusal(outputs), "--csv: " + path(output) + " is a file that this command reads; give another name")
          << input;
    }
  write("robots/results.csv", "of an earlier run");
  OutputFiles outputs = forced();
  outputs.add_input(path("robots"));
  outputs.add_stream("--csv", path("robots/results.csv"));
  EXPECT_EQ(refusal(outputs), "");
}

TEST_F(OutputFilesTest, TwoOutputsAreTwoFiles) {
  std::filesystem::create_directory(path("x"));
  std::filesystem::create_symlink(path("x"), path("y"));
  OutputFiles outputs = forced();
  outputs.add_stream("--csv", path("x/a"));
  outputs.add_file("--record", path("y/a"));
  EXPECT_EQ(refusal(outputs),
            "--csv, --record: " + path("y/a") + " is named twice; give each output a name of its own");
  OutputFiles printed = forced();
  printed.add_stream("--csv", "-");
  printed.add_stream("-o", "/dev/stdout");
  EXPECT_THAT(refusal(printed), HasSubstr("is named twice"));
  OutputFiles dropped = forced();
  dropped.add_stream("--csv", "/dev/null");
  dropped.add_stream("-o", "/dev/null");
  EXPECT_EQ(refusal(dropped), "");
}

TEST_F(OutputFilesTest, StreamsMayBeDevicesAndPipesAndOtherFilesMayNot) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (const std::string& name : {std::string("/dev/null"), path("pipe"), std::string("-"), std::string("/dev/stdout"),
                                  std::string("/dev/stderr")}) {
    OutputFiles outputs(false, false);
    outputs.add_stream("--csv", name);
    EXPECT_EQ(refusal(outputs), "") << name;
  }
  OutputFiles outputs = forced();
  outputs.add_file("--record", path("pipe"));
  EXPECT_EQ(refusal(outputs), "--record: " + path("pipe") + " is a device or pipe; give the name of a file");
}

TEST_F(OutputFilesTest, FoldersThatAreFilledAreNewOrEmpty) {
  const auto refusal_of_folder = [&](bool force) {
    OutputFiles outputs(force, false);
    outputs.add_new_folder("-o", path("frames"));
    return refusal(outputs);
  };
  EXPECT_EQ(refusal_of_folder(false), "");
  std::filesystem::create_directory(path("frames"));
  EXPECT_EQ(refusal_of_folder(false), "");
  write("frames/a", "");
  EXPECT_EQ(refusal_of_folder(false),
            "-o: " + path("frames") + " is not empty; use --force to write into it, or give another folder");
  EXPECT_EQ(refusal_of_folder(true), "");
}

// Comparing each with each took minutes.
TEST_F(OutputFilesTest, ManyOutputsAreCheckedInTimeInProportion) {
  OutputFiles outputs = forced();
  for (int i = 0; i < 20'000; ++i) {
    outputs.add_input(path("in-" + std::to_string(i)));
    outputs.add_file("-o", path("out-" + std::to_string(i)));
  }
  EXPECT_EQ(refusal(outputs), "");
}

TEST(FileNames, GiveEachRobotAFileOfItsOwn) {
  FileNames names;
  EXPECT_EQ(names.of("eel"), "eel");
  EXPECT_EQ(names.of("eel-2"), "eel-2");
  EXPECT_EQ(names.of("eel"), "eel-3");
  EXPECT_EQ(names.of("eel-3"), "eel-3-2");
  EXPECT_EQ(names.of("eel"), "eel-4");
  for (int i = 0; i < 200'000; ++i) names.of("kite");  // in time in proportion
  EXPECT_EQ(names.of("kite"), "kite-200001");
}

TEST(FileNameOf, IsSafeAndFitsIntoAFolder) {
  EXPECT_EQ(file_name_of("../../etc/passwd"), "_.._etc_passwd");
  EXPECT_EQ(file_name_of("a\nb\x1b[31m"), "a_b_[31m");
  EXPECT_EQ(file_name_of(".hidden"), "hidden");
  EXPECT_EQ(file_name_of("..."), "robot");
  EXPECT_EQ(file_name_of(std::string(10'000'000, '.') + "a"), "a");  // in time in proportion
  // 119 letters and a character of two bytes, which is not cut in half.
  EXPECT_EQ(file_name_of(std::string(119, 'a') + "é"), std::string(119, 'a'));
  EXPECT_EQ(file_name_of(std::string(118, 'a') + "é"), std::string(118, 'a') + "é");
}

// Which files are there when the work begins decides, however the file is named.
TEST_F(OutputFilesTest, ANewFileIsNotReplacedByTheSecondToFinish) {
  std::filesystem::create_directory(path("x"));
  std::filesystem::create_symlink(path("a.csv"), path("link.csv"));
  EXPECT_EQ(refusal_of("link.csv"), "");
  write("a.csv", "theirs");
  for (const char* name : {"a.csv", "x/../a.csv", "link.csv"}) {
    try {
      write_whole_file(path(name), "mine");
      ADD_FAILURE() << name << ": replaced a file of another program";
    } catch (const NameTaken& taken) {
      EXPECT_THAT(taken.what(), HasSubstr("a.csv was written by another program in the meantime; this one is "));
      EXPECT_EQ(taken.name.extension(), ".csv");
    }
  }
  EXPECT_EQ(read("a.csv"), "theirs");
  for (const char* name : {"a-2.csv", "a-3.csv", "a-4.csv"}) EXPECT_EQ(read(name), "mine");
  EXPECT_EQ(listing(), (std::vector<std::string>{"a-2.csv", "a-3.csv", "a-4.csv", "a.csv", "link.csv", "x"}));
}

TEST_F(OutputFilesTest, AFileThatMayBeReplacedIsAndSoIsAnOwnOne) {
  write("a.csv", "old");
  EXPECT_EQ(refusal_of("a.csv", true), "");
  write("a.csv", "theirs");
  write_whole_file(path("a.csv"), "mine");
  EXPECT_EQ(read("a.csv"), "mine");
  EXPECT_EQ(refusal_of("b.csv"), "");
  for (const char* content : {"first", "second"}) write_whole_file(path("b.csv"), content);
  EXPECT_EQ(read("b.csv"), "second");
  EXPECT_EQ(listing(), (std::vector<std::string>{"a.csv", "b.csv"}));
}

}  // namespace
}  // namespace mercury::test
