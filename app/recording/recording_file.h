// SPDX-License-Identifier: Apache-2.0
// The file of a recording, as HDF5 writes it.
//
// HDF5 1.10 does not survive a write that fails: what it could not write while an object was closed stays in its
// tables with its memory freed, where the next recording of the process finds it. So it learns nothing of a failure.
// The file stays as it is at that moment, as after a kill, and what HDF5 writes from then on goes to memory until it
// closes the file.
#pragma once

#include "app/recording/hdf5_handle.h"

namespace mercury {

// Shared by a file and its writer.
struct WriteFailure {
  int number = 0;  // errno of the first write that failed; 0 = none. Set it to stop writing.
};

// Files that are opened with these access properties are written by this driver. `failure` must outlive them.
void set_recording_file(hdf5::Id access, WriteFailure& failure);

}  // namespace mercury
