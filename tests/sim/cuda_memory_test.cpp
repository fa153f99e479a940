// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "mercury/cuda_devices.h"

namespace mercury::cuda {
namespace {

class DeviceMemory : public testing::Test {
 protected:
  void SetUp() override {
    if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device";
  }
};

std::vector<std::uint8_t> numbered(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i % 251 + 1);
  return bytes;
}

// By the copy engine in one block or several, and by cudaMemset: the sizes between which allocation chooses.
TEST_F(DeviceMemory, IsZeroAtFirst) {
  const Stream stream;
  for (const std::size_t size :
       {std::size_t{1}, std::size_t{1000}, (std::size_t{1} << 20) + 1, std::size_t{33} << 20}) {
    for (int round = 0; round < 2; ++round) {  // the second time the pool gives back what was written
      DeviceArray<std::uint8_t> array(size);
      std::vector<std::uint8_t> found(size, 7);
      array.read(0, found, stream.get());
      EXPECT_EQ(std::ranges::count(found, 0), static_cast<std::ptrdiff_t>(size)) << size;
      array.write(0, numbered(size), stream.get());
    }
  }
}

// A short upload is two rows and, of an odd number, the last byte.
TEST_F(DeviceMemory, HoldsWhatIsWrittenAndNothingElseChanges) {
  const Stream stream;
  for (const std::size_t size : {1, 2, 3, 255, 4096, 65535, 65536, 65537}) {
    DeviceArray<std::uint8_t> array(size + 2);
    array.write(1, numbered(size), stream.get());
    std::vector<std::uint8_t> found(size + 2), wanted = numbered(size);
    wanted.insert(wanted.begin(), 0);
    wanted.push_back(0);
    array.read(0, found, stream.get());
    EXPECT_EQ(found, wanted) << size;
  }
}

}  // namespace
}  // namespace mercury::cuda
