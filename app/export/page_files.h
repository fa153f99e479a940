// SPDX-License-Identifier: Apache-2.0
// The files of app/export/page, from which web pages are put together.
#pragma once

#include <span>

#include "app/base/embedded_file.h"

namespace mercury {

// cmake/EmbedFiles.cmake writes this function at build time.
std::span<const EmbeddedFile> page_files();

}  // namespace mercury
