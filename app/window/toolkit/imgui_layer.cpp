// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/imgui_layer.h"

#include <epoxy/gl.h>
// After epoxy, which declares OpenGL.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <string_view>

#include "app/window/toolkit/embedded.h"
#include "app/window/toolkit/theme.h"

namespace mercury::window {
namespace {

constexpr float text_height = 17;  // of a line at scale 1 [pixels]

// Latin and Greek letters, and the symbols that panels use.
const ImWchar* glyphs() {
  static const ImWchar ranges[] = {0x20,   0x17f,  0x391,  0x3c9,  0x2010, 0x2027, 0x2030, 0x2030,
                                   0x2070, 0x207f, 0x2190, 0x2193, 0x2206, 0x2206, 0x2212, 0x2212,
                                   0x221e, 0x221e, 0x2248, 0x2248, 0x2264, 0x2265, 0};
  return ranges;
}

void add_font(std::string_view file, float size, const ImWchar* ranges, const ImFontConfig& config) {
  // ImGui does not write to it.
  ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<char*>(file.data()), static_cast<int>(file.size()),
                                             std::round(size), &config, ranges);
}

void add_text_font(float size, bool with_icons) {
  static constexpr ImWchar icons[] = {0xf000, 0xf2e0, 0};
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  config.OversampleH = 2;
  config.PixelSnapH = false;
  add_font(embedded_file("Lato-Medium.ttf"), size, glyphs(), config);
  if (!with_icons) return;
  config.OversampleH = 1;
  config.MergeMode = true;
  config.GlyphOffset.y = std::round(0.04f * size);
  add_font(embedded_file("fontawesome-webfont.ttf"), size, icons, config);
}

void add_to(std::uint64_t& hash, const void* data, std::size_t bytes) {
  const std::string_view text(static_cast<const char*>(data), bytes);
  hash = 0x9e3779b97f4a7c15 * (std::rotl(hash, 5) ^ std::hash<std::string_view>()(text));
}

// Triangles, their colors and textures, but not what is in the textures.
std::uint64_t hash_of(const ImDrawData& data) {
  std::uint64_t hash = 1;
  const std::array<float, 4> display{data.DisplaySize.x, data.DisplaySize.y, data.FramebufferScale.x,
                                     data.FramebufferScale.y};
  add_to(hash, display.data(), sizeof display);
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    add_to(hash, list.VtxBuffer.Data, static_cast<std::size_t>(list.VtxBuffer.size_in_bytes()));
    add_to(hash, list.IdxBuffer.Data, static_cast<std::size_t>(list.IdxBuffer.size_in_bytes()));
    for (const ImDrawCmd& command : list.CmdBuffer) {
      add_to(hash, &command.ClipRect, sizeof command.ClipRect);
      add_to(hash, &command.TextureId, sizeof command.TextureId);
      const std::array<unsigned, 3> part{command.VtxOffset, command.IdxOffset, command.ElemCount};
      add_to(hash, part.data(), sizeof part);
    }
  }
  return hash;
}

}  // namespace

ImGuiLayer::ImGuiLayer(Window& window, const std::filesystem::path& layout_file)
    : window_(window), layout_file_(layout_file.string()) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = layout_file_.empty() ? nullptr : layout_file_.c_str();
  io.ConfigWindowsMoveFromTitleBarOnly = true;
#if IMGUI_VERSION_NUM >= 18700
  io.ConfigInputTrickleEventQueue = false;  // InputQueue already shares events out among frames
#endif
  ImGui_ImplGlfw_InitForOpenGL(window.handle(), false);
  ImGui_ImplOpenGL3_Init("#version 450");
}

ImGuiLayer::~ImGuiLayer() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void ImGuiLayer::set_appearance(render::Theme theme, float text_scale) {
  changed_ = changed_ || theme != theme_ || text_scale != text_scale_;
  theme_ = theme;
  text_scale_ = text_scale;
}

void ImGuiLayer::build_fonts() {
  const float scale = screen_scale_ * text_scale_;
  ImGui::GetIO().Fonts->Clear();
  add_text_font(text_height * scale, true);
  add_text_font(1.5f * text_height * scale, false);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
  apply_theme(theme_, scale);
  drawn_ = 0;  // other letters may be in the same places of the texture
}

