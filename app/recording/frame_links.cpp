// SPDX-License-Identifier: Apache-2.0
#include "app/recording/frame_links.h"

#include <stdexcept>

#include "app/base/interrupt.h"
#include "app/recording/recording_file.h"
#include "app/recording/trajectory_hdf5_writing.h"
#include "mercury/error.h"
#include "mercury/file_links.h"

namespace mercury {

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
