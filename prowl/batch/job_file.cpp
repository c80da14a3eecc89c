#include "prowl/batch/job_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "prowl/batch/key_path.hpp"
#include "prowl/error.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

namespace {

namespace fs = std::filesystem;

SourceText read_base_task(const TomlValue& task, const fs::path& job_folder, const fs::path& shipped_tasks) {
  const std::string name = task.as_text();
  const fs::path shipped = shipped_tasks / (name + ".toml"), beside = (job_folder / name).lexically_normal();
  std::error_code unknown;
  const bool is_shipped = !fs::is_regular_file(beside, unknown) && fs::is_regular_file(shipped, unknown);
  try {
    return read_text_file(is_shipped ? shipped : beside);
  } catch (const InputError& error) {
    task.fail(error.what());
  }
}

DrawnValue value_of(const toml::node& node) {
  if (const auto number = node.value_exact<double>()) return *number;
  if (const auto whole = node.value_exact<std::int64_t>()) return static_cast<double>(*whole);
  if (const auto flag = node.value_exact<bool>()) return *flag;
  if (const auto text = node.value_exact<std::string>()) return *text;
  std::ostringstream text;
  node.visit([&text](const auto& of_type) { text << of_type; });
  return text.str();
}

std::string toml_of(const toml::node& node) {
  std::ostringstream text;
  node.visit([&text](const auto& of_type) {
    if constexpr (toml::is_table<decltype(of_type)> || toml::is_array<decltype(of_type)>) {
      text << of_type;
    } else {
      toml::array list;  // the formatter takes no bare values
      list.push_back(of_type);
      std::ostringstream whole;
      whole << list;
      const std::string bracketed = whole.str();
      text << bracketed.substr(1, bracketed.size() - 2);
    }
  });
  return text.str();
}

struct KindKey {
  const char* key;
  Draw::Kind kind;
};
constexpr KindKey kKinds[] = {{"uniform", Draw::Kind::uniform},
                              {"log_uniform", Draw::Kind::log_uniform},
                              {"normal", Draw::Kind::normal},
                              {"one_of", Draw::Kind::one_of}};

void read_numbers(const TomlValue& value, Draw& draw) {
  const std::vector<TomlValue> numbers = value.as_list(2);
  draw.first = numbers[0].as_number();
  draw.second = numbers[1].as_number();
  if (draw.kind == Draw::Kind::normal) {
    if (!(draw.second > 0.0))
      numbers[1].fail(fmt::format("{} is not allowed; need a standard deviation > 0", draw.second));
  } else if (!(draw.first < draw.second)) {
    value.fail(fmt::format("[{}, {}] is an empty range; need [min, max] with min < max", draw.first, draw.second));
  }
}

void read_choices(const TomlValue& value, Draw& draw) {
  for (const TomlValue& choice : value.as_list()) {
    draw.choices.push_back({value_of(choice.node()), toml_of(choice.node())});
  }
  if (draw.choices.empty()) value.fail("an empty list is not allowed; need one value or more");
  for (const Drawn& one : draw.choices) {
    if (one.value.index() != draw.choices.front().value.index())
      value.fail("values of several types are not allowed; need one type");
  }
}

Draw read_draw(const TomlTable& table) {
  Draw draw;
  const TomlValue key = table.need("key");
  if (key.is_list()) {
    for (const TomlValue& entry : key.as_list()) draw.keys.push_back(entry.as_text());
    if (draw.keys.empty()) key.fail("an empty list is not allowed; need one key or more");
  } else {
    draw.keys.push_back(key.as_text());
  }
  draw.location = fmt::format("{}{}: ", locate(key.source(), key.path()), key.path());
  std::optional<TomlValue> given;
  for (const auto& [name, kind] : kKinds) {
    const auto value = table.find(name);
    if (!value) continue;
    if (given) value->fail("another distribution is here, too; need one in each [[draw]]");
    given = value;
    draw.kind = kind;
    kind == Draw::Kind::one_of ? read_choices(*value, draw) : read_numbers(*value, draw);
  }
  if (!given) {
    std::vector<const char*> names;
    for (const auto& [name, kind] : kKinds) names.push_back(name);
    table.value().fail(fmt::format("no distribution; need one of {}", fmt::join(names, ", ")));
  }
  return draw;
}

Job read_root(const SourceText& job_file, const TomlTable& root) {
  Job job{.file = job_file, .task_file = {}, .draws = {}};
  job.count = root.need("count").as_integer();
  if (const auto seed = root.find("seed")) job.seed = static_cast<std::uint64_t>(seed->as_integer());
  if (const auto grade = root.find("grade")) {
    job.grade = grade->as_choice("grade") == "certified" ? CertificateGrade::certified : CertificateGrade::draft;
  }
  if (const auto rate = root.find("rate_hz")) job.rate = rate->as_number();
  if (const auto gains = root.find("gains")) job.gains = gains->as_boolean();
  if (const auto simulation = root.find("simulation")) job.simulation = simulation->as_boolean();
  if (const auto shard = root.find("shard")) job.shard = shard->as_integer();
  if (const auto hang = root.find("hang_s")) job.hang_seconds = hang->as_number();
  for (const TomlTable& table : root.find_tables("draw")) job.draws.push_back(read_draw(table));
  for (std::size_t i = 0; i < job.draws.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (const std::string& key : job.draws[i].keys) {
        if (std::ranges::count(job.draws[j].keys, key) == 0) continue;
        throw InputError(fmt::format("{}\"{}\" is drawn twice", job.draws[i].location, key));
      }
    }
  }
  return job;
}

/// The value of a message: its first line without location.
std::string without_location(const std::string& message) {
  const std::string first = message.substr(0, message.find('\n'));
  const std::size_t end = first.find(".toml:");
  if (end == std::string::npos) return first;
  const std::size_t space = first.find(": ", end);
  return space == std::string::npos ? first : first.substr(space + 2);
}

}  // namespace

Job read_job_text(const SourceText& job_file, const fs::path& shipped_tasks) {
  const TomlDocument document(job_file);
  document.refuse_key("phase",
                      "this looks like a task file; need a job file, which names its task with task = \"...\"");
  document.check_all_keys(job_file_keys());
  return document.read_with([&] {
    const TomlTable root = document.root(job_file_keys());
    Job job = read_root(job_file, root);
    job.task_file = read_base_task(root.need("task"), job_file.path.parent_path(), shipped_tasks);
    return job;
  });
}

Job job_with_task(const SourceText& job_file, const SourceText& task_file) {
  const TomlDocument document(job_file);
  Job job = document.read_with([&] { return read_root(job_file, document.root(job_file_keys())); });
  job.task_file = task_file;
  return job;
}

void check_draws(const Job& job, const std::function<void(const SourceText& task_file)>& read_task) {
  read_task(job.task_file);
  for (const Draw& draw : job.draws) {
    for (const std::string& value : end_texts(draw)) {
      try {
        toml::table task = toml::parse(job.task_file.text);
        for (const std::string& key : draw.keys) set_at(task, key, value);
        read_task({job.task_file.path, toml_text(task)});
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}with the value {}: {}", draw.location, value, without_location(error.what())));
      }
    }
  }
}

}  // namespace prowl
