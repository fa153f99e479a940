// SPDX-License-Identifier: Apache-2.0
// The history of messages, to read again and to copy.
#pragma once

#include <optional>
#include <vector>

#include "app/live/messages.h"
#include "app/window/panels/panel.h"

namespace mercury::window {

// Shows the messages of a background part as toasts.
void show_messages(Toasts& toasts, const std::vector<Message>& messages);

class MessagesPanel : public Panel {
 public:
  void draw(PanelContext& context) override;

 private:
  void draw_row(PanelContext& context, const PastMessage& message, std::size_t row);

  std::optional<Tone> only_;  // shows messages of this tone only
  std::size_t seen_ = 0;      // messages when the panel was drawn last
};

}  // namespace mercury::window
