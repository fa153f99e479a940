// SPDX-License-Identifier: Apache-2.0
// Where the name of a file that is to be written leads.
#pragma once

#include <filesystem>

namespace mercury {

// A device, a pipe or a socket: it takes what is written, and must not be replaced by a file.
bool is_device_or_pipe(const std::filesystem::path& path);

// The end of a chain of links, even if no file exists there yet.
std::filesystem::path follow_links(std::filesystem::path path);

// Throws InputError if links lead from `file`, a name in `folder`, to somewhere else: what is written there would not
// be in the folder.
void require_inside(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace mercury
