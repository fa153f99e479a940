// SPDX-License-Identifier: Apache-2.0
#include "app/video/png_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "mercury/error.h"
#include "render/png.h"

namespace mercury {
namespace {

std::size_t worker_count() { return std::max(1u, std::thread::hardware_concurrency()); }

}  // namespace

PngFolder::PngFolder(const std::filesystem::path& folder) : folder_(folder), queue_(worker_count()) {
  std::error_code error;
  made_folder_ = std::filesystem::create_directory(folder_, error);
  if (error) throw ParameterError("output", "cannot make the folder " + folder.string() + ": " + error.message());
  if (!std::filesystem::is_directory(folder_))
    throw ParameterError("output", folder.string() + " is a file, not a folder");
  if (access(folder_.c_str(), W_OK) != 0)
    throw ParameterError("output", "the folder " + folder.string() + " cannot be written into");
  for (std::size_t i = 0; i < worker_count(); ++i) workers_.emplace_back([this] { work(); });
}

PngFolder::~PngFolder() {
  queue_.abandon();
  stop();
  if (finished_) return;
  std::error_code ignored;
  for (std::int64_t number = 0; number < written_; ++number) std::filesystem::remove(path_of(number), ignored);
  if (made_folder_) std::filesystem::remove(folder_, ignored);
}

std::filesystem::path PngFolder::path_of(std::int64_t number) const {
  return folder_ / fmt::format("frame-{:05}.png", number);
}

void PngFolder::write(const render::Image& frame) {
  queue_.push({written_, frame});
  ++written_;
  rethrow();
}

void PngFolder::finish() {
  queue_.close();
  stop();
  rethrow();
  finished_ = true;
  remove_frames_from(written_);
}

void PngFolder::work() {
  while (const auto frame = queue_.pop()) {
    try {
      render::write_png(path_of(frame->number).string(), frame->picture);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      queue_.abandon();
    }
  }
}

void PngFolder::stop() {
  for (std::thread& worker : workers_)
    if (worker.joinable()) worker.join();
}

void PngFolder::rethrow() {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(error_);
}

// Frames are numbered without gaps: the first missing number ends the earlier video.
void PngFolder::remove_frames_from(std::int64_t first) const {
  std::error_code error;
  for (std::int64_t number = first; std::filesystem::remove(path_of(number), error); ++number) {
  }
}

}  // namespace mercury
