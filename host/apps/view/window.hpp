// The window: GLFW for input, OpenGL for the picture, Dear ImGui for the panels.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace photile::view {

/// In the units of the screen.
struct WindowSize {
  int width = 0, height = 0;
};

/// One window with one picture, which fills what no panel is docked to. Used from the main thread
/// alone.
class Window {
 public:
  ///   size   none = most of the screen
  /// Errors: DeviceError when there is no display or no OpenGL 3.
  Window(const std::string& title, const std::optional<WindowSize>& size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  bool should_close() const;
  void close();
  void keep_open();  ///< although it was asked to close

  /// Waits for input, at most `longest_wait` seconds, and begins a frame of panels over the
  /// picture.
  void begin_frame(double longest_wait);
  /// Draws the picture and what was drawn over it.
  void draw_frame();
  void show_frame();

  void set_title(const std::string& title);

  /// The size of the window, in pixels.
  int width() const;
  int height() const;
  /// The size of the picture beside the panel, in pixels, within a frame.
  int picture_width() const;
  int picture_height() const;

  /// The picture that fills that area from the next frame on: sRGB texels, row 0 at the top;
  /// stretched.
  void set_picture(int width, int height, std::span<const std::uint8_t> rgb);

  /// All that the window is about to show, between draw_frame and show_frame: sRGB texels of
  /// width() x height(), row 0 at the top.
  std::vector<std::uint8_t> read_pixels() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace photile::view
