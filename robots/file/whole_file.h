// SPDX-License-Identifier: Apache-2.0
// Files read and written whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace mercury {

// Throws the system's reason why a file cannot be used: InputError, or std::runtime_error where the machine is at fault
// (a full disk, no memory, a device that fails).
[[noreturn]] void fail(const std::filesystem::path& path, int error);

// The content of a file. Throws InputError("eel.json: No such file or directory") for a file that cannot be read or is
// not a regular file.
std::string read_whole_file(const std::filesystem::path& path);

// Writes under a temporary name in the same folder, then renames, so readers find the whole old file or the whole new
// one. Follows links. Writes directly to what is no file, such as a device or a pipe. On failure (a missing folder, no
// permission, a full disk) throws as fail(), and leaves nothing behind; throws NameTaken as publish().
void write_whole_file(const std::filesystem::path& path, std::string_view content);

}  // namespace mercury
