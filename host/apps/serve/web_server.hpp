// A small web server for one page: what it lets in, and how it hands out news.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace httplib {
class Server;
struct Request;
}  // namespace httplib

namespace photile::serve {

struct WebAddress {
  std::string host = "127.0.0.1";  ///< a number: IPv4 or IPv6
  int port = 0;                    ///< 0 = any that is free

  /// "127.0.0.1", "127.0.0.1:8080", "[::1]:8080". Errors: UsageError.
  static WebAddress parse(const std::string& text);
};

/// A request that was let in.
struct WebRequest {
  bool posts = false;
  std::string what;    ///< what follows the token in the address; "" = the page
  std::string viewer;  ///< that the page calls itself
  std::string since;   ///< number of the newest state that it knows; of news: of the page
  std::string body;    ///< of a post: JSON
};

struct WebReply {
  std::string type, body;  ///< no type: there is nothing to say
};

/// News for one page, as long as it is open.
class NewsSource {
 public:
  virtual ~NewsSource() = default;
  /// The next message, JSON; "" where there is none within half a second.
  virtual std::string next() = 0;
};

/// Answers requests on threads of its own. Whoever does not know the token, which is part of the
/// address, gets nothing. Nor does a page of another site, even by a name that it lets point here:
/// hosts are numbers or localhost, and posts come from the own address. Bodies are bounded, and who
/// sends half a request is dropped. No request names a file.
class WebServer {
 public:
  using Answer = std::function<std::optional<WebReply>(const WebRequest&)>;
  using Listen = std::function<std::unique_ptr<NewsSource>(const WebRequest&)>;

  ///   answer   none: there is no such thing. An Error that it throws is told to the page
  ///   listen   called when a page asks for news
  /// Errors: UsageError where the address is not free.
  WebServer(const WebAddress& address, Answer answer, Listen listen);
  /// Ends all connections.
  ~WebServer();

  /// "http://127.0.0.1:8080/TOKEN/"
  const std::string& url() const { return url_; }

 private:
  /// 0 where a request is let in, else the status of the refusal.
  int refusal(const httplib::Request& request) const;

  const Answer answer_;
  const Listen listen_;
  const std::string token_;
  std::unique_ptr<httplib::Server> server_;
  std::string url_;
  std::atomic<bool> ends_{false};
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace photile::serve
