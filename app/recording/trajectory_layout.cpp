// SPDX-License-Identifier: Apache-2.0
#include "app/recording/trajectory_layout.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/recording/recording_file.h"
#include "app/recording/trajectory_hdf5_writing.h"
#include "mercury/error.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

constexpr std::size_t longest_name = 200;  // bytes of a group's name

std::string legal(std::string_view name) {
  std::string result;
  while (!name.empty() && result.size() < longest_name) {
    const std::size_t length = utf8_length(name);
    const bool plain =
        length > 1 || (length == 1 && static_cast<unsigned char>(name[0]) >= 0x20 && name[0] != '/' && name[0] != 0x7f);
    result += plain ? std::string(name.substr(0, length)) : "_";
    name.remove_prefix(std::max<std::size_t>(1, length));
  }
  return result.empty() || result == "." || result == ".." ? "robot" : result;
}

}  // namespace

bool is_trajectory_name(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".h5" || extension == ".hdf5" || extension == ".h5md";
}

bool is_readable_trajectory_name(const std::filesystem::path& path) {
  // UnfinishedFile chooses the temporary names: NAME.PROCESS-NUMBER.part.
  return is_trajectory_name(path) || (path.extension() == ".part" && is_trajectory_name(path.stem().stem()));
}

std::vector<std::string> group_names(std::span<const std::string> robot_names) {
  std::vector<std::string> names;
  for (const std::string& name : robot_names) names.push_back(legal(name));
  const std::unordered_set<std::string> asked(names.begin(), names.end());
  std::unordered_set<std::string> taken;
  std::unordered_map<std::string, std::size_t> last;  // number given out for a name
  for (std::string& name : names) {
    if (taken.insert(name).second) continue;
    std::size_t& number = last.try_emplace(name, 1).first->second;
    std::string other;
    do other = name + "-" + std::to_string(++number);
    while (asked.contains(other) || taken.contains(other));
    taken.insert(other);
    name = other;
  }
  return names;
}

using namespace hdf5;

void write_frame_links(const std::filesystem::path& path, const LinkedRobot& robot,
                       std::span<const std::size_t> numbers) {
  prepare();
  UnfinishedFile unfinished(path);
  WriteFailure failure;
  try {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS));
    checked(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_LATEST));
    set_recording_file(access, failure);
    Handle file(H5Fcreate(unfinished.path().c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access));
    const Handle recorded = space_of({robot.frames, robot.masses, 3}), one = space_of({robot.masses, 3});
    const Extent count{1, robot.masses, 3};
    for (const std::string element : {"position", "velocity"}) {
      Handle group = create_group(file, element);
      const std::string values = "/particles/" + robot.group + "/" + element + "/value";
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        const Extent start{numbers[i], 0, 0};
        checked(H5Sselect_hyperslab(recorded, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
        const Handle creation(H5Pcreate(H5P_DATASET_CREATE));
        checked(H5Pset_virtual(creation, one, robot.recording.c_str(), values.c_str(), recorded));
        Handle frame(
            H5Dcreate2(group, std::to_string(i).c_str(), H5T_IEEE_F32LE, one, H5P_DEFAULT, creation, H5P_DEFAULT));
        frame.close();
      }
      group.close();
    }
    file.close();
    if (failure.number != 0) throw Error("a write failed", failure.number);
  } catch (const Error& error) {
    const int number = failure.number != 0 ? failure.number : error.number();
    throw std::runtime_error(path.string() + ": " + (number != 0 ? reason_of(number) : error.what()));
  }
  try {
    unfinished.keep();
  } catch (const std::filesystem::filesystem_error& error) {
    throw std::runtime_error(path.string() + ": " + reason_of(error.code().value()));
  }
}

}  // namespace mercury
