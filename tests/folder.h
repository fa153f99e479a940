// SPDX-License-Identifier: Apache-2.0
// A folder for each test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace mercury::test {

// A folder that is there for one test, removed after it.
class TestWithFolder : public testing::Test {
 protected:
  TestWithFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "." + info->name();
    std::ranges::replace(name, '/', '-');
    folder_ = std::filesystem::temp_directory_path() / ("mercury-" + name + "-" + std::to_string(getpid()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~TestWithFolder() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  void write(const std::string& name, const std::string& text, bool executable = false) const {
    std::ofstream(path(name), std::ios::binary) << text;
    if (executable)
      std::filesystem::permissions(path(name), std::filesystem::perms::owner_exec, std::filesystem::perm_options::add);
  }

  std::string read(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  // Names of what is in the folder, sorted.
  std::vector<std::string> listing(const std::string& below = "") const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / below))
      names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  }

  std::filesystem::path folder_;
};

}  // namespace mercury::test
