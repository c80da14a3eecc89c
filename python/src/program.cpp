#include <fmt/format.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <mutex>
#include <type_traits>

#include "alternatives/guess_choice.hpp"
#include "alternatives/run_formulation.hpp"
#include "bindings.hpp"
#include "motion.hpp"
#include "prowl/error.hpp"
#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/nlp/dual_violation.hpp"
#include "prowl/task_file/task_file.hpp"

namespace prowl::python {
namespace {

using ConstVector = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using IndexArrays = std::pair<Integers, Integers>;

/// Quality of a point of a program: a FormulationRun without solver.
struct MeasuredPoint {
  FormulationRun run;
  Motion motion;
};

/// prowl.Program: a motion problem as a nonlinear program. Functions of an Nlp share work space, so
/// calls are serialised; they release the GIL.
class Program {
 public:
  Program(const Task& task, const Formulation& formulation, const std::string& guess_name)
      : task_(task), discrete_(task.problem, task.mesh), formulation_(formulation) {
    const nb::gil_scoped_release others_may_run;
    const Trajectory guess = make_guess(guess_name, discrete_);
    nlp_ = make_formulation(formulation_, discrete_, guess);
    z_guess_ = nlp_->pack(guess);
  }

  const Task& task() const { return task_; }
  const Formulation& formulation() const { return formulation_; }
  const MotionNlp& nlp() const { return *nlp_; }
  const Eigen::VectorXd& z_guess() const { return z_guess_; }
  int nodes() const { return discrete_.num_nodes(); }

  double cost(const ConstVector& z) {
    return locked([&] { return nlp_->cost(point(z)); });
  }
  Array cost_gradient(const ConstVector& z) {
    return filled(nlp_->num_variables(), [&](auto& values) { nlp_->cost_gradient(point(z), values); });
  }
  Array constraints(const ConstVector& z) {
    return filled(nlp_->num_constraints(), [&](auto& values) { nlp_->constraints(point(z), values); });
  }
  Array jacobian(const ConstVector& z) {
    return filled(nlp_->jacobian_pattern().size(), [&](auto& values) { nlp_->jacobian(point(z), values); });
  }
  Array hessian(const ConstVector& z, double cost_factor, const ConstVector& multipliers) {
    return filled(nlp_->hessian_pattern().size(), [&](auto& values) {
      nlp_->hessian(point(z), cost_factor, vector(multipliers, nlp_->num_constraints(), "multipliers"), values);
    });
  }
  double dual_violation(const ConstVector& z, const ConstVector& multipliers) {
    return locked([&] {
      return prowl::dual_violation(*nlp_, point(z), vector(multipliers, nlp_->num_constraints(), "multipliers"));
    });
  }
  std::string describe_variable(int index) const {
    check_index(index, nlp_->num_variables());
    return nlp_->describe_variable(index);
  }
  std::string describe_constraint(int row) const {
    check_index(row, nlp_->num_constraints());
    return nlp_->describe_constraint(row);
  }

  MeasuredPoint measure(const ConstVector& z) {
    return locked([&] {
      SolveResult result;
      result.z = point(z);
      Eigen::VectorXd rows(nlp_->num_constraints());
      nlp_->constraints(result.z, rows);
      result.cost = nlp_->cost(result.z);
      result.constraint_violation = constraint_violation(*nlp_, result.z, rows);
      FormulationRun run = measure_formulation(discrete_, formulation_, *nlp_, std::move(result), "");
      Motion motion(run.motion);
      return MeasuredPoint{std::move(run), std::move(motion)};
    });
  }

 private:
  static Eigen::VectorXd vector(const ConstVector& values, int size, const char* name) {
    if (static_cast<int>(values.size()) == size) return Eigen::Map<const Eigen::VectorXd>(values.data(), size);
    throw InputError(fmt::format("{}: shape ({}) is not allowed; need ({})", name, values.size(), size));
  }
  Eigen::VectorXd point(const ConstVector& z) const { return vector(z, nlp_->num_variables(), "z"); }
  static void check_index(int index, int size) {
    if (index < 0 || index >= size) throw InputError(fmt::format("{} is not allowed; need 0 to {}", index, size - 1));
  }

