// SPDX-License-Identifier: Apache-2.0
// Everything that ImGui draws: menu, panel columns, play bar, overlays. Executes the commands of menus and keys.
//
//   +----------------------------------------+
//   | menu                                   |  main_menu.cpp
//   +--------+----------------------+--------+
//   | panel  |                      | panel  |
//   | column |       viewport       | column |  panel_table.cpp
//   |        |                      |        |
//   +--------+----------------------+--------+
//   | play bar                               |  play_bar.cpp
//   +----------------------------------------+
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/window/panels/command_palette.h"
#include "app/window/panels/explosion_card.h"
#include "app/window/panels/help_window.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/key_bindings.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// The panels at one side of the window: a rail with an icon per panel, which is always there, and beside it a column
// with the open panel, whose edge can be dragged.
class PanelColumn {
 public:
  // Makes the panels of panel_table() that belong to this side.
  PanelColumn(Side side, PanelContext& context);

  // Draws the column between two heights of the window, `size` pixels wide. The user changes `open`, the title of the
  // open panel, and `width` [lines of text]. `card`: below the panel is the card of what was clicked.
  void draw(PanelContext& context, float top, float bottom, float size, std::string& open, float& width, bool card);
  // Draws the rail between two heights of the window; `open` is the title of the open panel, if the column is open.
  // Returns the panel whose icon was clicked.
  const PanelEntry* draw_rail(EventLog& log, float top, float bottom, const std::string* open);
  static float rail_pixels();
  // Converts a width to pixels; 0 lines = automatic. `narrow`: the window has room for one column only.
  static float pixels(float width, bool narrow);
  bool has(const std::string& title) const;

  // Passes the call on to each panel (panel.h).
  void work(PanelContext& context);

 private:
  void draw_edge(float top, float bottom, float size, float& width);

  struct Tab {
    const PanelEntry* entry;
    std::unique_ptr<Panel> panel;
  };

  const char* id_;
  bool right_;
  std::vector<Tab> tabs_;
};

class Panels {
 public:
  explicit Panels(PanelContext& context)
      : context_(context), left_(Side::left, context), right_(Side::right, context) {}

  // Draws menu, columns and play bar; returns the area that is left for the view.
  ViewportArea draw_frame();
  // Draws what lies over the view: explosions, help, messages.
  void draw_over(const ViewportArea& area, const render::Camera& camera, double dt);
  // Draws the open dialog. Call it after everything else that draws windows or tooltips.
  void draw_dialogs();
  // Executes a command of a key or menu.
  void execute(Action action);
  // Hands a key press to the command palette. Returns false if it is not open.
  bool press_in_palette(const KeyPress& press, std::optional<Action> command);
  // Opens a panel by its title.
  void show(const std::string& panel);
  // Background work of panels (panel.h).
  void work();
  bool busy() const { return first_steps_.fading(); }

  // Quits, after asking the user if changes would be lost.
  void quit();
  bool quit_confirmed() const { return quit_confirmed_; }

 private:
  void draw_menu();
  float draw_menu_hint();
  void draw_messages(const ViewportArea& area);
  void open_palette();
  std::vector<PaletteEntry> palette_entries();
  void show_keys_file();
  void draw_file_menu();
  void draw_edit_menu();
  void draw_view_menu();
  void menu_item(const char* name, Action action, bool enabled = true, bool checked = false);
  void frame_new_robots();
  bool is_narrow() const;
  bool column_open(Side side) const;
  void open_column(Side side, bool open);
  float draw_column(PanelColumn& column, Side side, float top, float bottom);
  void escape();

  PanelContext& context_;
  ExplosionCard explosions_;
  FirstSteps first_steps_;
  CommandPalette palette_;
  PanelColumn left_, right_;
  bool help_open_ = false, quit_confirmed_ = false;
  std::optional<Side> narrow_open_;  // the column that is open in a narrow window
};

}  // namespace mercury::window
