// SPDX-License-Identifier: Apache-2.0
// A batch on any backend whose shared arrays a test reads and writes, wherever they lie.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backend.h"
#include "mercury/backend.h"

namespace mercury::test {

// "cpu", "cuda", or "split": two CPU backends as one, as several GPUs are.
inline std::unique_ptr<Backend> backend_named(std::string_view name) {
  if (name == "cuda") return make_cuda_backend({});
  if (name == "cpu") return make_cpu_backend({});
  std::vector<std::unique_ptr<Backend>> parts;
  for (int part = 0; part < 2; ++part) parts.push_back(make_cpu_backend({}));
  return make_split_backend(std::move(parts));
}

class SharedBatch {
 public:
  SharedBatch(std::string_view backend, const Configuration& configuration, std::span<const Robot> robots)
      : SharedBatch(backend_named(backend), configuration, robots) {}

  Simulation* operator->() { return &simulation_; }
  Simulation& operator*() { return simulation_; }

  template <class T>
  std::vector<T> read(const SharedArray<T>& array) const {
    std::vector<T> values(array.rows * array.columns);
    if (!values.empty()) backend_.copy_shared(values.data(), array.data.get(), values.size() * sizeof(T));
    return values;
  }
  std::vector<Vec3> vectors(const SharedArray<float>& array) const {
    std::vector<Vec3> values(array.rows);
    backend_.copy_shared(values.data(), array.data.get(), values.size() * sizeof(Vec3));
    return values;
  }
  template <class T>
  void write(const SharedArray<T>& array, std::vector<T> values) const {
    ASSERT_EQ(values.size(), array.rows * array.columns);
    backend_.copy_shared(array.data.get(), values.data(), values.size() * sizeof(T));
  }
  void write(const SharedArray<float>& array, std::size_t row, std::size_t column, float value) const {
    backend_.copy_shared(array.data.get() + row * array.columns + column, &value, sizeof(value));
  }
  // Shared memory of the same kind with these values.
  std::shared_ptr<std::uint8_t> shared(const std::vector<std::uint8_t>& values) const {
    const auto memory = std::static_pointer_cast<std::uint8_t>(backend_.allocate_shared(values.size()));
    backend_.copy_shared(memory.get(), values.data(), values.size());
    return memory;
  }

 private:
  SharedBatch(std::unique_ptr<Backend> backend, const Configuration& configuration, std::span<const Robot> robots)
      : backend_(*backend), simulation_(configuration, robots, std::move(backend)) {}

  Backend& backend_;  // the simulation's
  Simulation simulation_;
};

// A test of one of these backends.
class SharedBatchTest : public testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override {
    if (GetParam() == "cuda") BackendTest::skip_without(DeviceKind::cuda);
  }
  SharedBatch batch(const Configuration& configuration, std::span<const Robot> robots) const {
    return {GetParam(), configuration, robots};
  }

 public:
  static std::string name(const testing::TestParamInfo<std::string_view>& info) { return std::string(info.param); }
};

inline const auto every_backend = testing::Values(std::string_view("cpu"), "cuda", "split");

}  // namespace mercury::test
