#include <fmt/format.h>

#include "prowl/batch/job_file.hpp"

namespace prowl {

namespace {

FileKeys make_job_file_keys() {
  const NumberRange positive = NumberRange::positive();
  const char* const kPair = "[number, number]";
  FileKeys keys = {
      {.name = "task",
       .form = "string",
       .meaning = "task file, relative to this one, or a shipped task such as \"hyq/crouch\""},
      {.name = "count", .form = "integer", .range = {.lower = 1, .upper = 1e8}, .meaning = "number of motions"},
      {.name = "seed",
       .form = "integer",
       .range = {.lower = 0, .upper = 1e9},
       .fallback = fmt::format("{}", Job{}.seed),
       .meaning = "seed of draws and simulations: a motion depends on this file and its index alone"},
      {.name = "grade",
       .choices = {"draft", "certified"},
       .fallback = "\"draft\"",
       .meaning = "grade of the certificate that a motion needs"},
      {.name = "rate_hz",
       .form = "number",
       .range = {.lower = 1.0, .upper = 1e4},
       .unit = "Hz",
       .fallback = fmt::format("{:g}", Job{}.rate),
       .meaning = "samples of a motion per second"},
      {.name = "gains", .form = "boolean", .fallback = "false", .meaning = "also keep the feedback gains"},
      {.name = "simulation",
       .form = "boolean",
       .fallback = "false",
       .meaning = "also simulate each motion with its gains, under the strict judge"},
      {.name = "shard",
       .form = "integer",
       .range = {.lower = 1, .upper = 1e5},
       .fallback = fmt::format("{}", Job{}.shard),
       .meaning = "motions in one file"},
      {.name = "hang_s",
       .form = "number",
       .range = positive,
       .unit = "s",
       .fallback = fmt::format("{:g}", Job{}.hang_seconds),
       .meaning = "a motion that takes longer is left out, and tried again when the job is resumed"},
      {.name = "draw", .form = "[[draw]]", .meaning = "values that differ from motion to motion"},
  };
  const auto of_draw = [&keys](FileKey key) {
    key.table = "draw";
    keys.push_back(std::move(key));
  };
  of_draw({.name = "key",
           .form = "string or list of strings",
           .meaning = "key of the task file, such as \"goal[0].base_displacement_m[2]\", counted from 0; all of a list "
                      "get the same value"});
  of_draw({.name = "uniform", .form = kPair, .meaning = "evenly from the first number to the second"});
  of_draw({.name = "log_uniform", .form = kPair, .range = positive, .meaning = "likewise in the logarithm"});
  of_draw({.name = "normal",
           .form = kPair,
           .meaning = "mean and standard deviation; at most three of these from the mean"});
  of_draw({.name = "one_of", .form = "list", .meaning = "one of these values"});
  return keys;
}

}  // namespace

const FileKeys& job_file_keys() {
  static const FileKeys keys = make_job_file_keys();
  return keys;
}

}  // namespace prowl
