// Pictures in a running tev (https://github.com/Tom94/tev), by the packets of its src/Ipc.cpp.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>

namespace photile::image {

/// Where tev listens unless told otherwise.
inline constexpr const char* tev_address = "127.0.0.1:14158";

/// A connection to a tev. It never waits longer than two seconds for the other side.
class TevConnection {
 public:
  /// Errors: UsageError where `address` is not HOST:PORT; OutputError where nothing listens there.
  explicit TevConnection(const std::string& address);
  ~TevConnection();
  TevConnection(const TevConnection&) = delete;
  TevConnection& operator=(const TevConnection&) = delete;

  /// Opens a black picture with the channels R, G and B, in place of an earlier one of the name.
  /// Errors: OutputError where tev is gone or does not answer.
  void create(const std::string& picture, int width, int height);

  /// Fills a rectangle of it: linear RGB, width x height, row by row. (0, 0) is at the top left.
  /// Errors: as create.
  void update(const std::string& picture, int x, int y, int width, int height,
              std::span<const glm::vec3> rgb);

 private:
  void send(std::string payload);

  std::string address_;
  int socket_ = -1;
};

}  // namespace photile::image
