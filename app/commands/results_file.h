// SPDX-License-Identifier: Apache-2.0
// A file that takes the results of a command, such as --csv FILE.
#pragma once

#include <string>
#include <string_view>

#include "app/base/output_files.h"

namespace mercury {

// Writes a file whole or not at all; writes directly into a device, a pipe or standard output ("-", "/dev/stdout").
// Waits for the reader of a named pipe. Throws InputError or std::runtime_error if it cannot be written, Interrupted;
// NameTaken as publish().
void write_results(const std::string& file, std::string_view content);

}  // namespace mercury
