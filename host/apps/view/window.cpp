#include "view/window.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "photile/errors.hpp"
#include "view/picture_area.hpp"

namespace photile::view {
namespace {

/// OpenGL 1.2's, which the header of OpenGL 1.1 lacks.
constexpr GLint clamp_to_edge = 0x812F;

std::string reason() {
  const char* description = nullptr;
  return glfwGetError(&description) != GLFW_NO_ERROR && description ? description : "unknown";
}

ImTextureID id_of(GLuint texture) {
  return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
}

WindowSize most_of_the_screen() {
  constexpr int part = 8, of = 10;
  constexpr WindowSize usual{1280, 800};
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  if (!monitor) return usual;
  WindowSize free;
  glfwGetMonitorWorkarea(monitor, nullptr, nullptr, &free.width, &free.height);
  if (free.width <= 0 || free.height <= 0) return usual;
  return {free.width * part / of, free.height * part / of};
}

void set_style() {
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 5;
  style.ChildRounding = style.FrameRounding = style.GrabRounding = 3;
  style.WindowBorderSize = 0;
}

}  // namespace

/// GLFW, its window and what is drawn with, released in reverse order.
struct Window::Impl {
  Impl(const std::string& title, const std::optional<WindowSize>& asked) {
    if (!glfwInit()) {
      throw DeviceError(fmt::format(
          "no window can be opened ({}); set DISPLAY, or use photile render or walk", reason()));
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 0);
    const WindowSize size = asked.value_or(most_of_the_screen());
    handle = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (!handle) {
      const std::string why = reason();
      glfwTerminate();
      throw DeviceError(
          fmt::format("no window with OpenGL 3 can be opened ({}); install a driver, such as "
                      "libgl1-mesa-dri",
                      why));
    }
    glfwMakeContextCurrent(handle);
    glfwSwapInterval(1);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // panels write no file into the working folder
    ImGui::GetIO().ConfigWindowsMoveFromTitleBarOnly = true;
    set_style();
    ImGui_ImplGlfw_InitForOpenGL(handle, true);
    ImGui_ImplOpenGL3_Init("#version 130");
    glGenTextures(1, &texture);
  }
  ~Impl() {
    glDeleteTextures(1, &texture);
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(handle);
    glfwTerminate();
  }

  GLFWwindow* handle = nullptr;
  GLuint texture = 0;
  bool has_picture = false;
};

Window::Window(const std::string& title, const std::optional<WindowSize>& size)
    : impl_(std::make_unique<Impl>(title, size)) {}

Window::~Window() = default;

bool Window::should_close() const { return glfwWindowShouldClose(impl_->handle) != 0; }

void Window::close() { glfwSetWindowShouldClose(impl_->handle, GLFW_TRUE); }

void Window::keep_open() { glfwSetWindowShouldClose(impl_->handle, GLFW_FALSE); }

void Window::begin_frame(double longest_wait) {
  glfwWaitEventsTimeout(longest_wait);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  // Before all that is drawn over it.
  if (impl_->has_picture) {
    const auto [corner, size] = PictureArea::now();
    ImGui::GetBackgroundDrawList()->AddImage(id_of(impl_->texture), corner,
                                             ImVec2(corner.x + size.x, corner.y + size.y));
  }
}

void Window::draw_frame() {
  ImGui::Render();
  glViewport(0, 0, width(), height());
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::show_frame() { glfwSwapBuffers(impl_->handle); }

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(impl_->handle, title.c_str());
}

int Window::width() const {
  int width = 0;
  glfwGetFramebufferSize(impl_->handle, &width, nullptr);
  return width;
}

int Window::height() const {
  int height = 0;
  glfwGetFramebufferSize(impl_->handle, nullptr, &height);
  return height;
}

int Window::picture_width() const {
  return static_cast<int>(PictureArea::now().size.x * ImGui::GetIO().DisplayFramebufferScale.x);
}

int Window::picture_height() const {
  return static_cast<int>(PictureArea::now().size.y * ImGui::GetIO().DisplayFramebufferScale.y);
}

void Window::set_picture(int width, int height, std::span<const std::uint8_t> rgb) {
  glBindTexture(GL_TEXTURE_2D, impl_->texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, clamp_to_edge);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, clamp_to_edge);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
  impl_->has_picture = true;
}

std::vector<std::uint8_t> Window::read_pixels() const {
  const int columns = width(), rows = height();
  const std::size_t stride = 3 * static_cast<std::size_t>(columns);
  std::vector<std::uint8_t> upside_down(stride * static_cast<std::size_t>(rows));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, columns, rows, GL_RGB, GL_UNSIGNED_BYTE, upside_down.data());
  std::vector<std::uint8_t> pixels;
  for (int row = rows - 1; row >= 0; --row) {
    const auto begin = upside_down.begin() + static_cast<std::ptrdiff_t>(stride) * row;
    pixels.insert(pixels.end(), begin, begin + static_cast<std::ptrdiff_t>(stride));
  }
  return pixels;
}

}  // namespace photile::view
