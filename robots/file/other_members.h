// SPDX-License-Identifier: Apache-2.0
// Members of a robot's document that this version does not know. They are kept as JSON text (Robot::other), so that a
// file that is written again still has them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "mercury/error.h"
#include "robots/file/document.h"

namespace mercury {

// Takes the events of one member after another. Members that JSON cannot hold, such as byte strings, are left out.
class OtherMembers : public DocumentEvents {
 public:
  void begin_member(std::string_view name) {
    text_.clear();
    depth_ = 0;
    writer_.emplace(text_);
    keep([&] { writer_->begin_object(1), writer_->key(name); });
  }
  void on(const Event& event) override {
    keep([&] { writer_->on(event); });
    depth_ += event.change_of_depth();
    if (depth_ == 0) end_member();
  }

  // An object of all of them; empty if there are none.
  std::string take() { return members_.empty() ? "" : "{" + std::exchange(members_, {}) + "}"; }

 private:
  template <class Write>
  void keep(const Write& write) {
    if (!writer_) return;
    try {
      write();
    } catch (const InputError&) {
      writer_.reset();
    }
  }
  void end_member() {
    keep([&] { writer_->end_object(); });
    if (writer_) members_.append(members_.empty() ? "" : ",").append(text_, 1, text_.size() - 2);
    writer_.reset();
  }

  std::string text_, members_;
  std::optional<JsonWriter> writer_;  // of the current member, unless it is left out
  int depth_ = 0;                     // arrays and objects of it that are open
};

}  // namespace mercury
