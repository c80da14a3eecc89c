#include "alternatives/formulation_library.hpp"

#include <algorithm>
#include <functional>

#include "alternatives/centroidal/centroidal_nlp.hpp"
#include "alternatives/collocation/collocation.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

namespace {

template <class Value>
using Table = std::vector<std::pair<std::string, Value>>;
using MakeProgram =
    std::function<std::unique_ptr<MotionNlp>(const Formulation&, const DiscreteProblem&, const Trajectory& guess)>;
using MakeRule = std::unique_ptr<CollocationRule> (*)();
using MakeChart = std::unique_ptr<BaseChart> (*)(const Eigen::Matrix3d& start);

MakeProgram collocation_with(std::unique_ptr<DynamicsForm> (*make_dynamics)());

// All choices, named as in formulation.cpp. Contact forms: contact_forms().
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
}  // namespace prowl

extern "C" [[gnu::visibility("default")]] prowl::MotionNlp* prowl_make_formulation(
    const prowl::Formulation& formulation, const prowl::DiscreteProblem& discrete, const prowl::Trajectory& guess) {
  using namespace prowl;
  return choice(kDynamics, formulation.dynamics)(formulation, discrete, guess).release();
}
