#pragma once

#include <functional>
#include <memory>

namespace prowl {

/// Threads that share out a range of indices between them. Each has a number of its own, its slot, for work space that must not
/// be shared. What is computed for an index must not depend on the slot: then the results do not depend on the number of
/// threads.
class ThreadTeam {
 public:
  /// count >= 1, the calling thread among them: 1 starts none. Throws std::system_error if there are not so many to be had.
  explicit ThreadTeam(int count);
  ~ThreadTeam();
  ThreadTeam(ThreadTeam&&) noexcept;
  ThreadTeam& operator=(ThreadTeam&&) noexcept;

  int count() const { return count_; }
  /// Slot of the calling thread in for_each(), 0 <= slot < count; 0 outside of it.
  static int slot();

  /// function(i) for i = 0 ... size - 1, a range without gaps for each thread, and waits for all. If calls throw, what that of
  /// the smallest i threw goes on; what comes after it in the same range is not called.
  template <class Function>
  void for_each(int size, const Function& function) {
    if (count_ > 1) return share_out(size, [&function](int i) { function(i); });
    for (int i = 0; i < size; ++i) function(i);
  }

 private:
  void share_out(int size, const std::function<void(int)>& function);

  struct Pool;
  int count_;
  std::unique_ptr<Pool> pool_;
};

}  // namespace prowl
