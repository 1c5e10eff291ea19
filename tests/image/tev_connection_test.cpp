// What a tev is sent, decoded as tev does.
#include "tools/preview/tev_connection.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <future>

#include "photile/errors.hpp"
#include "tools/preview/live_preview.hpp"

namespace photile::test {

using namespace photile::image;
using Catch::Contains;

namespace {

/// Listens on a free port and keeps all that one connection sends.
class Listener {
 public:
  Listener() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    if (::bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::listen(socket_, 1) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::runtime_error("no port");
    }
    port_ = ntohs(address.sin_port);
  }
  ~Listener() { ::close(socket_); }

  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

  /// Accepts a connection and reads it to its end.
  std::future<std::string> received() {
    return std::async(std::launch::async, [this] {
      const int connection = ::accept(socket_, nullptr, nullptr);
      std::string bytes;
      char buffer[4096];
      for (ssize_t count; (count = ::read(connection, buffer, sizeof(buffer))) > 0;) {
        bytes.append(buffer, static_cast<std::size_t>(count));
      }
      ::close(connection);
      return bytes;
    });
  }

 private:
  int socket_;
  int port_ = 0;
};

/// Reads the values of a packet in order.
struct Reader {
  std::string bytes;
  std::size_t at = 0;

  template <class Value>
  Value next() {
    Value value;
    REQUIRE(at + sizeof(value) <= bytes.size());
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    at += sizeof(value);
    return value;
  }
  std::string text() {
    const std::string value = bytes.c_str() + at;
    at += value.size() + 1;
    return value;
  }
};

struct Notes : Progress {
  void note(const std::string& line) override { lines.push_back(line); }
  std::vector<std::string> lines;
};

LightMix one_light(double power) {
  LightMix mix;
  mix.lights.resize(1);
  mix.lights[0].name = "lamp";
  mix.lights[0].power = power;
  return mix;
}

}  // namespace

TEST_CASE("a picture is created and its rows are sent as tev reads them") {
  Listener listener;
  auto received = listener.received();
  Notes notes;
  LightLayers layers(2, 3, std::vector<std::string>{"lamp"});
  for (std::size_t i = 0; i < 6; ++i) {
    const auto value = static_cast<float>(i);
    layers.layers[0].radiance[i] = {value, 10 * value, 100 * value};
  }
  {
    LivePreview preview(listener.address(), "room.gltf", one_light(4), notes);
    preview.rows(layers, 1, 3, 0.5);  // half of the passes: twice as bright as so far
  }
  Reader reader{received.get()};
  CHECK(notes.lines.empty());

  const auto create = reader.next<std::uint32_t>();
  CHECK(reader.next<char>() == 4);
  CHECK(reader.next<char>() == 0);
  CHECK(reader.text() == "room.gltf");
  CHECK(reader.next<std::int32_t>() == 2);
  CHECK(reader.next<std::int32_t>() == 3);
  CHECK(reader.next<std::int32_t>() == 3);
  for (const char* channel : {"R", "G", "B"}) CHECK(reader.text() == channel);
  CHECK(reader.at == create);

  const auto update = reader.next<std::uint32_t>();
  CHECK(reader.next<char>() == 6);
  CHECK(reader.next<char>() == 0);
  CHECK(reader.text() == "room.gltf");
  CHECK(reader.next<std::int32_t>() == 3);
  for (const char* channel : {"R", "G", "B"}) CHECK(reader.text() == channel);
  for (const int value : {0, 1, 2, 2}) CHECK(reader.next<std::int32_t>() == value);
  std::int64_t offset[3], stride[3];
  for (auto& each : offset) each = reader.next<std::int64_t>();
  for (auto& each : stride) each = reader.next<std::int64_t>();
  const std::size_t data = reader.at;
  for (std::size_t pixel = 0; pixel < 4; ++pixel) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      reader.at = data + sizeof(float) * static_cast<std::size_t>(offset[channel] +
                                                                  static_cast<std::int64_t>(pixel) *
                                                                      stride[channel]);
      const double scale[3] = {1, 10, 100};
      CHECK(static_cast<double>(reader.next<float>()) ==
            Approx(8 * static_cast<double>(pixel + 2) * scale[channel]));
    }
  }
  CHECK(reader.at == reader.bytes.size());
  CHECK(create + update == reader.bytes.size());
}

TEST_CASE("without a tev there is one warning and no error") {
  std::string address;
  {
    Listener listener;  // a port that was free
    address = listener.address();
  }
  Notes notes;
  LivePreview preview(address, "room", one_light(1), notes);
  preview.rows(LightLayers(2, 2, std::vector<std::string>{"lamp"}), 0, 2, 1);
  REQUIRE(notes.lines.size() == 1);
  CHECK_THAT(notes.lines[0], Contains("no tev at " + address) && Contains("warning"));
}

TEST_CASE("a tev that stops reading ends the preview, not the work") {
  Listener listener;  // never accepts: the kernel's buffers fill up
  Notes notes;
  LivePreview preview(listener.address(), "room", one_light(1), notes);
  const LightLayers large(2000, 1000, std::vector<std::string>{"lamp"});
  for (int i = 0; i < 3; ++i) preview.rows(large, 0, 1000, 1);
  REQUIRE(notes.lines.size() == 1);
  CHECK_THAT(notes.lines[0], Contains("no more of the picture"));
}

TEST_CASE("a malformed address of a tev is refused") {
  const std::string address = GENERATE("", "host", ":1", "host:", "host:port", "room.gltf");
  CHECK_THROWS_AS(TevConnection(address), UsageError);
}

}  // namespace photile::test
