#pragma once

#include <functional>
#include <memory>

namespace prowl {

/// Threads that share out a range of indices between them. Each has a number of its own, its slot, for work space that
/// must not be shared. What is computed for an index must not depend on the slot: then the results do not depend on the
/// number of threads.
class ThreadTeam {
 public:
  /// count >= 1, the calling thread among them: 1 starts none. Throws std::system_error if there are not so many to be
  /// had.
  explicit ThreadTeam(int count);
  ~ThreadTeam();
  ThreadTeam(ThreadTeam&&) noexcept;
  ThreadTeam& operator=(ThreadTeam&&) noexcept;

  int count() const { return count_; }
  /// Slot of the calling thread in the innermost for_each() that it is in, 0 <= slot < count; 0 outside of any.
  static int slot() { return this_slot_; }

  /// function(i) for i = 0 ... size - 1, a range without gaps for each thread, and waits for all. If calls throw, what
  /// that of the smallest i threw goes on; what comes after it in the same range is not called.
  template <class Function>
  void for_each(int size, const Function& function) {
    if (count_ > 1) return share_out(size, [&function](int i) { function(i); });
    const InSlot in_slot(0);
    for (int i = 0; i < size; ++i) function(i);
  }

 private:
  /// The calling thread has this slot for as long as it exists.
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
