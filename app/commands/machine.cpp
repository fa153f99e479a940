// SPDX-License-Identifier: Apache-2.0
#include "app/commands/info_json.h"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "app/base/child_process.h"
#include "app/video/frame_writer.h"
#include "app/video/position_bridge.h"
#include "mercury/cuda_devices.h"
#include "mercury/host_memory.h"
#include "render/context/context.h"

namespace mercury {
namespace {

// The value of the first line "name : value" of a /proc file.
std::string proc_value(const char* path, const std::string& name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(name)) continue;
    const std::size_t colon = line.find(':');
    const std::size_t start = colon == std::string::npos ? colon : line.find_first_not_of(" \t", colon + 1);
    if (start != std::string::npos) return line.substr(start);
  }
  return {};
}

int usable_cores() {
  cpu_set_t set;
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set)
                                                     : static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
}

const char* vector_instructions() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512f")) return "AVX-512";
  if (__builtin_cpu_supports("avx2")) return "AVX2";
  return "SSE2";
#elif defined(__aarch64__)
  return "NEON";
#else
  return "unknown vector instructions";
#endif
}

Finding processor() {
  const std::string model = proc_value("/proc/cpuinfo", "model name");
  const int cores = usable_cores();
  return {"processor",
          fmt::format("{}, {} core{}, {}", model.empty() ? "unknown model" : model, cores, cores == 1 ? "" : "s",
                      vector_instructions()),
          {}};
}

Finding memory() {
  std::istringstream total(proc_value("/proc/meminfo", "MemTotal"));
  std::size_t kilobytes = 0;
  total >> kilobytes;
  return {"memory", fmt::format("{}, {} free", byte_text(1024 * kilobytes), byte_text(available_host_memory())), {}};
}

std::vector<Finding> gpus() {
  if (!built_with_cuda())
    return {{"GPU", "not used: this build has no CUDA backend",
             "build again with nvcc on PATH to simulate on an NVIDIA GPU"}};
  std::vector<Finding> findings;
  for (int i = 0; i < cuda_device_count(); ++i)
    findings.push_back({"GPU", fmt::format("{} (--device cuda:{})", cuda_device_name(i), i), {}});
  if (findings.empty())
    findings.push_back({"GPU", "none that CUDA can use", "check the NVIDIA driver with nvidia-smi; the CPU is used"});
  return findings;
}

// Whether positions can go from CUDA to OpenGL without leaving the GPU.
std::string sharing(const render::Context& context) {
  if (context.is_software() || !built_with_cuda()) return {};
  const int device = cuda_device_of_current_context();
  return device < 0 ? ", shares no memory with CUDA" : fmt::format(", shares memory with cuda:{}", device);
}

std::vector<Finding> drawing() {
  std::vector<Finding> findings;
  bool any = false;
  for (const auto kind : {render::ContextKind::egl, render::ContextKind::mesa, render::ContextKind::osmesa}) {
    const std::string what = fmt::format("drawing ({})", name_of(kind));
    try {
      const auto context = render::make_context({.kind = kind, .debug = false});
      findings.push_back({what, context->describe() + sharing(*context), {}});
      context->release();
      any = true;
    } catch (const render::ContextError& error) {
      findings.push_back({what, fmt::format("no: {}", error.what()), {}});
    }
  }
  if (!any) findings.back().advice = "install libegl1 and libgl1-mesa-dri, or libosmesa6, to make pictures";
  return findings;
}

// "5.1.9-0+deb12u1" from "ffmpeg version 5.1.9-0+deb12u1 Copyright ...".
std::string version_in(const std::string& text) {
  std::istringstream words(text);
  std::string program, word, version;
  words >> program >> word >> version;
  return version;
}

Finding encoder(const std::string& ffmpeg) {
  const std::string program = encoder_program(ffmpeg);
  const std::string version = output_of(program, {"-hide_banner", "-version"});
  if (version.empty())
    return {"encoder", fmt::format("{} does not run", program),
            "install the package ffmpeg (apt install ffmpeg) to write videos; PNG pictures need none"};
  const std::string codecs = output_of(program, {"-hide_banner", "-encoders"});
  std::string formats, missing;
  for (const auto& [codec, format] : {std::pair{"libx264", ".mp4"}, {"libvpx-vp9", ".webm"}, {" gif ", ".gif"}})
    (codecs.find(codec) == std::string::npos ? missing : formats) += std::string(" ") + format;
  return {"encoder",
          fmt::format("{} {}, writes{}", program, version_in(version), formats.empty() ? " nothing" : formats),
          missing.empty() ? "" : fmt::format("this ffmpeg cannot write{}; install that of your distribution", missing)};
}

}  // namespace

std::vector<Finding> inspect_machine(const std::string& ffmpeg) {
  std::vector<Finding> findings{processor(), memory()};
  const auto add = [&](const std::vector<Finding>& more) { findings.insert(findings.end(), more.begin(), more.end()); };
  add(gpus());
  add(drawing());
  findings.push_back(encoder(ffmpeg));
  return findings;
}

}  // namespace mercury
