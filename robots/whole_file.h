// SPDX-License-Identifier: Apache-2.0
// Files read and written whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mercury {

// The content of a file. Throws InputError("eel.json: No such file or directory") for a file that cannot be read or is
// not a regular file.
std::string read_whole_file(const std::filesystem::path& path);

// Writes under a temporary name in the same folder, then renames, so readers find the whole old file or the whole new
// one. Follows links. Writes directly to what is no file, such as a device or a pipe. On failure (a missing folder, no
// permission, a full disk) throws InputError with the path and the system's reason, and leaves nothing behind.
void write_whole_file(const std::filesystem::path& path, std::string_view content);

}  // namespace mercury
