#include "prowl/batch/job.hpp"

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <string>

#include "bindings.hpp"
#include "module_files.hpp"
#include "prowl/batch/job_file.hpp"
#include "prowl/error.hpp"

namespace prowl::python {
namespace {

namespace nb = nanobind;
namespace fs = std::filesystem;

void check_index(const Job& job, int index) {
  if (index >= 0 && index < job.count) return;
  throw InputError(fmt::format("index: {} is not allowed; need 0 to {}", index, job.count - 1));
}

std::vector<std::string> draw_names(const Job& job) {
  std::vector<std::string> names;
  for (const Draw& draw : job.draws) names.push_back(draw.name());
  return names;
}

}  // namespace

void bind_job(nb::module_& module) {
  nb::class_<Job>(module, "Job",
                  "A library of motions to plan: a task of which some keys are drawn at random (docs/batch.md).")
      .def_ro("count", &Job::count, "Motions.")
      .def_ro("seed", &Job::seed)
      .def_prop_ro(
          "grade", [](const Job& job) { return to_string(job.grade); }, "Grade that a motion needs.")
      .def_ro("rate", &Job::rate, "Samples of a motion per second [Hz].")
      .def_ro("gains", &Job::gains, "Whether gains are kept.")
      .def_ro("simulation", &Job::simulation, "Whether each motion is simulated.")
      .def_ro("shard", &Job::shard, "Motions in one file.")
      .def_ro("hang_seconds", &Job::hang_seconds, "After which a motion counts as unfinished [s].")
      .def_prop_ro("draw_names", &draw_names, "First key of each draw.")
      .def_prop_ro(
          "path", [](const Job& job) { return job.file.path; }, "Path of the job file.")
      .def_prop_ro(
          "text", [](const Job& job) { return job.file.text; }, "Text of the job file.")
      .def_prop_ro(
          "task_path", [](const Job& job) { return job.task_file.path; }, "Path of its task file.")
      .def_prop_ro(
          "base_task", [](const Job& job) { return job.task_file.text; }, "Text of its task file.")
      .def(
          "values",
          [](const Job& job, int index) {
            check_index(job, index);
            return drawn_values(job, index);
          },
          nb::arg("index"), "Drawn values of a motion, in the order of draw_names.")
      .def(
          "task_text",
          [](const Job& job, int index) {
            check_index(job, index);
            return drawn_task_text(job, index);
          },
          nb::arg("index"), "Text of the task file of a motion.")
      .def(
          "check",
          [](const Job& job, const std::vector<std::string>& package_dirs) {
            const PackageSearch search = package_search(package_dirs);
            std::vector<std::string> texts;
            check_draws(job, [&](const SourceText& task_file) {
              const Task task = read_task_text(task_file, search);
              texts.push_back(task.robot_file.text);
              texts.push_back(task.problem.robot.description().urdf_text);
              texts.push_back(task.reference_file ? task.reference_file->text : "");
            });
            std::vector<nb::bytes> files;
            for (const std::string& text : texts) files.emplace_back(text.data(), text.size());
            return files;
          },
          nb::arg("package_dirs") = std::vector<std::string>{},
          "Raises InputError unless the task is right at both ends of every draw. Returns what the files say that "
          "these\n"
          "tasks name, in their order: robot, URDF, reference")
      .def("__repr__", [](const Job& job) {
        return fmt::format("<prowl.Job {}: {} motions, {} draws>", job.file.path.string(), job.count, job.draws.size());
      });
  module.def(
      "read_job",
      [](const fs::path& path, const fs::path& shipped_tasks) {
        const SourceText job_file = read_text_file(path);
        return read_job_text({fs::absolute(path), job_file.text}, shipped_tasks);
      },
      nb::arg("path"), nb::arg("shipped_tasks"), "Reads a job file, and its task file.");
  module.def(
      "parse_job",
      [](const std::string& text, const fs::path& path, const fs::path& shipped_tasks) {
        return read_job_text({fs::absolute(path), text}, shipped_tasks);
      },
      nb::arg("text"), nb::arg("path"), nb::arg("shipped_tasks"), "Reads the text of a job file, and its task file.");
  module.def(
      "job_of",
      [](const std::string& text, const fs::path& path, const std::string& task, const fs::path& task_path) {
        return job_with_task({path, text}, {task_path, task});
      },
      nb::arg("text"), nb::arg("path"), nb::arg("task"), nb::arg("task_path"),
      "A job from the texts of both files, without the files.");
}

}  // namespace prowl::python
