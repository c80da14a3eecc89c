// Prints the keys of task, robot, job and script files as JSON, for write.py: {"task": [{"table", "name", "type",
// "unit", "default", "meaning", "formula"}], "robot": [...], "job": [...], "script": [...]}.
#include "prowl/task_file/toml/file_keys.hpp"

#include <iostream>
#include <nlohmann/json.hpp>

#include "prowl/batch/job_file.hpp"
#include "prowl/online/script_file.hpp"

namespace {

nlohmann::ordered_json json_of(const prowl::FileKeys& keys) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const prowl::FileKey& key : keys)
    list.push_back({{"table", key.table},
                    {"name", key.name},
                    {"type", key.type()},
                    {"unit", key.unit},
                    {"default", key.fallback},
                    {"meaning", key.meaning},
                    {"formula", key.formula}});
  return list;
}

}  // namespace

int main() {
  std::cout << nlohmann::ordered_json{{"task", json_of(prowl::task_file_keys())},
                                      {"robot", json_of(prowl::robot_file_keys())},
                                      {"job", json_of(prowl::job_file_keys())},
                                      {"script", json_of(prowl::script_file_keys())}}
            << "\n";
}
