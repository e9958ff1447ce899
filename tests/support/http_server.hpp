// A web server on this machine's loopback, for tests of downloads: answers each request by what the
// test's function says, also wrongly: too little, nothing, another part than was asked for.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace corridor::testing {

struct HttpRequest {
  std::string path;                        // "/file"
  std::optional<std::size_t> range_begin;  // of "Range: bytes=N-"
  std::size_t number = 0;                  // requests before this one
};

struct HttpReply {
  std::string status = "200 OK";
  std::string headers;  // whole lines, "Name: value\r\n"
  std::string body;
  std::optional<std::size_t> num_bytes_sent;  // of the body, then the connection is cut
};

class HttpServer {
 public:
  using Handler = std::function<HttpReply(const HttpRequest&)>;

  explicit HttpServer(Handler handler) : handler_(std::move(handler)) {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    if (socket_ < 0 || ::bind(socket_, generic, size) != 0 || ::listen(socket_, 8) != 0 ||
        ::getsockname(socket_, generic, &size) != 0) {
      throw std::runtime_error("no server on loopback");
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  ~HttpServer() {
    ::shutdown(socket_, SHUT_RDWR);  // ends accept()
    thread_.join();
    ::close(socket_);
  }
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  [[nodiscard]] std::string url(const std::string& path) const {
    return "http://127.0.0.1:" + std::to_string(port_) + path;
  }
  [[nodiscard]] std::vector<HttpRequest> requests() const {
    const std::lock_guard lock(mutex_);
    return requests_;
  }

  // The whole of `content`, or the part that was asked for.
  static HttpReply serve_content(const HttpRequest& request, const std::string& content) {
    if (!request.range_begin) return {"200 OK", "", content, {}};
    const std::size_t begin = *request.range_begin;
    const std::string size = std::to_string(content.size());
    if (begin >= content.size()) {
      return {"416 Range Not Satisfiable", "Content-Range: bytes */" + size + "\r\n", "", {}};
    }
    return {"206 Partial Content",
            "Content-Range: bytes " + std::to_string(begin) + "-" +
                std::to_string(content.size() - 1) + "/" + size + "\r\n",
            content.substr(begin),
            {}};
  }

 private:
  void serve() {
    while (true) {
      const int connection = ::accept(socket_, nullptr, nullptr);
      if (connection < 0) return;
      answer(connection);
      ::close(connection);
    }
  }

  void answer(int connection) {
    std::string text;
    char buffer[4096];
    while (text.find("\r\n\r\n") == std::string::npos) {
      const ssize_t received = ::recv(connection, buffer, sizeof buffer, 0);
      if (received <= 0) return;
      text.append(buffer, static_cast<std::size_t>(received));
    }
    HttpRequest request;
    const std::size_t begin = text.find(' ') + 1;
    request.path = text.substr(begin, text.find(' ', begin) - begin);
    const std::string range = "Range: bytes=";
    if (const auto at = text.find(range); at != std::string::npos) {
      request.range_begin = std::stoul(text.substr(at + range.size()));
    }
    {
      const std::lock_guard lock(mutex_);
      request.number = requests_.size();
      requests_.push_back(request);
    }
    const HttpReply reply = handler_(request);
    send_all(connection,
             "HTTP/1.1 " + reply.status + "\r\nContent-Length: " +
                 std::to_string(reply.body.size()) + "\r\nConnection: close\r\n" + reply.headers +
                 "\r\n" + reply.body.substr(0, reply.num_bytes_sent.value_or(std::string::npos)));
  }

  static void send_all(int connection, const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count =
          ::send(connection, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return;
      sent += static_cast<std::size_t>(count);
    }
  }

  Handler handler_;
  int socket_ = -1;
  std::uint16_t port_ = 0;
  mutable std::mutex mutex_;
  std::vector<HttpRequest> requests_;
  std::thread thread_;
};

}  // namespace corridor::testing
