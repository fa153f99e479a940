// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace mercury::window {

using Kind = InputEvent::Kind;

void InputQueue::push(const InputEvent& event) {
  // Of several moves in a row, only the last position matters.
  if (event.kind == Kind::move && !waiting_.empty() && waiting_.back().kind == Kind::move)
    waiting_.back() = event;
  else
    waiting_.push_back(event);
}

std::vector<InputEvent> InputQueue::take() {
  std::vector<InputEvent> events;
  bool typed = false, scrolled = false;
  while (!waiting_.empty()) {
    const InputEvent event = waiting_.front();
    if ((event.kind == Kind::button && typed) || (event.kind == Kind::move && scrolled)) break;
    waiting_.pop_front();
    events.push_back(event);
    const bool press = event.action == GLFW_PRESS, of_key = event.kind == Kind::key,
               of_button = event.kind == Kind::button;
    typed = typed || of_key || event.kind == Kind::character;
    scrolled = scrolled || event.kind == Kind::scroll;
    if (event.kind == Kind::scroll || ((of_key || of_button) && press)) ++taken_;
    if (of_button || (of_key && !event.types && event.action != GLFW_RELEASE)) break;
  }
  return events;
}

}  // namespace mercury::window
