#include "alternatives/formulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "alternatives/centroidal/centroidal_nlp.hpp"
#include "alternatives/collocation/collocation.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

template <class Value>
using Table = std::vector<std::pair<std::string, Value>>;
using MakeProgram =
    std::function<std::unique_ptr<MotionNlp>(const Formulation&, const DiscreteProblem&, const Trajectory& guess)>;
using MakeRule = std::unique_ptr<CollocationRule> (*)();
using MakeChart = std::unique_ptr<BaseChart> (*)(const Eigen::Matrix3d& start);

MakeProgram collocation_with(std::unique_ptr<DynamicsForm> (*make_dynamics)());

// All choices, the default first. Contact forms: contact_forms().
const Table<MakeProgram> kDynamics = {
    {"inverse", collocation_with(inverse_dynamics)},
    {"forward", collocation_with(forward_dynamics)},
    {"kkt", collocation_with(kkt_dynamics)},
    {"centroidal", make_centroidal},
};
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

template <class Value>
std::vector<std::string> names_of(const Table<Value>& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.push_back(entry.first);
  return names;
}

void check(const char* what, const std::string& name, const std::vector<std::string>& allowed) {
  if (std::ranges::find(allowed, name) != allowed.end()) return;
  throw InputError(fmt::format("{}: \"{}\" is not allowed; need one of {}", what, name, fmt::join(allowed, ", ")));
}

template <class Value>
const Value& choice(const Table<Value>& table, const std::string& name) {
  return std::ranges::find(table, name, &Table<Value>::value_type::first)->second;
}

MakeProgram collocation_with(std::unique_ptr<DynamicsForm> (*make_dynamics)()) {
  return [make_dynamics](const Formulation& formulation, const DiscreteProblem& discrete, const Trajectory& guess) {
    CollocationForm form{
        .dynamics_name = formulation.dynamics,
        .dynamics = make_dynamics(),
        .rule = choice(kRules, formulation.transcription)(),
        .contact = *std::ranges::find(contact_forms(), formulation.contact, &ContactForm::name),
        .chart = choice(kCharts, formulation.orientation)(base_rotation(discrete.problem.start_configuration()))};
    return std::make_unique<Collocation>(discrete, guess, std::move(form));
  };
}

}  // namespace

const std::vector<std::string>& dynamics_names() {
  static const std::vector<std::string> names = names_of(kDynamics);
  return names;
}

const std::vector<std::string>& transcription_names() {
  static const std::vector<std::string> names = names_of(kRules);
  return names;
}

const std::vector<std::string>& contact_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const ContactForm& form : contact_forms()) all.push_back(form.name);
    return all;
  }();
  return names;
}

const std::vector<std::string>& orientation_names() {
  static const std::vector<std::string> names = names_of(kCharts);
  return names;
}

std::unique_ptr<MotionNlp> make_formulation(const Formulation& formulation, const DiscreteProblem& discrete,
                                            const Trajectory& guess) {
  if (formulation == Formulation{}) return std::make_unique<Transcription>(discrete, guess);
  return make_collocation(formulation, discrete, guess);
}

std::unique_ptr<MotionNlp> make_collocation(const Formulation& formulation, const DiscreteProblem& discrete,
                                            const Trajectory& guess) {
  check("dynamics", formulation.dynamics, dynamics_names());
  check("transcription", formulation.transcription, transcription_names());
  check("contact", formulation.contact, contact_names());
  check("orientation", formulation.orientation, orientation_names());
  if (!discrete.mesh.is_even()) {
    throw InputError("phases.shares: only the default formulation allows steps of different length within a phase");
  }
  return choice(kDynamics, formulation.dynamics)(formulation, discrete, guess);
}

}  // namespace prowl
