// SPDX-License-Identifier: Apache-2.0
// A matrix product of a library sums in an order that depends on the instruction set. Here each output has its lane,
// and adds bias, input 0, input 1, ... one after another. The width of the vectors decides only how many outputs and
// points go side by side:
//
//            16 outputs
//   point 0  [ ......  ]  += input k of point 0 * [ weights from input k to the 16 outputs ]
//   point 1  [ ......  ]  += input k of point 1 * [ the same                               ]
//   ...
//
// The sums of a tile stay in registers. Points go through all layers in groups that fit into the first cache.
#include "robots/nn/perceptron.h"

#include <algorithm>
#include <cstring>

namespace mercury {
namespace {

constexpr std::size_t lanes = 16, group = 64;  // outputs side by side; points that go through the layers together

template <std::size_t floats>
struct Register {
  using Type [[gnu::vector_size(floats * sizeof(float))]] = float;
};

std::size_t rounded_up(std::size_t n) { return (n + lanes - 1) / lanes * lanes; }

// The weights from input k to all outputs side by side, padded with zeros.
struct PreparedLayer {
  std::size_t inputs, outputs;
  bool has_relu;
  std::vector<float> weights, biases;

  PreparedLayer(const Layer& layer, bool is_last)
      : inputs(static_cast<std::size_t>(layer.inputs)), outputs(rounded_up(static_cast<std::size_t>(layer.outputs))),
        has_relu(!is_last), weights(inputs * outputs), biases(layer.biases) {
    biases.resize(outputs);
    for (std::size_t j = 0; j < layer.biases.size(); ++j)
      for (std::size_t k = 0; k < inputs; ++k) weights[k * outputs + j] = layer.weights[j * inputs + k];
  }
};

// From the inputs of a group of points, `stride` floats each, to the outputs.
struct GroupProduct {
  const PreparedLayer& layer;
  const float* inputs;
  std::size_t stride;
  float* outputs;
};

template <class Vector>
[[gnu::always_inline]] inline void load(Vector& vector, const float* from) {
  std::memcpy(&vector, from, sizeof vector);
}

// `points` points are summed side by side, in registers of `floats` floats.
template <std::size_t floats, std::size_t points>
[[gnu::always_inline]] inline void multiply(const GroupProduct& p) {
  using Vector = typename Register<floats>::Type;
  constexpr std::size_t registers = lanes / floats;
  const std::size_t width = p.layer.outputs, count = p.layer.inputs;
  for (std::size_t first = 0; first < group; first += points)
    for (std::size_t j = 0; j < width; j += lanes) {
      Vector sums[points][registers], weights;
      for (std::size_t i = 0; i < points; ++i)
        for (std::size_t r = 0; r < registers; ++r) load(sums[i][r], &p.layer.biases[j + r * floats]);
      const float* input = p.inputs + first * p.stride;
      const float* row = p.layer.weights.data() + j;
      for (std::size_t k = 0; k < count; ++k, row += width)
        for (std::size_t r = 0; r < registers; ++r) {
          load(weights, row + r * floats);
          for (std::size_t i = 0; i < points; ++i) sums[i][r] += input[i * p.stride + k] * weights;
        }
      for (std::size_t i = 0; i < points; ++i)
        for (std::size_t r = 0; r < registers; ++r) {
          // A value that is not a number stays one, so that it is found in the result.
          const Vector output = p.layer.has_relu ? (sums[i][r] < 0 ? Vector{} : sums[i][r]) : sums[i][r];
          std::memcpy(p.outputs + (first + i) * width + j + r * floats, &output, sizeof output);
        }
    }
}

using Multiply = void (*)(const GroupProduct&);

// As many points as fill eight registers.
void multiply_with_any(const GroupProduct& product) { multiply<4, 2>(product); }
#ifdef __x86_64__
[[gnu::target("avx2")]] void multiply_with_avx2(const GroupProduct& product) { multiply<8, 4>(product); }
[[gnu::target("avx512f")]] void multiply_with_avx512(const GroupProduct& product) { multiply<16, 8>(product); }
#endif

const std::vector<Multiply>& kernels() {
  static const std::vector<Multiply> usable = [] {
    std::vector<Multiply> found;
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx512f")) found.push_back(multiply_with_avx512);
    if (__builtin_cpu_supports("avx2")) found.push_back(multiply_with_avx2);
#endif
    found.push_back(multiply_with_any);
    return found;
  }();
  return usable;
}

}  // namespace

std::size_t perceptron_kernels() { return kernels().size(); }

std::vector<float> evaluate_layers(std::span<const Layer> layers, std::span<const float> points, std::size_t kernel) {
  const Multiply multiply_group = kernels()[kernel];
  std::vector<PreparedLayer> prepared;
  prepared.reserve(layers.size());
  std::size_t widest = 0;
  for (const Layer& layer : layers) {
    prepared.emplace_back(layer, &layer == &layers.back());
    widest = std::max({widest, prepared.back().inputs, prepared.back().outputs});
  }
  const auto inputs = static_cast<std::size_t>(layers.front().inputs);
  const auto outputs = static_cast<std::size_t>(layers.back().outputs);
  const std::size_t count = points.size() / inputs;
  std::vector<float> result(count * outputs), before(group * widest), after(group * widest);
  for (std::size_t first = 0; first < count; first += group) {
    const std::size_t here = std::min(group, count - first);  // the others of a group hold anything
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(first * inputs), here * inputs, before.begin());
    std::size_t stride = inputs;
    for (const PreparedLayer& layer : prepared) {
      multiply_group({layer, before.data(), stride, after.data()});
      std::swap(before, after);
      stride = layer.outputs;
    }
    for (std::size_t i = 0; i < here; ++i) std::copy_n(&before[i * stride], outputs, &result[(first + i) * outputs]);
  }
  return result;
}

}  // namespace mercury
