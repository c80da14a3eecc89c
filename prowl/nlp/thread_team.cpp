#include "prowl/nlp/thread_team.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <exception>
#include <latch>
#include <vector>

namespace prowl {

thread_local int ThreadTeam::this_slot_ = 0;

struct ThreadTeam::Pool {
  explicit Pool(int count) : threads(static_cast<std::size_t>(count)) {}
  boost::asio::thread_pool threads;
};

ThreadTeam::ThreadTeam(int count) : count_(count), pool_(count > 1 ? std::make_unique<Pool>(count - 1) : nullptr) {}

ThreadTeam::~ThreadTeam() = default;
ThreadTeam::ThreadTeam(ThreadTeam&&) noexcept = default;
ThreadTeam& ThreadTeam::operator=(ThreadTeam&&) noexcept = default;

void ThreadTeam::share_out(int size, const std::function<void(int)>& function) {
  std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(count_));
  const auto run = [&](int slot) {
    const InSlot in_slot(slot);
    try {
      const auto first = [&](int of) { return static_cast<int>(static_cast<long>(size) * of / count_); };
      for (int i = first(slot); i < first(slot + 1); ++i) function(i);
    } catch (...) {
      thrown[slot] = std::current_exception();
    }
  };
  std::latch others_done(count_ - 1);
  for (int slot = 1; slot < count_; ++slot) {
    boost::asio::post(pool_->threads, [&, slot] {
      run(slot);
      others_done.count_down();
    });
  }
  run(0);
  others_done.wait();
  for (const std::exception_ptr& one : thrown) {
    if (one) std::rethrow_exception(one);
  }
}

}  // namespace prowl
