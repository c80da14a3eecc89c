#include "prowl/formulations/formulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "prowl/error.hpp"
#include "prowl/formulations/centroidal_nlp.hpp"
#include "prowl/formulations/collocation.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

using MakeRule = std::unique_ptr<CollocationRule> (*)();
using MakeChart = std::unique_ptr<BaseChart> (*)(const Eigen::Matrix3d& start);
template <class Value>
using Table = std::vector<std::pair<std::string, Value>>;

const Table<MakeRule> kRules = {
    {"trapezoid", trapezoid_rule},
    {"hermite-simpson", hermite_simpson_rule},
    {"hermite-simpson-separated", separated_hermite_simpson_rule},
    {"rk4", runge_kutta_rule},
};
const Table<MakeChart> kCharts = {
    {"se3", exponential_chart},
    {"euler", [](const Eigen::Matrix3d&) { return euler_chart(); }},
};

template <class Entries, class Name>
std::vector<std::string> names_of(const Entries& entries, Name name) {
  std::vector<std::string> names;
  for (const auto& entry : entries) names.push_back(entry.*name);
  return names;
}

template <class Entries, class Name>
const auto& find(const Entries& entries, Name name, const std::string& wanted) {
  return *std::ranges::find(entries, wanted, name);
}

void check(const char* what, const std::string& name, const std::vector<std::string>& allowed) {
  if (std::ranges::find(allowed, name) != allowed.end()) return;
  throw InputError(fmt::format("{}: \"{}\" is not allowed; need one of {}", what, name, fmt::join(allowed, ", ")));
}

}  // namespace

const std::vector<std::string>& dynamics_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = names_of(dynamics_forms(), &DynamicsForm::name);
    all.push_back("centroidal");
    return all;
  }();
  return names;
}

const std::vector<std::string>& transcription_names() {
  static const std::vector<std::string> names = names_of(kRules, &Table<MakeRule>::value_type::first);
  return names;
}

const std::vector<std::string>& contact_names() {
  static const std::vector<std::string> names = names_of(contact_forms(), &ContactForm::name);
  return names;
}

const std::vector<std::string>& orientation_names() {
  static const std::vector<std::string> names = names_of(kCharts, &Table<MakeChart>::value_type::first);
  return names;
}

std::unique_ptr<MotionNlp> make_collocation(const Formulation& formulation, const MotionProblem& problem,
                                            const Mesh& mesh, const Trajectory& guess) {
  const auto make_rule = find(kRules, &Table<MakeRule>::value_type::first, formulation.transcription).second;
  const auto make_chart = find(kCharts, &Table<MakeChart>::value_type::first, formulation.orientation).second;
  CollocationForm form{.dynamics = find(dynamics_forms(), &DynamicsForm::name, formulation.dynamics),
                       .rule = make_rule(),
                       .contact = find(contact_forms(), &ContactForm::name, formulation.contact),
                       .chart = make_chart(base_rotation(problem.start_configuration()))};
  return std::make_unique<Collocation>(problem, mesh, guess, std::move(form));
}

std::unique_ptr<MotionNlp> make_formulation(const Formulation& formulation, const MotionProblem& problem,
                                            const Mesh& mesh, const Trajectory& guess) {
  check("dynamics", formulation.dynamics, dynamics_names());
  check("transcription", formulation.transcription, transcription_names());
  check("contact", formulation.contact, contact_names());
  check("orientation", formulation.orientation, orientation_names());
  if (formulation == Formulation{}) return std::make_unique<Transcription>(problem, mesh, guess);
  if (std::ranges::any_of(problem.phases, [](const Phase& phase) { return !phase.shares.empty(); })) {
    throw InputError("phases.shares: only the default formulation takes steps of different length within a phase");
  }
  if (formulation.dynamics == "centroidal") return make_centroidal(formulation, problem, mesh, guess);
  return make_collocation(formulation, problem, mesh, guess);
}

}  // namespace prowl
