#include "serve/web_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <array>
#include <random>
#include <string_view>
#include <utility>

#include "common/ascii_text.hpp"
#include "photile/errors.hpp"

namespace photile::serve {
namespace {

/// Of a post, bytes. All that a page posts is small.
constexpr std::size_t most_body = std::size_t{256} << 10;
/// Each page holds one for its news, and a few at a time for what it loads.
constexpr std::size_t connections = 64;
/// Seconds for which a connection may be silent.
constexpr int patience = 2;

/// 128 bits that nobody can guess.
std::string random_token() {
  std::random_device source;  // of the system
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", source());
  return token;
}

bool is_number(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> bytes;
  return inet_pton(AF_INET, host.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, host.c_str(), bytes.data()) == 1;
}

/// A host and the port behind it, if any.
std::pair<std::string, std::string> parts_of(const std::string& text) {
  const bool bracketed = text.starts_with('[');
  const std::size_t end = bracketed ? text.find(']') : text.find(':');
  if (end == std::string::npos) return {text, ""};
  const std::string host = bracketed ? text.substr(1, end - 1) : text.substr(0, end);
  const std::string rest = text.substr(bracketed ? end + 1 : end);
  return {host, rest.starts_with(':') ? rest.substr(1) : rest};
}

/// In a time that does not tell where they differ.
bool are_same(std::string_view a, std::string_view b) {
  unsigned different = a.size() == b.size() ? 0u : 1u;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    different |= static_cast<unsigned>(a[i] ^ b[i]);
  }
  return different == 0;
}

}  // namespace

WebAddress WebAddress::parse(const std::string& text) {
  const auto [host, port] = parts_of(text);
  const auto number = port.empty() ? 0 : parse_number<int>(port).value_or(-1);
  if (!is_number(host) || number < 0 || number > 65535) {
    throw UsageError(fmt::format(
        "--listen: '{}' is not an address such as 127.0.0.1, 0.0.0.0:8080 or [::1]:8080", text));
  }
  return {host, number};
}

WebServer::WebServer(const WebAddress& address, Answer answer, Listen listen)
    : answer_(std::move(answer)),
      listen_(std::move(listen)),
      token_(random_token()),
      server_(std::make_unique<httplib::Server>()) {
  httplib::Server& server = *server_;
  server.new_task_queue = [] { return new httplib::ThreadPool(connections); };
  // A connection for each request: nothing that a refused one holds is read as another.
  server.set_keep_alive_max_count(1);
  server.set_keep_alive_timeout(1);
  server.set_read_timeout(patience);
  server.set_write_timeout(10);
  server.set_payload_max_length(most_body);
  server.set_default_headers({{"Cache-Control", "no-store"},
                              {"Cross-Origin-Opener-Policy", "same-origin"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Referrer-Policy", "no-referrer"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"X-Frame-Options", "DENY"}});
  server.set_pre_routing_handler([this](const auto& request, auto& response) {
    response.status = refusal(request);
    if (response.status != 0) return httplib::Server::HandlerResponse::Handled;
    response.status = -1;  // not answered yet
    return httplib::Server::HandlerResponse::Unhandled;
  });
  const auto answered = [this](const httplib::Request& request, httplib::Response& response) {
    const std::string what = request.path.substr(token_.size() + 2);
    const WebRequest asked{request.method == "POST", what, request.get_param_value("viewer"),
                           request.get_param_value("since"), request.body};
    if (!asked.posts && what == "events") {
      response.set_chunked_content_provider(
          "text/event-stream", [this, news = std::shared_ptr<NewsSource>(listen_(asked))](
                                   std::size_t, httplib::DataSink& sink) {
            const std::string message = news->next();
            if (ends_) return false;
            const std::string text = message.empty() ? ":\n\n" : "data: " + message + "\n\n";
            return sink.write(text.data(), text.size());
          });
      return;
    }
    try {
      if (std::optional<WebReply> reply = answer_(asked); reply && reply->type.empty()) {
        response.status = 204;
      } else if (reply) {
        // A body that is given whole would be packed, for seconds, though it goes to this machine.
        const auto body = std::make_shared<const std::string>(std::move(reply->body));
        response.set_content_provider(body->size(), reply->type,
                                      [body](std::size_t at, std::size_t length, auto& sink) {
                                        return sink.write(body->data() + at, length);
                                      });
      } else {
        response.status = 404;
      }
    } catch (const Error& error) {
      response.status = 400;
      response.set_content(error.what(), "text/plain; charset=utf-8");
    }
  };
  server.set_exception_handler([](const auto&, httplib::Response& response,
                                  const std::exception_ptr&) { response.status = 500; });
  server.Get("/.*", answered);
  server.Post("/.*", answered);
  int port = address.port;
  if (port == 0)
    port = server.bind_to_any_port(address.host);
  else if (!server.bind_to_port(address.host, port))
    port = -1;
  if (port < 0) {
    throw UsageError(fmt::format("--listen: {}:{} is in use or not on this machine; give another",
                                 address.host, address.port));
  }
  const bool bracketed = address.host.find(':') != std::string::npos;
  url_ = fmt::format(fmt::runtime(bracketed ? "http://[{}]:{}/{}/" : "http://{}:{}/{}/"),
                     address.host, port, token_);
  thread_ = std::jthread([&server] { server.listen_after_bind(); });
}

WebServer::~WebServer() {
  ends_ = true;
  server_->stop();
}

int WebServer::refusal(const httplib::Request& request) const {
  const std::string host = request.get_header_value("Host");
  const std::string name = parts_of(host).first;
  if (!is_number(name) && name != "localhost") return 403;
  const bool posts = request.method == "POST";
  if (!posts && request.method != "GET") return 405;
  const std::string origin = request.get_header_value("Origin");
  if ((posts || !origin.empty()) && origin != "http://" + host) return 403;
  const std::string_view path = request.path;
  const bool knows = path.size() >= token_.size() + 2 && path.front() == '/' &&
                     path[token_.size() + 1] == '/' &&
                     are_same(path.substr(1, token_.size()), token_);
  if (!knows) return 404;
  // Such bodies have no length that could be refused.
  if (request.has_header("Transfer-Encoding") || request.has_header("Content-Encoding")) return 411;
  if (posts && request.get_header_value("Content-Type") != "application/json") return 415;
  return 0;
}

}  // namespace photile::serve
