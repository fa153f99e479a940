// SPDX-License-Identifier: Apache-2.0
// A file that takes the results of a command, such as --csv FILE.
#pragma once

#include <string>
#include <string_view>

namespace mercury {

// "-" and "/dev/stdout" stand for standard output.
bool is_standard_output(const std::string& file);

// Fails before long work rather than after it. Throws InputError(option, ...) for a folder, or a file that cannot be
// written.
void require_writable(const std::string& option, const std::string& file);

// Throws InputError if it cannot be written.
void write_results(const std::string& file, std::string_view content);

}  // namespace mercury
