#include "prowl/simulation/in_parallel.hpp"

#include <algorithm>
#include <future>
#include <thread>
#include <vector>

namespace prowl {

void in_parallel(int count, int threads, const std::function<void(int)>& work, const std::atomic<bool>* interrupt) {
  std::atomic<int> next = 0;
  const auto work_on = [&] {
    while (!(interrupt && *interrupt)) {  // checked before taking the next: those that started have no gaps
      const int i = next++;
      if (i >= count) return;
      work(i);
    }
  };
  if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::vector<std::future<void>> workers;
  for (int i = 0; i < threads; ++i) workers.push_back(std::async(std::launch::async, work_on));
  for (std::future<void>& worker : workers) worker.get();
}

}  // namespace prowl
