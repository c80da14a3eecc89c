// A job file, for a small task: its draws, and the text of the first motion.
#include "input.hpp"
#include "prowl/batch/job_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  const SourceText task{"task.toml",
                        "name = \"x\"\n[[surface]]\nfriction = 0.5\n[[goal]]\ntime_s = 1.0\n"
                        "base_displacement_m = [0, 0, -0.1]\n"};
  fuzz::takes_or_refuses([&] {
    const Job job = job_with_task({"job.toml", fuzz::text_of(data, size)}, task);
    drawn_values(job, job.count - 1);
    drawn_task_text(job, 0);
  });
  return 0;
}
