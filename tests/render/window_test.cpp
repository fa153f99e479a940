// SPDX-License-Identifier: Apache-2.0
// Adopts the context of a hidden window and presents a picture in it. Without a display, the test starts one.
#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "render/context/context.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "tests/render/wobbling_bodies.h"

extern char** environ;

namespace mercury::render {
namespace {

// Starts a display for its lifetime, unless there is one.
class Display {
 public:
  Display() {
    if (std::getenv("DISPLAY")) return;
    int ends[2];
    if (pipe(ends) != 0) return;
    const std::string end = std::to_string(ends[1]);
    // Without -noreset the server restarts when a client ends, and refuses the next client meanwhile.
    std::array<const char*, 9> arguments{"Xvfb",       "-displayfd", end.c_str(), "-screen", "0",
                                         "640x480x24", "-nolisten",  "tcp",       "-noreset"};
    std::vector<char*> argv;
    for (const char* argument : arguments) argv.push_back(const_cast<char*>(argument));
    argv.push_back(nullptr);
    if (posix_spawnp(&server_, "Xvfb", nullptr, nullptr, argv.data(), environ) != 0) server_ = -1;
    close(ends[1]);
    // The server writes the display's number when it is ready, and nothing if it is not installed.
    std::string number;
    for (char c; ::read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    close(ends[0]);
    if (!number.empty()) setenv("DISPLAY", (":" + number).c_str(), 1);
  }
  ~Display() {
    if (server_ <= 0) return;
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
  }

 private:
  pid_t server_ = -1;
};

class WindowTest : public testing::Test {
 protected:
  static constexpr int width = 160, height = 120;

  void SetUp() override {
    static const Display display;
    if (!std::getenv("DISPLAY")) GTEST_SKIP() << "no display, and no Xvfb to make one";
    if (!glfwInit()) GTEST_SKIP() << "GLFW does not start on this display";
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
    window_ = glfwCreateWindow(width, height, "test", nullptr, nullptr);
    if (!window_) GTEST_SKIP() << "no OpenGL 4.5 on this display";
    glfwMakeContextCurrent(window_);
    context_ = adopt_context([this] { glfwMakeContextCurrent(window_); }, [] { glfwMakeContextCurrent(nullptr); });
  }
  void TearDown() override {
    if (context_)
      for (const std::string& message : context_->take_messages()) ADD_FAILURE() << "OpenGL says: " << message;
    context_.reset();
    if (window_) glfwDestroyWindow(window_);
    glfwTerminate();
  }

  Renderer drawn(int picture_width, int picture_height) {
    Renderer renderer(*context_, {.width = picture_width, .height = picture_height, .quality = Quality::low});
    const WobblingGroup group = make_wobbling_group(2, 4, 3, 0.8f);
    renderer.set_bodies(group.views());
    Scene scene;
    scene.placements = group.placements;
    renderer.draw(scene, Orbit{.distance = 3}.camera());
    return renderer;
  }
  // The window's pixels, upper row first.
  static Image window_pixels() {
    Image image{width, height, PixelFormat::rgb, std::vector<std::uint8_t>(3 * width * height)};
    std::vector<std::uint8_t> rows(image.bytes.size());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glReadBuffer(GL_BACK);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
    for (std::size_t y = 0; y < height; ++y)
      std::copy_n(rows.begin() + std::ptrdiff_t((height - 1 - y) * 3 * width), 3 * width,
                  image.bytes.begin() + std::ptrdiff_t(y * 3 * width));
    return image;
  }

  GLFWwindow* window_ = nullptr;
  std::unique_ptr<Context> context_;
};

TEST_F(WindowTest, AnAdoptedContextDescribesItself) {
  EXPECT_EQ(context_->kind(), ContextKind::window);
  EXPECT_THAT(context_->describe(), testing::HasSubstr("OpenGL 4."));
  context_->release();
  EXPECT_EQ(glfwGetCurrentContext(), nullptr);
  context_->make_current();
  EXPECT_EQ(glfwGetCurrentContext(), window_);
}

TEST_F(WindowTest, PresentedPixelsAreThoseOfThePicture) {
  const Renderer renderer = drawn(width, height);
  const Image picture = render::read(renderer);
  renderer.present(0, 0, 0, width, height);
  EXPECT_EQ(window_pixels().bytes, picture.bytes);
}

TEST_F(WindowTest, PresentingIntoAPartOfTheWindowScalesThePictureAndKeepsTheRest) {
  const Renderer renderer = drawn(width, height);
  const Image picture = render::read(renderer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glClearColor(1, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  renderer.present(0, 0, 0, width / 2, height / 2);  // the lower left quarter
  const Image window = window_pixels();
  const auto pixel = [](const Image& image, int x, int y) {
    const std::size_t at = 3 * (std::size_t(y) * width + std::size_t(x));
    return std::array<int, 3>{image.bytes[at], image.bytes[at + 1], image.bytes[at + 2]};
  };
  EXPECT_EQ(pixel(window, width / 2 + 2, height - 2), (std::array<int, 3>{255, 0, 0}));
  EXPECT_EQ(pixel(window, 2, height / 2 - 2), (std::array<int, 3>{255, 0, 0}));
  double sum = 0;
  for (int y = 4; y < height / 2 - 4; ++y)
    for (int x = 4; x < width / 2 - 4; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        sum += std::abs(pixel(window, x, height / 2 + y)[c] - pixel(picture, 2 * x, 2 * y)[c]);
  EXPECT_LT(sum / (3 * (width / 2 - 8) * (height / 2 - 8)), 8);  // as a blurred copy
}

}  // namespace
}  // namespace mercury::render
