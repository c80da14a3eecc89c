#include "cli/verbs/mpc_view.hpp"

#include <fmt/format.h>

#include <chrono>
#include <random>
#include <thread>

#include "cli/process/interrupt.hpp"
#include "cli/screen/output.hpp"
#include "cli/verbs/report_page.hpp"
#include "cli/verbs/view_server.hpp"
#include "prowl/error.hpp"
#include "prowl/report_page/online_page.hpp"
#include "prowl/report_page/online_wish.hpp"
#include "prowl/simulation/perturbations.hpp"

namespace prowl::cli {
namespace {

constexpr double kPictureRate = 30.0;  ///< of the page [Hz]

/// Watches a run for its page.
class LiveRun {
 public:
  LiveRun(const RobotModel& robot, const OnlineOptions& options, const PackageSearch& search, std::uint16_t port)
      : robot_(robot),
        options_(options),
        search_(search),
        interrupted_(catch_interrupts()),
        server_(port),
        random_(options.simulation.seed) {}

  void operator()(OnlineMoment& moment) {
    if (moment.time == 0.0) begin(moment.sample());
    std::this_thread::sleep_until(began_ + std::chrono::duration<double>(moment.time));
    if (moment.time >= next_picture_) {
      next_picture_ += 1.0 / kPictureRate;
      server_.publish("moment", online_event(robot_, moment.sample()));
    }
    for (const std::string& wish : server_.take_wishes()) obey(wish, moment);
    moment.stops = interrupted_;
  }

  void end(const OnlineResult& result) {
    show(result, PageState::solved);
    server_.publish("ended", "{}");
    if (!interrupted_) print_message("the page shows the whole run; Ctrl-C stops it\n");
    serve_until(interrupted_);
  }

 private:
  void begin(OnlineSample sample) {
    OnlineResult nothing_yet;
    nothing_yet.samples.push_back(std::move(sample));
    show(nothing_yet, PageState::solving);
    print_message(server_.url() + "\n" + kHowToOpen);
    began_ = std::chrono::steady_clock::now();
  }

  void show(const OnlineResult& result, PageState state) {
    std::vector<std::string> warnings;
    server_.show(online_page({robot_, options_, result, page_without_data("online"), state}, search_, warnings));
    if (state == PageState::solving) print_warnings(warnings);
  }

  void obey(const std::string& text, OnlineMoment& moment) {
    try {
      const OnlineWish wish = parse_wish(text);
      if (wish.command) moment.command = wish.command;
      if (wish.kick) moment.impulse = *wish.kick * robot_.mass() * draw_direction(random_);
    } catch (const InputError& error) {
      print_message(fmt::format("warning: message of the page: {}\n", error.what()));
    }
  }

  const RobotModel& robot_;
  const OnlineOptions& options_;
  const PackageSearch& search_;
  const std::atomic<bool>& interrupted_;
  ViewServer server_;
  std::mt19937_64 random_;
  std::chrono::steady_clock::time_point began_;
  double next_picture_ = 0.0;
};

}  // namespace

OnlineResult view_online(const RobotModel& robot, const OnlineOptions& options, const PackageSearch& search,
                         std::uint16_t port) {
  LiveRun live(robot, options, search, port);
  OnlineResult result = run_online(robot, options, std::ref(live));
  live.end(result);
  return result;
}

}  // namespace prowl::cli
