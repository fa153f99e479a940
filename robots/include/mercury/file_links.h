// SPDX-License-Identifier: Apache-2.0
// Where the name of a file that is to be written leads, and how a finished file gets it.
#pragma once

#include <filesystem>
#include <stdexcept>

namespace mercury {

// A device, a pipe or a socket: it takes what is written, and must not be replaced by a file.
bool is_device_or_pipe(const std::filesystem::path& path);

// The end of a chain of links, even if no file exists there yet.
std::filesystem::path follow_links(std::filesystem::path path);

// Throws InputError if links lead from `file`, a name in `folder`, to somewhere else: what is written there would not
// be in the folder.
void require_inside(const std::filesystem::path& folder, const std::filesystem::path& file);

// Before hours of work for a file: whether one of that name `exists`. If none does, and there is one when the work is
// done, that is another program's, and publish() keeps both. Of this process; it ends when the name is published.
void note_output(const std::filesystem::path& file, bool exists);
// Whether another program has taken the name since note_output() found it free; that of a folder, with a file in it.
bool is_taken(const std::filesystem::path& file);

// A finished file has another name than it should: both are kept.
struct NameTaken : std::runtime_error {
  NameTaken(const std::filesystem::path& wanted, std::filesystem::path given);
  std::filesystem::path name;  // that it has
};

// "a-2.h5" of "a.h5" and 2.
std::filesystem::path numbered(const std::filesystem::path& file, int number);

// Renames a finished file, or folder, in the folder where `target` will be. Replaces a file of that name, unless not
// `replaces` or its name was free at note_output(): then this one gets the first free name, and NameTaken is thrown.
// Throws std::filesystem::filesystem_error.
void publish(const std::filesystem::path& finished, const std::filesystem::path& target, bool replaces = true);

}  // namespace mercury
