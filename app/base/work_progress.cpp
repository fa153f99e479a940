// SPDX-License-Identifier: Apache-2.0
#include "app/base/work_progress.h"

#include <memory>
#include <optional>
#include <string_view>

#include "app/base/interrupt.h"
#include "app/base/progress.h"

namespace mercury {

WorkWatch shown_work() {
  struct Shown {
    std::string_view what;
    std::optional<Progress> progress;
  };
  return [shown = std::make_shared<Shown>()](const char* what, std::size_t done, std::size_t total) {
    throw_if_interrupted();
    if (shown->what != what) {
      shown->what = what;
      shown->progress.emplace(what, "robots", static_cast<std::int64_t>(total));
    }
    if (shown->progress) shown->progress->update(static_cast<std::int64_t>(done));
    if (done == total) shown->progress.reset();
  };
}

}  // namespace mercury
