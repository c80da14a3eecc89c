// Solves one task with Aligator: its document (bench/peers/aligator_solver.py) on stdin, the motion and times on
// stdout.

#include <aligator/solvers/proxddp/solver-proxddp.hpp>
#include <ctime>
#include <exception>
#include <iostream>
#include <limits>
#include <memory>

#include "problem.hpp"

namespace {

using nlohmann::json;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct OutOfTime {};

/// Ends the solve after the iteration in which its time is over.
struct Watch : aligator::CallbackBaseTpl<double> {
  explicit Watch(double end) : end_(end) {}
  void call(const Workspace&, const Results&) override {
    if (cpu_seconds() > end_) throw OutOfTime();
  }

 private:
  double end_;
};

json arrays(const peer::Vectors& vectors) {
  json result = json::array();
  for (const Eigen::VectorXd& entry : vectors) result.push_back(std::vector<double>(entry.begin(), entry.end()));
  return result;
}

json solve(const json& document) {
  const json& settings = document.at("settings");
  const double start = cpu_seconds();
  const peer::ShootingProblem shooting = peer::read_problem(document);
  const double setup = cpu_seconds() - start;

  json answer{{"setup_seconds", setup}, {"seconds", json::array()}};
  double total = 0.0;
  do {
    aligator::SolverProxDDPTpl<double> solver(settings.at("tolerance"), settings.at("penalty"),
                                              settings.at("max_iterations").get<std::size_t>());
    if (settings.at("filter")) solver.sa_strategy_ = aligator::StepAcceptanceStrategy::FILTER;
    const double begin = cpu_seconds();
    solver.registerCallback("watch", std::make_shared<Watch>(begin + settings.at("time_limit").get<double>()));
    solver.setup(shooting.problem);
    bool converged = false;
    try {
      converged = solver.run(shooting.problem, shooting.states, shooting.inputs);
    } catch (const OutOfTime&) {  // its last iterate is judged
    }
    const double seconds = cpu_seconds() - begin;
    total += seconds;
    answer["seconds"].push_back(seconds);
    answer["converged"] = converged;
    answer["iterations"] = solver.results_.num_iters;
    answer["states"] = arrays(solver.results_.xs);
    answer["inputs"] = arrays(solver.results_.us);
  } while (static_cast<int>(answer["seconds"].size()) < settings.at("repetitions").get<int>() &&
           total < settings.at("patience").get<double>());
  return answer;
}

}  // namespace

int main() try {
  std::cout << solve(json::parse(std::cin)) << '\n';
  return 0;
} catch (const std::exception& error) {
  std::cerr << "aligator_peer: " << error.what() << '\n';
  return 1;
}
