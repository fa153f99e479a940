// SPDX-License-Identifier: Apache-2.0
// All panels of the window, and what keys and menus do with them.
#pragma once

#include "app/window/panels/browser_panel.h"
#include "app/window/panels/explosion_card.h"
#include "app/window/panels/materials_panel.h"
#include "app/window/panels/measure_panel.h"
#include "app/window/panels/panel_column.h"
#include "app/window/panels/panel_context.h"
#include "app/window/panels/performance_panel.h"
#include "app/window/panels/robots_panel.h"
#include "app/window/panels/video_panel.h"
#include "app/window/toolkit/key_bindings.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

class Panels {
 public:
  Panels(PanelContext& context, Window& window, Viewport& picture);

  // Menu, columns and play bar; returns the place that is left for the picture.
  ViewportArea draw_frame();
  // What lies over the picture.
  void draw_over(const ViewportArea& area, const render::Camera& camera, double dt);
  void execute(const Command& command);
  // Closes the window; where something would be lost, asks first.
  void quit();
  bool quits() const { return quits_; }
  void note(const FrameTimes& cost) { performance_.note(cost); }
  // Background work of panels, for at most so long [s]; takes what it took.
  void work(double seconds);
  bool busy() const { return browser_.busy(); }
  // Opens a panel by its name.
  void show(const std::string& panel);

  bool take_screenshot_request() { return std::exchange(screenshot_requested_, false); }
  RandomRobots& generation() { return robots_.random.generation; }
  VideoPanel& film() { return film_; }
  const VideoPanel& film() const { return film_; }

 private:
  void draw_menu();
  void menu_item(const char* name, Action action, bool enabled = true, bool checked = false);
  void change_view(Action action, int number);
  void change_camera(Action action);
  void escape();

  PanelContext& context_;
  Window& window_;
  Viewport& picture_;
  RobotsPanel robots_;
  BrowserPanel browser_;
  MaterialsPanel materials_;
  MeasurePanel measure_;
  RankingPanel ranking_;
  PerformancePanel performance_;
  VideoPanel film_;
  ExplosionCard explosions_;
  PanelColumn left_, right_;
  bool help_ = false, screenshot_requested_ = false, quits_ = false;
  float aspect_ = 16.0f / 9;
};

}  // namespace mercury::window
