#pragma once

#include <atomic>
#include <functional>

namespace prowl {

/// Calls work(0) to work(count - 1), each once, in this order of their starts, on up to `threads` threads; 0: one per
/// core. After `interrupt` (may be null) becomes true none starts. Rethrows what the work throws.
void in_parallel(int count, int threads, const std::function<void(int)>& work, const std::atomic<bool>* interrupt);

}  // namespace prowl
