// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include <httplib.h>  // and the system's sockets

#include <meshfarm/transport/page_listener.hpp>

namespace meshfarm {
namespace {

constexpr const char* k_host = "127.0.0.1";
constexpr std::size_t k_threads = 8;        // a browser keeps some connections that it does not use
constexpr std::size_t k_most_bytes = 4096;  // of a request's body: none is expected

/// Names of this host, with any port: a tunnel uses another one.
bool names_this_host(const std::string& host) {
  const std::string name =
      host.substr(0, host.rfind(':') == std::string::npos || host.back() == ']' ? host.size()
                                                                                : host.rfind(':'));
  return name == k_host || name == "localhost" || name == "[::1]";
}

class HttpListener : public PageListener {
 public:
  HttpListener(std::uint16_t port, PageAnswer answer) : answer_(std::move(answer)) {
    set_up();
    const int bound = port == 0 ? server_.bind_to_any_port(k_host)
                                : (server_.bind_to_port(k_host, port) ? port : -1);
    if (bound <= 0) {
      throw std::system_error(errno != 0 ? errno : EADDRINUSE, std::generic_category());
    }
    port_ = static_cast<std::uint16_t>(bound);
    thread_ = std::thread([this] {
      server_.listen_after_bind();
      ended_ = true;
    });
  }
  ~HttpListener() override {
    // A server that is not running yet would miss the stop.
    while (!server_.is_running() && !ended_) std::this_thread::yield();
    server_.stop();
    thread_.join();
  }
  HttpListener(const HttpListener&) = delete;
  HttpListener& operator=(const HttpListener&) = delete;

  std::uint16_t port() const override { return port_; }

 private:
  void set_up() {
    // By default the library lets two servers share a port, and each would get some of the
    // requests.
    server_.set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server_.new_task_queue = [] { return new httplib::ThreadPool(k_threads); };
    // The library polls each kept-alive connection a hundred times per second.
    server_.set_keep_alive_max_count(1);
    server_.set_read_timeout(std::chrono::seconds(2));
    server_.set_write_timeout(std::chrono::seconds(2));
    server_.set_idle_interval(std::chrono::milliseconds(250));
    server_.set_payload_max_length(k_most_bytes);
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"Content-Security-Policy",
                                  "default-src 'none'; style-src 'unsafe-inline'; script-src "
                                  "'unsafe-inline'; connect-src 'self'; img-src data:; base-uri "
                                  "'none'; form-action 'none'; frame-ancestors 'none'"}});
    server_.Get(".*", [this](const httplib::Request& request, httplib::Response& response) {
      answer(request, response);
    });
  }

  void answer(const httplib::Request& request, httplib::Response& response) const {
    if (!names_this_host(request.get_header_value("Host"))) {
      response.status = 403;
      return response.set_content("ask for localhost\n", "text/plain");
    }
    const std::optional<ServedPage> page = answer_(request.path);
    if (!page) {
      response.status = 404;
      return response.set_content("no such page\n", "text/plain");
    }
    response.set_content(page->body, page->type);
  }

  PageAnswer answer_;
  httplib::Server server_;
  std::uint16_t port_ = 0;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace
}  // namespace meshfarm

extern "C" meshfarm::PageListener* meshfarm_listen(std::uint16_t port,
                                                   meshfarm::PageAnswer answer) {
  return new meshfarm::HttpListener(port, std::move(answer));
}
