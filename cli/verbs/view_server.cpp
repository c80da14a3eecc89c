#include "cli/verbs/view_server.hpp"

#include <fmt/format.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "prowl/error.hpp"

namespace prowl::cli {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;
using Text = std::shared_ptr<const std::string>;
using Request = http::request<http::string_body>;

constexpr std::size_t kLongestWish = 4096;  ///< [bytes]

/// State of the server's thread; other threads only post to `context_`.
class ViewServer::Connections {
 public:
  explicit Connections(std::uint16_t port)
      : acceptor_(context_), news_(context_, asio::steady_timer::time_point::max()) {
    const tcp::endpoint loopback(asio::ip::address_v4::loopback(), port);
    boost::system::error_code error;
    acceptor_.open(loopback.protocol(), error);
    acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    acceptor_.bind(loopback, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error)
      throw InputError(fmt::format("--port {}: {}; use another, or 0 for any free port", port, error.message()));
    address_ = fmt::format("127.0.0.1:{}", acceptor_.local_endpoint().port());
    other_name_ = fmt::format("localhost:{}", acceptor_.local_endpoint().port());
    asio::co_spawn(context_, accept(), asio::detached);
    thread_ = std::thread([this] { context_.run(); });
  }
  ~Connections() {
    context_.stop();
    thread_.join();
  }

  const std::string& address() const { return address_; }
  void show(std::string html) {
    asio::post(context_, [this, page = std::make_shared<const std::string>(std::move(html))] { page_ = page; });
  }
  void publish(std::string event) {
    asio::post(context_, [this, text = std::make_shared<const std::string>(std::move(event))] {
      constexpr std::size_t kMostKept = 256u << 20;  // [bytes]: several thousand iterates of a quadruped
      kept_ += text->size();
      events_.push_back(text);
      for (; kept_ > kMostKept && events_.size() > 1; ++forgotten_) {
        kept_ -= events_.front()->size();
        events_.pop_front();
      }
      news_.cancel();  // wakes all waiting connections
    });
  }
  std::vector<std::string> take_wishes() {
    const std::lock_guard lock(wishes_lock_);
    return std::exchange(wishes_, {});
  }

 private:
  asio::awaitable<void> accept() {
    for (;;) {
      boost::system::error_code error;
      tcp::socket socket = co_await acceptor_.async_accept(asio::redirect_error(asio::use_awaitable, error));
      if (error) {  // e.g. too many open files: retry later
        asio::steady_timer pause(context_, std::chrono::milliseconds(100));
        co_await pause.async_wait(asio::use_awaitable);
        continue;
      }
      asio::co_spawn(context_, serve(beast::tcp_stream(std::move(socket))), [](const std::exception_ptr&) {
        // Ignore closed connections and invalid HTTP.
      });
    }
  }

  asio::awaitable<void> serve(beast::tcp_stream stream) {
    constexpr std::chrono::seconds kPatience(30);
    beast::flat_buffer buffer;
    http::request_parser<http::string_body> parser;
    parser.body_limit(kLongestWish);
    stream.expires_after(kPatience);
    co_await http::async_read(stream, buffer, parser, asio::use_awaitable);
    const Request& request = parser.get();
    if (request[http::field::host] != address_ && request[http::field::host] != other_name_) {
      co_await answer(stream, request, http::status::forbidden, "text/plain", "wrong host name\n");
    } else if (request.method() == http::verb::post && request.target() == "/wishes") {
      const http::status status = keep(request);
      co_await answer(stream, request, status, "text/plain", status == http::status::ok ? "" : "JSON only\n");
    } else if (request.method() != http::verb::get) {
      co_await answer(stream, request, http::status::method_not_allowed, "text/plain", "GET only\n");
    } else if (request.target() == "/events") {
      co_await send_events(stream);
    } else if (request.target() == "/") {
      const Text page = page_;
      co_await answer(stream, request, http::status::ok, "text/html; charset=utf-8", *page);
    } else {
      co_await answer(stream, request, http::status::not_found, "text/plain", "only / and /events exist\n");
    }
    boost::system::error_code ignored;
    stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  /// Pages of other sites cannot send this type without asking, which is refused.
  http::status keep(const Request& request) {
    if (request[http::field::content_type] != "application/json") return http::status::unsupported_media_type;
    constexpr std::size_t kMostWaiting = 1000;
    const std::lock_guard lock(wishes_lock_);
    if (wishes_.size() < kMostWaiting) wishes_.push_back(request.body());
    return http::status::ok;
  }

  static asio::awaitable<void> answer(beast::tcp_stream& stream, const Request& request, http::status status,
                                      const char* type, const std::string& text) {
    http::response<http::string_body> response(status, request.version(), text);
    response.set(http::field::content_type, type);
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.keep_alive(false);
    response.prepare_payload();
    co_await http::async_write(stream, response, asio::use_awaitable);
  }

  asio::awaitable<void> send_events(beast::tcp_stream& stream) {
    http::response<http::empty_body> response(http::status::ok, 11);
    response.set(http::field::content_type, "text/event-stream");
    response.set(http::field::cache_control, "no-store");
    response.keep_alive(false);
    http::response_serializer<http::empty_body> header(response);
    co_await http::async_write_header(stream, header, asio::use_awaitable);
    stream.expires_never();
    for (std::size_t next = 0;; ++next) {
      next = std::max(next, forgotten_);
      while (next == forgotten_ + events_.size()) {
        boost::system::error_code woken;
        co_await news_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
        next = std::max(next, forgotten_);
      }
      const Text event = events_[next - forgotten_];
      co_await asio::async_write(stream, asio::buffer(*event), asio::use_awaitable);
    }
  }

  asio::io_context context_{1};
  tcp::acceptor acceptor_;
  asio::steady_timer news_;  ///< never expires
  std::string address_, other_name_;
  Text page_ = std::make_shared<const std::string>();
  std::deque<Text> events_;
  std::size_t forgotten_ = 0, kept_ = 0;  ///< number of events, [bytes]
  std::mutex wishes_lock_;
  std::vector<std::string> wishes_;
  std::thread thread_;
};

void serve_until(const std::atomic<bool>& interrupted) {
  while (!interrupted) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

ViewServer::ViewServer(std::uint16_t port) : connections_(std::make_unique<Connections>(port)) {}
ViewServer::~ViewServer() = default;

std::string ViewServer::url() const { return "http://" + connections_->address() + "/"; }
std::vector<std::string> ViewServer::take_wishes() { return connections_->take_wishes(); }
void ViewServer::show(std::string html) { connections_->show(std::move(html)); }
void ViewServer::publish(const std::string& name, const std::string& json) {
  connections_->publish(fmt::format("event: {}\ndata: {}\n\n", name, json));
}

}  // namespace prowl::cli
