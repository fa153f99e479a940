// SPDX-License-Identifier: Apache-2.0
// What memory is left, by the limits of control groups and of the process.
#include "mercury/host_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>

#include "sim/host_memory.h"
#include "tests/folder.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

class ControlGroups : public test::TestWithFolder {
 protected:
  void put(const fs::path& file, const std::string& text) const {
    fs::create_directories((folder_ / file).parent_path());
    write(file, text);
  }
};

TEST_F(ControlGroups, NoGroupIsNoLimit) {
  EXPECT_EQ(left_in_control_groups(folder_, ""), unlimited_memory);
  EXPECT_EQ(left_in_control_groups(folder_, "0::/user.slice\n4:memory:/a\nnonsense\n"), unlimited_memory);
}

TEST_F(ControlGroups, OfVersion2TheTightestAroundTheProcessCounts) {
  const std::string membership = "0::/job/step\n";
  put("job/step/memory.max", "max\n");
  put("job/step/memory.current", "100\n");
  EXPECT_EQ(left_in_control_groups(folder_, membership), unlimited_memory);
  put("job/memory.max", "1000\n");
  put("job/memory.current", "400\n");
  EXPECT_EQ(left_in_control_groups(folder_, membership), 600u);
  put("job/memory.stat", "anon 150\ninactive_file 250\nactive_file 9\n");  // Linux drops these files when it must
  EXPECT_EQ(left_in_control_groups(folder_, membership), 850u);
  put("memory.max", "300\n");
  put("memory.current", "400\n");
  EXPECT_EQ(left_in_control_groups(folder_, membership), 0u);
}

TEST_F(ControlGroups, OfVersion1TheMemoryControllerCounts) {
  put("memory/docker/1f/memory.limit_in_bytes", "5000\n");
  put("memory/docker/1f/memory.usage_in_bytes", "2000\n");
  put("memory/docker/1f/memory.stat", "inactive_file 1\ntotal_inactive_file 500\n");
  EXPECT_EQ(left_in_control_groups(folder_, "5:cpu,memory:/docker/1f\n0::/\n"), 3500u);
  EXPECT_EQ(left_in_control_groups(folder_, "5:cpu:/docker/1f\n"), unlimited_memory);
}

// The limit is the smaller one of the two sums: what the process has, and what it may still take.
TEST(HostMemory, TheLimitsOfTheProcessCount) {
  for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
    rlimit before{};
    ASSERT_EQ(getrlimit(resource, &before), 0);
    constexpr rlim_t huge = rlim_t{1} << 46;  // sanitizers map most of the address space
    rlimit limited = before;
    limited.rlim_cur = huge;
    ASSERT_EQ(setrlimit(resource, &limited), 0);
    const std::size_t left = left_by_process_limits();
    setrlimit(resource, &before);
    EXPECT_LT(left, huge) << resource;
    if (resource == RLIMIT_DATA) {
      EXPECT_GT(left, huge - (rlim_t{1} << 45));
    }
    EXPECT_LE(available_host_memory(), left_by_process_limits());
  }
  EXPECT_LE(usable_host_memory(), available_host_memory());
}

TEST(HostMemory, LinesSayWhatIsNeededAndWhatFits) {
  EXPECT_EQ(memory_line(24'400'000'000, 8'100'000'000, "up to 66000 robots"),
            "about 24 GB of memory are needed, 8.1 GB can be used; give up to 66000 robots");
  EXPECT_EQ(memory_line(999'600, 999), "about 1.0 MB of memory are needed, 999 bytes can be used");
}

}  // namespace
}  // namespace mercury