  template <class Evaluate>
  std::invoke_result_t<const Evaluate&> locked(const Evaluate& evaluate) {
    const nb::gil_scoped_release others_may_run;
    const std::lock_guard lock(busy_);
    return evaluate();
  }
  template <class Evaluate>
  Array filled(int size, const Evaluate& evaluate) {
    Eigen::VectorXd values(size);
    locked([&] { evaluate(values); });
    return new_array(values);
  }

  Task task_;
  DiscreteProblem discrete_;
  Formulation formulation_;
  std::unique_ptr<MotionNlp> nlp_;
  Eigen::VectorXd z_guess_;
  std::mutex busy_;
};

Vector numbers(nb::handle self, const Eigen::VectorXd& values) { return view(values, self); }

IndexArrays index_arrays(nb::handle self, const SparsityPattern& pattern) {
  const auto integers = [&](const std::vector<int>& values) { return Integers(values.data(), {values.size()}, self); };
  return {integers(pattern.rows), integers(pattern.cols)};
}

const Program& program(nb::handle self) { return nb::cast<const Program&>(self); }

void bind_measured_point(nb::module_& module) {
  nb::class_<MeasuredPoint>(module, "JudgedPoint", "Cost, violation, motion and certificate of a point of a Program.")
      .def_prop_ro("cost", [](const MeasuredPoint& p) { return p.run.result.cost; })
      .def_prop_ro(
          "constraint_violation", [](const MeasuredPoint& p) { return p.run.result.constraint_violation; },
          "Largest violation of the program's rows and bounds, unscaled.")
      .def_prop_ro(
          "certificate", [](const MeasuredPoint& p) -> const Certificate& { return p.run.certificate; },
          nb::rv_policy::reference_internal,
          "Certificate of the motion, by code that shares neither dynamics nor transcription with the program.")
      .def_ro("motion", &MeasuredPoint::motion, nb::rv_policy::reference_internal,
              "Motion of this point at the nodes of the program.")
      .def(
          "check", [](const MeasuredPoint& p, const std::string& name) { return p.run.certificate.find(name); },
          nb::arg("name"), nb::rv_policy::reference_internal, nb::sig("def check(self, name: str) -> Check | None"),
          "One check of the certificate by its name, such as \"contact drift\"; None if it does not apply.")
      .def_prop_ro(
          "worst_check", [](const MeasuredPoint& p) { return p.run.worst_check(); }, nb::rv_policy::reference_internal,
          nb::sig("def worst_check(self) -> Check | None"), "The check with the largest share of its limit.")
      .def("__repr__", [](const MeasuredPoint& p) {
        return fmt::format("<prowl.JudgedPoint cost {:.6g}, violation {:.2e}, certificate {}>", p.run.result.cost,
                           p.run.result.constraint_violation, to_string(p.run.certificate.grade));
      });
}

}  // namespace

void bind_program(nb::module_& module) {
  bind_measured_point(module);
  nb::class_<Program>(
      module, "Program",
      "A task as a nonlinear program (docs/formulations.md): minimise cost(z), variable_lower <= z <= variable_upper,\n"
      "constraint_lower <= constraints(z) <= constraint_upper, with exact derivatives, for your own solver.\n"
      "Missing bounds are +-inf. Sparse matrices have a fixed pattern (rows, columns), and values in the same order.\n"
      "Functions may raise NumericalError. They release the GIL and are serialised.\n\n"
      "guess: \"smooth\", as in `prowl plan`, or \"straight\": straight lines between postures with the torques of "
      "standing.")
      .def(
          "__init__",
          [](Program* self, const Task& task, const std::string& dynamics, const std::string& transcription,
             const std::string& contact, const std::string& orientation, const std::string& guess) {
            new (self) Program(task, {dynamics, transcription, contact, orientation}, guess);
          },
          nb::arg("task"), nb::kw_only(), nb::arg("dynamics") = dynamics_names().front(),
          nb::arg("transcription") = transcription_names().front(), nb::arg("contact") = contact_names().front(),
          nb::arg("orientation") = orientation_names().front(), nb::arg("guess") = guess_names().front())
      .def_prop_ro("task", &Program::task, nb::rv_policy::reference_internal)
      .def_prop_ro("dynamics", [](const Program& p) { return p.formulation().dynamics; })
      .def_prop_ro("transcription", [](const Program& p) { return p.formulation().transcription; })
      .def_prop_ro("contact", [](const Program& p) { return p.formulation().contact; })
      .def_prop_ro("orientation", [](const Program& p) { return p.formulation().orientation; })
      .def_prop_ro("nodes", &Program::nodes, "Nodes of the mesh.")
      .def_prop_ro("num_variables", [](const Program& p) { return p.nlp().num_variables(); })
      .def_prop_ro("num_constraints", [](const Program& p) { return p.nlp().num_constraints(); })
      .def_prop_ro(
          "start", [](nb::handle self) { return numbers(self, program(self).z_guess()); }, "Initial guess z.")
      .def_prop_ro("variable_lower",
                   [](nb::handle self) { return numbers(self, program(self).nlp().variable_lower()); })
      .def_prop_ro("variable_upper",
                   [](nb::handle self) { return numbers(self, program(self).nlp().variable_upper()); })
      .def_prop_ro("constraint_lower",
                   [](nb::handle self) { return numbers(self, program(self).nlp().constraint_lower()); })
      .def_prop_ro("constraint_upper",
                   [](nb::handle self) { return numbers(self, program(self).nlp().constraint_upper()); })
      .def_prop_ro(
          "jacobian_pattern",
          [](nb::handle self) { return index_arrays(self, program(self).nlp().jacobian_pattern()); },
          "(rows, columns), without duplicates.")
      .def_prop_ro(
          "hessian_pattern", [](nb::handle self) { return index_arrays(self, program(self).nlp().hessian_pattern()); },
          "(rows, columns) of the lower triangle.")
      .def("cost", &Program::cost, nb::arg("z"))
      .def("cost_gradient", &Program::cost_gradient, nb::arg("z"), "(num_variables)")
      .def("constraints", &Program::constraints, nb::arg("z"), "(num_constraints)")
      .def("jacobian", &Program::jacobian, nb::arg("z"), "Values in the order of jacobian_pattern.")
      .def("hessian", &Program::hessian, nb::arg("z"), nb::arg("cost_factor"), nb::arg("multipliers"),
           "Hessian of cost_factor cost + multipliers . constraints, in the order of hessian_pattern.")
      .def("dual_violation", &Program::dual_violation, nb::arg("z"), nb::arg("multipliers"),
           "Violation of stationarity of a z within its bounds: largest |clip(z - gradient, lower, upper) - z|, with "
           "the\n"
           "gradient of cost + multipliers . constraints.")
      .def("describe_variable", &Program::describe_variable, nb::arg("index"), "Description in the words of the task.")
      .def("describe_constraint", &Program::describe_constraint, nb::arg("row"),
           "Description in the words of the task.")
      .def("judge", &Program::measure, nb::arg("z"), "Cost, violation, motion and certificate of any point.")
      .def("__repr__", [](const Program& p) {
        return fmt::format("<prowl.Program {}: {}, {}, {}, {}: {} variables, {} constraints>", p.task().problem.name,
                           p.formulation().dynamics, p.formulation().transcription, p.formulation().contact,
                           p.formulation().orientation, p.nlp().num_variables(), p.nlp().num_constraints());
      });
}

}  // namespace prowl::python
