#include "tools/preview/tev_connection.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile::image {
namespace {

constexpr int patience_milliseconds = 2000;

enum class Packet : char { create_image = 4, update_image = 6 };  // the latter is tev's version 3

// A packet is its length in bytes (32 bits, itself included), its type and its values, in the byte
// order of the processors that tev runs on; texts end in a zero byte.
static_assert(std::endian::native == std::endian::little);

template <class Value>
void append(std::string& payload, const Value& value) {
  payload.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

void append(std::string& payload, const std::string& text) {
  payload.append(text.c_str(), text.size() + 1);
}

constexpr std::array channels{"R", "G", "B"};

void append_channels(std::string& payload) {
  for (const char* channel : channels) append(payload, std::string(channel));
}

std::string begin_packet(Packet type, const std::string& picture) {
  std::string payload(sizeof(std::uint32_t), '\0');
  append(payload, type);
  append(payload, std::uint8_t{0});  // leaves the focus where it is
  append(payload, picture);
  return payload;
}

/// A connected socket, or -1 with errno.
int connect_to(const addrinfo& address) {
  const int socket = ::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK,
                              address.ai_protocol);
  if (socket < 0) return -1;
  int error = ::connect(socket, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    pollfd wait{socket, POLLOUT, 0};
    socklen_t size = sizeof(error);
    if (::poll(&wait, 1, patience_milliseconds) <= 0) {
      error = ETIMEDOUT;
    } else if (::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) != 0) {
      error = errno;
    }
  }
  if (error != 0) {
    ::close(socket);
    errno = error;
    return -1;
  }
  const timeval patience{patience_milliseconds / 1000, 0};
  ::fcntl(socket, F_SETFL, ::fcntl(socket, F_GETFL) & ~O_NONBLOCK);
  ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof(patience));
  return socket;
}

}  // namespace

TevConnection::TevConnection(const std::string& address) : address_(address) {
  const std::size_t colon = address.rfind(':');
  const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
  if (colon == 0 || parse_number<std::uint16_t>(port).value_or(0) == 0) {
    throw UsageError(
        fmt::format("preview at '{}': is no HOST:PORT, such as {}", address, tev_address));
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int unknown = ::getaddrinfo(address.substr(0, colon).c_str(), port.c_str(), &hints, &found);
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
  std::string reason = unknown != 0 ? ::gai_strerror(unknown) : "no address";
  for (const addrinfo* each = unknown == 0 ? found : nullptr; each && socket_ < 0;
       each = each->ai_next) {
    socket_ = connect_to(*each);
    if (socket_ < 0) reason = std::strerror(errno);
  }
  if (socket_ < 0) {
    throw OutputError(fmt::format("no tev at {} ({}); start it first", address, reason));
  }
}

TevConnection::~TevConnection() { ::close(socket_); }

void TevConnection::create(const std::string& picture, int width, int height) {
  std::string payload = begin_packet(Packet::create_image, picture);
  append(payload, std::int32_t{width});
  append(payload, std::int32_t{height});
  append(payload, static_cast<std::int32_t>(channels.size()));
  append_channels(payload);
  send(std::move(payload));
}

void TevConnection::update(const std::string& picture, int x, int y, int width, int height,
                           std::span<const glm::vec3> rgb) {
  std::string payload = begin_packet(Packet::update_image, picture);
  append(payload, static_cast<std::int32_t>(channels.size()));
  append_channels(payload);
  for (const int value : {x, y, width, height}) append(payload, std::int32_t{value});
  // Where each channel begins, and how far its values are apart, in floats.
  for (std::int64_t channel = 0; channel < 3; ++channel) append(payload, channel);
  for (std::int64_t channel = 0; channel < 3; ++channel) append(payload, std::int64_t{3});
  static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
  payload.append(reinterpret_cast<const char*>(rgb.data()), rgb.size_bytes());
  send(std::move(payload));
}

void TevConnection::send(std::string payload) {
  const auto length = static_cast<std::uint32_t>(payload.size());
  std::memcpy(payload.data(), &length, sizeof(length));
  for (std::size_t sent = 0; sent < payload.size();) {
    const ssize_t count =
        ::send(socket_, payload.data() + sent, payload.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      throw OutputError(fmt::format("tev at {} takes no more of the picture ({})", address_,
                                    std::strerror(errno)));
    }
    sent += static_cast<std::size_t>(count);
  }
}

}  // namespace photile::image
