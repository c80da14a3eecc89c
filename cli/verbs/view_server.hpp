#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace prowl::cli {

/// An HTTP server for one page and a stream of events, which only programs of this machine reach: it listens on
/// 127.0.0.1 and answers requests for that address alone, so that no other site's name can be made to lead to it. Runs
/// in a thread of its own.
class ViewServer {
 public:
  /// Port 0 takes any that is free. Throws InputError if the port cannot be had.
  explicit ViewServer(std::uint16_t port);
  ~ViewServer();  ///< ends all connections

  std::string url() const;
  /// What GET / answers from now on.
  void show(std::string html);
  /// An event of GET /events (server-sent events) for all that listen, and for all that come later. `json` is one line.
  /// Of very many, the oldest are forgotten.
  void publish(const std::string& name, const std::string& json);

 private:
  class Connections;
  std::unique_ptr<Connections> connections_;
};

}  // namespace prowl::cli
