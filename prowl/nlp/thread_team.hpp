#pragma once

#include <functional>
#include <memory>

namespace prowl {

/// Threads that divide a range of indices. Each has a number, its slot, for work space of its own. Results for an index
/// must not depend on the slot; then they do not depend on the number of threads.
class ThreadTeam {
 public:
  /// count >= 1, including the calling thread: 1 starts none. Throws std::system_error if threads cannot be started.
  explicit ThreadTeam(int count);
  ~ThreadTeam();
  ThreadTeam(ThreadTeam&&) noexcept;
  ThreadTeam& operator=(ThreadTeam&&) noexcept;

  int count() const { return count_; }
  /// Slot of the calling thread in the innermost for_each() that it is in, 0 <= slot < count; 0 outside of any.
  static int slot() { return this_slot_; }

  /// Calls function(i) for i = 0 ... size - 1, a contiguous range per thread, and waits for all. A range ends at its
  /// first exception; the one of the smallest i is rethrown.
  template <class Function>
  void for_each(int size, const Function& function) {
    if (count_ > 1) return share_out(size, [&function](int i) { function(i); });
    const InSlot in_slot(0);
    for (int i = 0; i < size; ++i) function(i);
  }

 private:
  /// Gives the calling thread this slot during its lifetime.
  class InSlot {
   public:
    explicit InSlot(int slot) : outer_(this_slot_) { this_slot_ = slot; }
    ~InSlot() { this_slot_ = outer_; }
    InSlot(const InSlot&) = delete;
    InSlot& operator=(const InSlot&) = delete;

   private:
    int outer_;
  };

  void share_out(int size, const std::function<void(int)>& function);

  static thread_local int this_slot_;
  struct Pool;
  int count_;
  std::unique_ptr<Pool> pool_;
};

}  // namespace prowl