void ImGuiLayer::feed(const InputEvent& event) {
  GLFWwindow* window = window_.handle();
  switch (event.kind) {
    case InputEvent::Kind::move:
      pointer_.x = static_cast<float>(event.x);
      pointer_.y = static_cast<float>(event.y);
      pointer_.inside = true;
#if IMGUI_VERSION_NUM >= 18700
      ImGui_ImplGlfw_CursorPosCallback(window, event.x, event.y);
#endif
      break;
    case InputEvent::Kind::enter:
      pointer_.inside = event.on;
      ImGui_ImplGlfw_CursorEnterCallback(window, event.on);
      break;
    case InputEvent::Kind::focus:
      ImGui_ImplGlfw_WindowFocusCallback(window, event.on);
      break;
    case InputEvent::Kind::button:
      if (event.code >= 0 && event.code < static_cast<int>(pointer_.down.size()))
        pointer_.down[static_cast<std::size_t>(event.code)] = event.action == GLFW_PRESS;
      ImGui_ImplGlfw_MouseButtonCallback(window, event.code, event.action, event.mods);
      break;
    case InputEvent::Kind::scroll:
      ImGui_ImplGlfw_ScrollCallback(window, event.x, event.y);
      break;
    case InputEvent::Kind::key:
      ImGui_ImplGlfw_KeyCallback(window, event.code, event.scancode, event.action, event.mods);
      break;
    case InputEvent::Kind::character:
      ImGui_ImplGlfw_CharCallback(window, static_cast<unsigned>(event.code));
      break;
  }
}

void ImGuiLayer::begin_frame(const std::vector<InputEvent>& events) {
  if (const float scale = window_.content_scale(); scale != screen_scale_) {
    screen_scale_ = scale;
    changed_ = true;
  }
  if (changed_) build_fonts();
  changed_ = false;
  for (const InputEvent& event : events) feed(event);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
#if IMGUI_VERSION_NUM < 18700
  // NewFrame() has read the pointer's current position from GLFW. Put back the position of this frame's events.
  ImGuiIO& io = ImGui::GetIO();
  const bool held = std::find(pointer_.down.begin(), pointer_.down.end(), true) != pointer_.down.end();
  io.MousePos = pointer_.inside || held ? ImVec2(pointer_.x, pointer_.y) : ImVec2(-FLT_MAX, -FLT_MAX);
  std::copy(pointer_.down.begin(), pointer_.down.end(), io.MouseDown);
#endif
  // A press and a release each wait for a frame of their own, so where frames are slow the second press is late.
  const float seconds = ImGui::GetIO().DeltaTime;
  ImGui::GetIO().MouseDoubleClickTime = 0.3f + last_seconds_ + seconds;
  last_seconds_ = seconds;
  ImGui::NewFrame();
}

bool ImGuiLayer::end_frame() {
  ImGui::Render();
  frame_ = hash_of(*ImGui::GetDrawData());
  return frame_ != drawn_;
}

void ImGuiLayer::draw() {
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  drawn_ = frame_;
}

void ImGuiLayer::draw_on_top(const std::function<void(ImDrawList& list)>& draw) {
  ImDrawList list(ImGui::GetDrawListSharedData());
  list._ResetForNewFrame();
  list.PushTextureID(ImGui::GetIO().Fonts->TexID);
  list.PushClipRectFullScreen();
  draw(list);
  ImDrawData data = *ImGui::GetDrawData();  // for the size of the display
#if IMGUI_VERSION_NUM < 18980
  ImDrawList* lists = &list;
  data.CmdLists = &lists;
#else
  data.CmdLists.resize(0);
  data.CmdLists.push_back(&list);
#endif
  data.CmdListsCount = 1;
  data.TotalVtxCount = list.VtxBuffer.Size;
  data.TotalIdxCount = list.IdxBuffer.Size;
  ImGui_ImplOpenGL3_RenderDrawData(&data);
}

void ImGuiLayer::discard_frame() { ImGui::EndFrame(); }

ImFont* large_font() { return ImGui::GetIO().Fonts->Fonts[1]; }

}  // namespace mercury::window
