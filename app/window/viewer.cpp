#include "app/window/viewer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "app/group_scene.h"
#include "app/position_bridge.h"
#include "app/window/camera_hand.h"
#include "app/window/interface.h"
#include "app/window/observations.h"
#include "app/window/picture_view.h"
#include "app/window/theme.h"
#include "app/window/toasts.h"

namespace mercury::window {
namespace {

using Clock = std::chrono::steady_clock;

class Viewer {
 public:
  explicit Viewer(ViewerOptions options)
      : options_(std::move(options)), window_("Mercury", {1280, 720}), interface_(window_, {}),
        picture_(window_.context(), options_.quality),
        observations_(options_.report.empty() ? Observations() : Observations(options_.report)),
        simulation_(options_.configuration, options_.robots),
        scene_(simulation_, offsets(), options_.view), details_(simulation_, options_.view), bridge_(make_host_bridge()) {
    scene_.set_bodies(picture_.renderer());
    update();
    camera_.start(scene_.bounds(), 16.0f / 9, false);
  }

  int run() {
    auto last = Clock::now();
    while (!window_.asked_to_close()) {
      window_.poll(0.001);
      const auto now = Clock::now();
      const double dt = std::chrono::duration<double>(now - last).count();
      last = now;
      frame(dt);
    }
    return 0;
  }

 private:
  std::vector<Eigen::Vector3f> offsets() const {
    std::vector<render::Bounds> bounds;
    for (const Robot& robot : options_.robots) bounds.push_back(rest_bounds(robot));
    return grid_layout(bounds, {});
  }

  void update() {
    const std::vector<Telemetry> telemetry = simulation_.telemetry();
    snapshot_ = bridge_->take(simulation_);
    scene_.update(simulation_.time(), telemetry, details_.observe(telemetry));
    bridge_->show(*snapshot_, picture_.renderer(), scene_.scene());
  }

  void frame(double dt) {
    for (const Press& press : window_.take_presses()) {
      if (press.key == ' ' || press.character == U' ') playing_ = !playing_;
    }
    if (playing_) {
      const auto begin = Clock::now();
      const double target = simulation_.time() + std::min(dt, 0.1);
      while (simulation_.time() < target && Clock::now() - begin < std::chrono::milliseconds(25)) simulation_.step(4);
      update();
    }
    interface_.set_looks(options_.view.theme, 1);
    interface_.begin_frame();
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.WantCaptureMouse) {
      const float height = io.DisplaySize.y;
      if (ImGui::IsMouseDragging(0, 2)) camera_.turn(io.MouseDelta.x / height, -io.MouseDelta.y / height);
      if (ImGui::IsMouseDragging(1, 2)) camera_.pan(io.MouseDelta.x / height, -io.MouseDelta.y / height);
      if (io.MouseWheel != 0) camera_.zoom(std::pow(0.88f, io.MouseWheel));
    }
    ImGui::Begin("Play", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
    if (ImGui::Button(playing_ ? "Pause" : "Play")) playing_ = !playing_;
    observations_.item("play");
    ImGui::Text("%.2f s, %.1f ms a picture", simulation_.time(), 1000 * picture_.draw_seconds());
    ImGui::End();
    const WindowSize pixels = window_.pixels();
    picture_.place(0, 0, pixels.width, pixels.height);
    picture_.draw(scene_.scene(), camera_.at(scene_.bounds(), picture_.aspect(), dt), playing_);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, pixels.width, pixels.height);
    glClearColor(0.05f, 0.06f, 0.07f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    picture_.present(pixels.height);
    interface_.end_frame();
    window_.show_picture();
    observations_.end_frame();
    for (const std::string& message : window_.context().take_messages()) observations_.tell("gl", {{"text", message}});
    if (frames_++ == 0) observations_.tell("ready", {{"seconds", 0}});
  }

  ViewerOptions options_;
  Window window_;
  Interface interface_;
  PictureView picture_;
  Observations observations_;
  Simulation simulation_;
  GroupScene scene_;
  DetailObserver details_;
  std::unique_ptr<PositionBridge> bridge_;
  std::unique_ptr<PositionSnapshot> snapshot_;
  CameraHand camera_;
  bool playing_ = true;
  long frames_ = 0;
};

}  // namespace

int run_viewer(ViewerOptions options) { return Viewer(std::move(options)).run(); }

}  // namespace mercury::window
