// SPDX-License-Identifier: Apache-2.0
// Commands that panels, menus and keys share, and what is drawn beside the panels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/live/messages.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_comparison.h"
#include "app/scene/view_settings.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/key_bindings.h"
#include "app/window/viewport/viewport.h"

namespace mercury::window {

// On robots and on the whole scene (robot_commands.cpp).

// The selected robots; all robots if none is selected.
std::vector<RobotId> selected_or_all(const LiveScene& scene);

// The name of a robot; "?" if it does not exist.
std::string name_of_robot(const LiveScene& scene, RobotId robot);

// A thumbnail of a robot; 0 until it is drawn.
ImTextureID thumbnail_of_robot(PanelContext& context, RobotId robot);

// Moves the camera so that it shows these robots; all robots if the list is empty.
void frame_robots(PanelContext& context, const std::vector<RobotId>& robots);

// Makes random robots with the settings of context.creation, and increments the seed for the next time.
void generate_robots(PanelContext& context);

// Adds a mutated copy of each selected robot.
void mutate_selected(PanelContext& context);
// Adds a child of the two selected robots.
void breed_selected(PanelContext& context);
// Asks for a new name of the current robot.
void rename_selected(PanelContext& context);
void invert_selection(PanelContext& context);
// Removes all robots but these, as one edit. Nothing happens if the list is empty.
void keep_only(PanelContext& context, const std::vector<RobotId>& robots);
// Asks how many robots to keep. `order`: the best first; empty = those that went farthest at equal age.
void ask_for_best(PanelContext& context, std::vector<RobotId> order = {});

// Runs `act` while the scene's view settings hold the camera of the window, and then restores them.
void with_window_camera(PanelContext& context, const std::function<void()>& act);

// Copies the command line that makes this scene to the clipboard. `subcommand`: "view" or "render".
void copy_as_command(PanelContext& context, const char* subcommand);

void change_view(PanelContext& context, const std::function<void(ViewSettings& view)>& change);

// Switches the arrows of a command on or off.
void toggle_arrows(PanelContext& context, Action action);

// Camera bookmarks, and views along an axis (camera_commands.cpp).

// The camera as it is now becomes a bookmark of the scene, 0 to most_bookmarks - 1.
void set_bookmark(PanelContext& context, std::size_t place);
// Goes to a bookmark, or says that it is not set.
void go_to_bookmark(PanelContext& context, std::size_t place);

// Looks along an axis, 0 to 2, from its positive side, or from its negative one.
void look_along(PanelContext& context, int axis, bool from_negative = false);

// The axes in a corner of the view, at its lower right; a click on an end looks from there. `above`: free room below
// it [pixels].
Box draw_axes(PanelContext& context, const ViewportArea& area, const render::Camera& camera, float above);

// Opens, saves and exports robots and scenes through the file dialog (file_commands.cpp).

// Asks for files and opens them.
void open_robots(PanelContext& context);
// Asks where to save the scene: robots, environment, solver, camera and looks.
void save_scene(PanelContext& context);
// Asks where to save the selected robots, or all robots if none is selected.
void save_robots(PanelContext& context);
// Calls `quit`, after asking the user if changes to robots would be lost.
void quit_with_confirmation(PanelContext& context, std::function<void()> quit);

// Calls save(false). If files exist already, asks the user and calls save(true). Shows the result; after a
// failure the file dialog opens again as the user left it. `what` names the contents in messages: "ranking".
void save_with_confirmation(PanelContext& context, const std::string& what,
                            std::function<SaveResult(bool overwrite)> save);

// Asks for a file and saves the text that make() returns then.
void save_csv(PanelContext& context, const std::string& what, std::function<std::string()> make);

// Exports a robot for other programs through the file dialog: the selected one, else the first.
// Its current pose.
void export_pose(PanelContext& context);
// Its motion from time 0: asks for how long, and where.
void export_motion(PanelContext& context);
// Asks for the file of a web page of the open run.
void export_run(PanelContext& context);

// On the evolution that the window has open (evolution_commands.cpp).

// The dialog "Evolve": asks for the settings of a new run, and starts it in the background from the selected robots, or
// all if none is selected.
void ask_evolve(PanelContext& context);

// Opens what was dropped or chosen: a run (its folder, or the run.toml in it), and robots.
void open_paths(PanelContext& context, const std::vector<std::filesystem::path>& paths);

// Opens a run: its best robots and its configuration replace the scene.
void open_run(PanelContext& context, const std::filesystem::path& folder);
// Opens the run of the command line. The scene has its configuration already.
void open_first_run(PanelContext& context, const std::filesystem::path& folder);
// Asks for the folder of a run and opens it.
void choose_run(PanelContext& context);

// Puts the robot of an individual of the run into the scene, or selects it if it is there.
void add_individual(PanelContext& context, std::uint64_t id);

// A thumbnail of an individual of the run; 0 until it is drawn.
ImTextureID thumbnail_of_individual(PanelContext& context, std::uint64_t id);

// Asks for the settings of a new run and starts it from the selected robots.
void evolve_selected(PanelContext& context);

// The bar with the timeline, play, pause, step, reset, time and speed (play_bar.cpp).

// Its height: the timeline, and the controls below it [pixels].
float play_bar_height();

// Draws the bar in this rectangle of the window.
void draw_play_bar(PanelContext& context, ImVec2 low, ImVec2 high);

// Draws the timeline over the play controls, the moments of the last minutes or of a recording, to be dragged along: at
// ImGui's cursor, as wide as the window.
void draw_timeline_strip(PanelContext& context);

// A drag over moments, on the strip or in a plot. Robots that played go on when it ends.
void begin_scrub(PanelContext& context);
void scrub_to(PanelContext& context, double time);  // [s]
void end_scrub(PanelContext& context);

// Begins a loop at the moment shown, closes it there, or ends it.
void mark_loop(PanelContext& context);
// Sets or removes a bookmark at the moment shown.
void toggle_bookmark(PanelContext& context);
// Goes on from the moment shown, if it is an earlier one.
void go_on(PanelContext& context);
// Copies the selected robots in the state of the moment shown, which goes on.
void fork(PanelContext& context);

// Environments (tune_panel.cpp).

// A way into an environment: its preset, and what is changed besides so that robots hold there.
struct EnvironmentOffer {
  std::string_view environment;    // "land"
  std::string name;                // "land with XPBD"
  std::string item;                // of the event log
  std::string help;                // may be empty
  void (*adjust)(Configuration&);  // nullptr = nothing
};
// All presets. Beside land stand its safe variants if robots of the scene are `made_for_water` and the configuration
// would tear them apart there.
std::vector<EnvironmentOffer> environment_offers(const Configuration& configuration, bool made_for_water);
// Whether a robot of the scene is made for water.
bool has_water_robots(const LiveScene& scene);

// Edits a body in the view: clicks on its skin add, remove or paint voxels (body_editor.cpp).

// Starts editing the selected robot, or stops.
void toggle_body_editor(PanelContext& context);

// Draws the tools at the top of the view while a body is edited, and stops when its robot is gone.
void draw_body_editor(PanelContext& context, const ViewportArea& area);
// Outlines the voxel that a click there would add, take away or paint.
void draw_voxel_outline(PanelContext& context, const Hit& hit, const ViewportArea& area, const render::Camera& camera);

// Applies the tool to what was clicked. Returns false if no body is edited, or the click was beside it.
bool edit_body_at(PanelContext& context, const Hit& hit);

// The figures of the mass and spring that were clicked, as a card below a panel, where it covers no robot
// (probes_panel.cpp).
void draw_pinned_card(PanelContext& context);
float pinned_card_height();  // [pixels]

// The part of the View panel that chooses what the colors show (color_section.cpp).

// Draws one button per quantity of color_quantities(), and the scale, which is fixed as it is `shown` now. Returns true
// if `view` changed.
bool draw_color_section(ViewSettings& view, std::pair<float, float> shown, const Environment& environment,
                        const KeyMap& keys, EventLog& log);

// Colors by a quantity, with its usual scale. Shows the legend if it has values, as the command line does.
void color_by(ViewSettings& view, const ColorQuantity& quantity);

// The quantity that a command colors by; nullptr if it does not color.
const ColorQuantity* quantity_of(Action action);

// Of panels.

// What the key does: the second view on and off. It begins with what it was last.
void toggle_second_view(PanelContext& context);
// Ghosts of the selected robots on and off.
void toggle_ghosts(PanelContext& context, GhostOf of = GhostOf::automatic);

// Changes the size of the text by some tenths, within its limits.
void change_text_size(PanelContext& context, int tenths);

// Shows the messages of a background part as toasts.
void show_messages(Toasts& toasts, const std::vector<Message>& messages);

}  // namespace mercury::window
