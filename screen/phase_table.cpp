#include "screen/phase_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "prowl/files/json_text.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

/// "1 s", "0.5 to 1 s"
std::string in_words(const Duration& duration) {
  return duration.is_fixed() ? fmt::format("{:g} s", duration.min)
                             : fmt::format("{:g} to {:g} s", duration.min, duration.max);
}

/// "floor", "floor, lands, opens"
std::string in_words(const MotionProblem& problem, const ContactSchedule& schedule, int phase, int i) {
  const PhaseContact& held = problem.phases[phase].contacts[i];
  return problem.surfaces[held.surface].name + (schedule.lands(phase, i) ? ", lands" : "") +
         (schedule.opens(phase, i) ? ", opens" : "");
}

Row row_of(const DiscreteProblem& discrete, int p) {
  const MotionProblem& problem = discrete.problem;
  const Phase& phase = problem.phases[p];
  Row row = {fmt::format("{}", p + 1), phase.name, in_words(phase.duration),
             fmt::format("{}", discrete.mesh.phases[p].intervals())};
  const std::size_t first_contact = row.size();
  row.resize(first_contact + problem.robot.contacts().size(), "-");
  for (int i = 0; i < static_cast<int>(phase.contacts.size()); ++i) {
    const int contact = phase.contacts[i].contact;
    row[first_contact + static_cast<std::size_t>(contact)] = in_words(problem, discrete.schedule, p, i);
  }
  return row;
}

/// "HyQ trot: 3 phases, 40 intervals, 2 s\n"
std::string heading(const MotionProblem& problem, const Mesh& mesh) {
  Duration total;
  for (const Phase& phase : problem.phases) {
    total.min += phase.duration.min;
    total.max += phase.duration.max;
  }
  return fmt::format("{} {}: {} phase{}, {} intervals, {}\n", problem.robot.name(), problem.name, problem.phases.size(),
                     problem.phases.size() == 1 ? "" : "s", mesh.num_intervals(), in_words(total));
}

}  // namespace

std::string phase_table(const DiscreteProblem& discrete) {
  const MotionProblem& problem = discrete.problem;
  std::vector<Row> rows = {{"#", "phase", "duration", "intervals"}};
  for (const ContactPoint& contact : problem.robot.contacts()) rows[0].push_back(contact.name);
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) rows.push_back(row_of(discrete, p));

  std::string text = heading(problem, discrete.mesh);
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t column = 0; column < row.size(); ++column) {
      std::size_t width = 0;
      for (const Row& other : rows) width = std::max(width, other[column].size());
      const bool is_text = column == 1 || column > 3;
      line += is_text ? fmt::format("  {:<{}}", row[column], width) : fmt::format("  {:>{}}", row[column], width);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string phases_json(const DiscreteProblem& discrete) {
  const MotionProblem& problem = discrete.problem;
  Json phases = Json::array();
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const Phase& phase = problem.phases[p];
    Json contacts = Json::array();
    for (int i = 0; i < static_cast<int>(phase.contacts.size()); ++i) {
      const PhaseContact& held = phase.contacts[i];
      contacts.push_back({{"contact", problem.robot.contacts()[held.contact].name},
                          {"surface", problem.surfaces[held.surface].name},
                          {"lands", discrete.schedule.lands(p, i)},
                          {"opens", discrete.schedule.opens(p, i)}});
      if (held.foothold) contacts.back()["place_m"] = std::vector<double>(held.foothold->begin(), held.foothold->end());
    }
    phases.push_back({{"name", phase.name},
                      {"duration_s", {phase.duration.min, phase.duration.max}},
                      {"intervals", discrete.mesh.phases[p].intervals()},
                      {"contacts", contacts}});
  }
  return json_text({{"name", problem.name}, {"robot", problem.robot.name()}, {"phases", phases}});
}

}  // namespace prowl
