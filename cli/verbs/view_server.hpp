#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace prowl::cli {

/// What a user does with the address of a server.
constexpr const char* kHowToOpen = "open it in a browser on this machine; Ctrl-C stops it\n";

/// Waits while servers answer in their own threads.
void serve_until(const std::atomic<bool>& interrupted);

/// An HTTP server for one page and a stream of events, reachable only from this machine: it listens
/// on 127.0.0.1 and answers only requests with that host, which prevents DNS rebinding. Runs in its
/// own thread.
class ViewServer {
 public:
  /// Port 0: any free port. Throws InputError if the port is unavailable.
  explicit ViewServer(std::uint16_t port);
  ~ViewServer();  ///< closes all connections

  std::string url() const;
  /// Sets the page of GET /.
  void show(std::string html);
  /// Sends an event of GET /events (server-sent events) to all current and later listeners; `json`:
  /// one line. The oldest of very many events are dropped.
  void publish(const std::string& name, const std::string& json);
  /// Bodies of POST /wishes (JSON, at most 4 KiB, from the page itself) since the last call, in order.
  std::vector<std::string> take_wishes();

 private:
  class Connections;
  std::unique_ptr<Connections> connections_;
};

}  // namespace prowl::cli
