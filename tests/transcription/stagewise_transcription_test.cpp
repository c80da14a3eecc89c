#include "prowl/transcription/stagewise_transcription.hpp"

#include <gtest/gtest.h>

#include "prowl/guess/initial_guess.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::everything;
using test::free_phase;
using test::MeshedProblem;
using test::phase_on;

constexpr const char* kFirstRow = "base force x, equations of motion";  ///< of each node

/// A transcription near its guess, with both forms.
struct Forms {
  explicit Forms(const MeshedProblem& of)
      : discrete(of.discrete()), guess(initial_guess(discrete)), nlp(discrete, guess), stages(*nlp.stagewise()) {
    z_guess = nlp.pack(guess);
    for (int i = 0; i < nlp.num_variables(); ++i) {  // as a solver would put what is fixed
      if (nlp.variable_lower()(i) == nlp.variable_upper()(i)) z_guess(i) = nlp.variable_lower()(i);
    }
  }
  std::vector<VectorXd> random_stages(std::mt19937& rng, double size) {
    std::vector<VectorXd> result = stages.stages(z_guess);
    for (VectorXd& ux : result) ux += test::random_vector(rng, ux.size(), size);
    return result;
  }

  DiscreteProblem discrete;
  Trajectory guess;
  Transcription nlp;
  StagewiseNlp& stages;
  VectorXd z_guess;
};

/// Every problem that has a kind of stage of its own.
std::vector<MeshedProblem> problems() {
  const RobotModel hyq = test::hyq();
  std::vector<MeshedProblem> all = {
      everything(hyq, {phase_on("four", {0, 1, 2, 3}, 0.3, 2), phase_on("flight", {}, 0.2, 1)}),
      everything(hyq, {free_phase("four", {0, 1, 2, 3}, 2), phase_on("lifted", {1, 2, 3}, 0.2, 2),
                       free_phase("landed", {0, 1, 2, 3}, 2), free_phase("on it", {0, 3}, 1)}),
      everything(test::talos(),
                 {phase_on("left", {0, 1, 2, 3}, 0.3, 1), free_phase("both", {0, 1, 2, 3, 4, 5, 6, 7}, 1)}),
      everything(hyq, {free_phase("four", {0, 1, 2, 3}, 3), phase_on("lifted", {1, 2, 3}, 0.2, 2),
                       free_phase("landed", {0, 1, 2, 3}, 2)})};
  all.push_back(all[1]);  // with a start that is free in part
  BoundaryConstraint& start = all.back().problem.boundary_constraints.front();
  for (const int i : {1, 2, 4, 6, 7, 8}) start.configuration_upper(i) = 0.3;
  for (const int i : {0, 5, 9, 10, 11}) start.velocity_lower(i) = -0.4;
  all.push_back(all[1]);
  all.back().problem.terms = test::every_term(hyq, "lf_foot", "rh_upperleg", 4);
  all[1].problem.running_cost.time_weight = 2.3;
  all[1].problem.swing_clearance = 0.05;
  all[2].problem.running_cost.force_weight *= 0.1;
  all[3].problem.swing_clearance = 0.05;
  all[3].mesh.phases = {PhaseMesh({0.2, 0.7, 0.1}), PhaseMesh({0.8, 0.2}), PhaseMesh({0.4, 0.6})};
  return all;
}

/// All functions of a stage, one above the other.
VectorXd functions(StagewiseNlp& nlp, int k, const VectorXd& ux) {
  const StageValues& values = nlp.values(k, ux);
  VectorXd all(1 + values.next.size() + values.equalities.size() + values.inequalities.size());
  all << values.cost, values.next, values.equalities, values.inequalities;
  return all;
}

MatrixXd slopes(StagewiseNlp& nlp, int k, const VectorXd& ux) {
  const StageDerivatives& d = nlp.derivatives(k, ux);
  MatrixXd all(1 + d.next.rows() + d.equalities.rows() + d.inequalities.rows(), ux.size());
  all << d.cost_gradient.transpose(), d.next, d.equalities, d.inequalities;
  return all;
}

/// By differences of fourth order, one column a variable.
template <class Function>
MatrixXd differences(const VectorXd& at, Function function) {
  constexpr double h = 1e-4;  // of a unit: the tips of the friction cones are as small as 1e-2 of the weight
  MatrixXd result(function(at).size(), at.size());
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    const auto moved = [&](double by) {
      VectorXd point = at;
      point(j) += by;
      return function(point);
    };
    result.col(j) = (8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h);
  }
  return result;
}

TEST(StagewiseTranscription, DerivativesAreThoseOfDifferences) {
  std::mt19937 rng(7);
  for (const MeshedProblem& of : problems()) {
    Forms forms(of);
    const std::vector<VectorXd> point = forms.random_stages(rng, 0.05);
    for (int k = 0; k < forms.stages.num_stages(); ++k) {
      const VectorXd& ux = point[k];
      const StageSize& size = forms.stages.size(k);
      const MatrixXd exact = slopes(forms.stages, k, ux);
      const MatrixXd by_differences = differences(ux, [&](const VectorXd& x) { return functions(forms.stages, k, x); });
      EXPECT_LT(test::relative_error(exact, by_differences), 1e-6) << forms.stages.describe_stage(k);

      const StageMultipliers on{test::random_vector(rng, exact.rows() - 1 - size.equalities - size.inequalities, 1.0),
                                test::random_vector(rng, size.equalities, 1.0),
                                test::random_vector(rng, size.inequalities, 1.0)};
      VectorXd weights(exact.rows());
      weights << 1.7, on.next, on.equalities, on.inequalities;
      const MatrixXd hessian = forms.stages.hessian(k, ux, 1.7, on);
      const MatrixXd bent = differences(
          ux, [&](const VectorXd& x) -> VectorXd { return slopes(forms.stages, k, x).transpose() * weights; });
      // Forces near the tips of their cones bend so much that differences know six digits.
      EXPECT_LT(test::relative_error(hessian, bent), 1e-5) << forms.stages.describe_stage(k);
    }
  }
}

/// A form that is symmetric and positive, as what costs to go is.
MatrixXd random_form(std::mt19937& rng, Eigen::Index size) {
  const MatrixXd root = test::random_matrix(rng, size, size);
  return root * root.transpose();
}

StageMultipliers random_multipliers(std::mt19937& rng, const StageDerivatives& slopes) {
  return {test::random_vector(rng, slopes.next.rows(), 1.0), test::random_vector(rng, slopes.equalities.rows(), 1.0),
          test::random_vector(rng, slopes.inequalities.rows(), 1.0)};
}

MatrixXd lower(const MatrixXd& matrix) { return matrix.triangularView<Eigen::Lower>(); }

/// All that a linearised stage gives, at random arguments, in one vector.
VectorXd linear_functions(StagewiseNlp& nlp, int k, const MatrixXd& next_hessian, const VectorXd& weights,
                          const VectorXd& step, const StageMultipliers& on) {
  MatrixXd condensed = MatrixXd::Zero(step.size(), step.size());
  VectorXd next, inequalities, gradient = VectorXd::Zero(step.size());
  nlp.add_condensed(k, next_hessian, weights, condensed);
  nlp.push_forward(k, step, next, inequalities);
  nlp.add_pull_back(k, on.next, on.inequalities, gradient);
  VectorXd all(condensed.size() + next.size() + inequalities.size() + gradient.size() + step.size() +
               nlp.equality_slopes(k).size() + nlp.lagrangian_hessian(k).size());
  all << lower(condensed).reshaped(), next, inequalities, gradient, nlp.cost_gradient(k),
      nlp.equality_slopes(k).reshaped(), lower(nlp.lagrangian_hessian(k)).reshaped();
  return all;
}

TEST(StagewiseTranscription, LinearisedStagesAreTheirDenseMatrices) {
  std::mt19937 rng(11);
  int carried = 0;
  for (const MeshedProblem& of : problems()) {
    Forms forms(of), dense(of);
    const std::vector<VectorXd> point = forms.random_stages(rng, 0.05);
    for (int k = 0; k < forms.stages.num_stages(); ++k) {
      const VectorXd& ux = point[k];
      const StageDerivatives& slopes = dense.stages.derivatives(k, ux);
      const StageMultipliers at = random_multipliers(rng, slopes), on = random_multipliers(rng, slopes);
      const std::string where = forms.stages.describe_stage(k);
      forms.stages.linearise(k, ux, 1.7, at);
      EXPECT_LT(test::relative_error(forms.stages.cost_gradient(k), slopes.cost_gradient), 1e-10) << where;
      EXPECT_LT(test::relative_error(forms.stages.equality_slopes(k), slopes.equalities), 1e-10) << where;

      VectorXd weights = test::random_vector(rng, slopes.inequalities.rows(), 6.0);
      weights = weights.unaryExpr([](double e) { return std::pow(10.0, e); });
      for (const bool is_weighted : {false, true}) {
        const MatrixXd next_hessian = random_form(rng, slopes.next.rows());
        const VectorXd w = is_weighted ? weights : VectorXd::Zero(weights.size());
        const MatrixXd before = test::random_matrix(rng, ux.size(), ux.size());
        MatrixXd condensed = before;
        forms.stages.add_condensed(k, next_hessian, w, condensed);
        MatrixXd expected = slopes.inequalities.transpose() * w.asDiagonal() * slopes.inequalities;
        if (slopes.next.rows() > 0) expected += slopes.next.transpose() * next_hessian * slopes.next;
        EXPECT_LT(test::relative_error(lower(condensed), lower(before + expected)), 1e-10) << where;
      }

      const VectorXd step = test::random_vector(rng, ux.size(), 1.0), before = test::random_vector(rng, ux.size(), 1.0);
      VectorXd next, inequalities, gradient = before;
      forms.stages.push_forward(k, step, next, inequalities);
      ASSERT_EQ(next.size(), slopes.next.rows()) << where;
      EXPECT_LT(test::relative_error(next, slopes.next * step), 1e-10) << where;
      EXPECT_LT(test::relative_error(inequalities, slopes.inequalities * step), 1e-10) << where;
      forms.stages.add_pull_back(k, on.next, on.inequalities, gradient);
      const VectorXd pulled = slopes.next.transpose() * on.next + slopes.inequalities.transpose() * on.inequalities;
      EXPECT_LT(test::relative_error(gradient, before + pulled), 1e-10) << where;

      const MatrixXd& hessian = dense.stages.hessian(k, ux, 1.7, at);
      EXPECT_LT(test::relative_error(lower(forms.stages.lagrangian_hessian(k)), lower(hessian)), 1e-10) << where;
      EXPECT_GT(slopes.inequalities.norm(), 0.0) << where;
      carried += slopes.next.rows() > 2 * of.problem.robot.nv();
    }
  }
  EXPECT_GT(carried, 0) << "no stage hands on what a phase shares";
}

TEST(StagewiseTranscription, FirstOrderIsTheSameWithoutTheHessian) {
  std::mt19937 rng(13);
  for (const MeshedProblem& of : problems()) {
    Forms forms(of), other(of);
    const std::vector<VectorXd> here = forms.random_stages(rng, 0.05), there = forms.random_stages(rng, 0.05);
    for (int k = 0; k < forms.stages.num_stages(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      const StageMultipliers at = random_multipliers(rng, StageDerivatives(other.stages.derivatives(k, there[i])));
      const MatrixXd next_hessian = random_form(rng, at.next.size());
      const VectorXd weights = test::random_vector(rng, at.inequalities.size(), 1.0).cwiseAbs();
      const VectorXd step = test::random_vector(rng, here[i].size(), 1.0);
      const auto all = [&](StagewiseNlp& of) -> VectorXd {  // but the Hessian, which comes last
        const VectorXd functions = linear_functions(of, k, next_hessian, weights, step, at);
        return functions.head(functions.size() - of.lagrangian_hessian(k).size());
      };
      forms.stages.linearise(k, here[i], 1.7, at);
      other.stages.linearise_to_first_order(k, there[i]);
      other.stages.linearise_to_first_order(k, here[i]);
      EXPECT_EQ(all(other.stages), all(forms.stages)) << forms.stages.describe_stage(k);
    }
  }
}

TEST(StagewiseTranscription, TheHessianOfTheCostAloneKnowsNoMultipliers) {
  std::mt19937 rng(14);
  for (const MeshedProblem& of : problems()) {
    Forms forms(of);
    const std::vector<VectorXd> here = forms.random_stages(rng, 0.05);
    for (int k = 0; k < forms.stages.num_stages(); ++k) {
      const VectorXd& ux = here[k];
      const StageMultipliers at = random_multipliers(rng, StageDerivatives(forms.stages.derivatives(k, ux)));
      const StageMultipliers none = {0.0 * at.next, 0.0 * at.equalities, 0.0 * at.inequalities};
      forms.nlp.use_hessian(HessianKind::exact);
      const MatrixXd exact = forms.stages.hessian(k, ux, 1.7, at);
      forms.nlp.use_hessian(HessianKind::gauss_newton);
      const MatrixXd of_cost = forms.stages.hessian(k, ux, 1.7, at);
      EXPECT_EQ(of_cost, forms.stages.hessian(k, ux, 1.7, none)) << forms.stages.describe_stage(k);
      EXPECT_EQ(forms.stages.hessian(k, ux, 0.0, at).norm(), 0.0) << forms.stages.describe_stage(k);
      forms.nlp.use_hessian(HessianKind::exact);
      const MatrixXd unbent = forms.stages.hessian(k, ux, 1.7, none);
      const Eigen::Index nv = of.problem.robot.nv(), nu = of.problem.robot.nu();  // torques come after accelerations
      EXPECT_LT(test::relative_error(of_cost.block(nv, nv, nu, nu), unbent.block(nv, nv, nu, nu)), 1e-10)
          << forms.stages.describe_stage(k) << ": forces are linear in torques, so that nothing bends";
      EXPECT_GT(of_cost.block(nv, nv, nu, nu).norm(), 0.0) << forms.stages.describe_stage(k);
      EXPECT_GT((exact - of_cost).norm(), 1e-3 * exact.norm()) << forms.stages.describe_stage(k);
    }
  }
}

/// As when a line search looks elsewhere, and then a second order correction takes the same matrices again.
TEST(StagewiseTranscription, LinearisedStagesStayWhateverIsEvaluated) {
  std::mt19937 rng(12);
  for (const MeshedProblem& of : problems()) {
    Forms forms(of);
    const std::vector<VectorXd> here = forms.random_stages(rng, 0.05), there = forms.random_stages(rng, 0.05);
    for (int k = 0; k < forms.stages.num_stages(); ++k) {
      const auto i = static_cast<std::size_t>(k);
      const StageDerivatives slopes = forms.stages.derivatives(k, here[i]);
      const StageMultipliers at = random_multipliers(rng, slopes);
      const MatrixXd next_hessian = random_form(rng, slopes.next.rows());
      const VectorXd weights = test::random_vector(rng, slopes.inequalities.rows(), 1.0).cwiseAbs();
      const VectorXd step = test::random_vector(rng, here[i].size(), 1.0);
      const auto all = [&] { return linear_functions(forms.stages, k, next_hessian, weights, step, at); };
      forms.stages.linearise(k, here[i], 1.7, at);
      const VectorXd before = all();
      forms.stages.values(k, there[i]);
      EXPECT_EQ(all(), before) << forms.stages.describe_stage(k);
      forms.stages.linearise(k, there[i], 1.7, at);
      EXPECT_GT((all() - before).norm(), 1e-3) << "the same elsewhere: nothing was tested";
      forms.stages.linearise(k, here[i], 1.7, at);
      EXPECT_EQ(all(), before) << forms.stages.describe_stage(k);
    }
  }
}

TEST(StagewiseTranscription, ChangesOfFormAreInverse) {
  std::mt19937 rng(7);
  for (const MeshedProblem& of : problems()) {
    Forms forms(of);
    VectorXd z = forms.z_guess + test::random_vector(rng, forms.z_guess.size(), 0.1);
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      if (forms.nlp.variable_lower()(i) == forms.nlp.variable_upper()(i)) z(i) = forms.z_guess(i);
    }
    EXPECT_LT(test::relative_error(forms.stages.flat(forms.stages.stages(z)), z), 1e-12);
  }
}

/// The states that follow from random inputs, stage after stage, make no defect: both are the same trapezoid.
TEST(StagewiseTranscription, MotionsOfStagesHaveNoDefects) {
  std::mt19937 rng(7);
  for (const MeshedProblem& of : problems()) {
    Forms forms(of);
    std::vector<VectorXd> motion = forms.random_stages(rng, 0.05);
    for (std::size_t k = 0; k + 1 < motion.size(); ++k) {
      const VectorXd& next = forms.stages.values(static_cast<int>(k), motion[k]).next;
      motion[k + 1].tail(next.size()) = next;
    }
    const VectorXd z = forms.stages.flat(motion);
    VectorXd rows(forms.nlp.num_constraints());
    forms.nlp.constraints(z, rows);
    const int links = 2 * of.problem.robot.nv() * (forms.discrete.num_nodes() - 1);
    EXPECT_LT(rows.tail(links).cwiseAbs().maxCoeff(), 1e-12);

    double cost = 0.0, worst = 0.0;
    for (int k = 0; k < forms.stages.num_stages(); ++k) {
      const StageValues& values = forms.stages.values(k, motion[k]);
      cost += values.cost;
      if (values.equalities.size() > 0) worst = std::max(worst, values.equalities.cwiseAbs().maxCoeff());
    }
    EXPECT_NEAR(cost, forms.nlp.cost(z), 1e-9 * cost);
    EXPECT_GT(worst, 1e-3) << "a random motion that keeps the dynamics: nothing was tested";

    int k = 0;
    for (int row = 0; row < rows.size(); ++row) {
      if (forms.nlp.describe_constraint(row).find(kFirstRow) == std::string::npos) continue;
      const VectorXd& here = forms.stages.values(k, motion[k]).equalities;
      for (int i = 0; i < of.problem.robot.nv(); ++i) EXPECT_NEAR(here(i), rows(row + i), 1e-9);
      ++k;
    }
    EXPECT_EQ(k, forms.stages.num_stages());
  }
}

TEST(StagewiseTranscription, LeavesOutWhatIsFixed) {
  Forms forms(everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 2)}));
  EXPECT_EQ(forms.stages.size(0).states, 0);
  EXPECT_EQ(forms.stages.size(1).states, 36);
  EXPECT_EQ(forms.stages.size(1).inputs, 30);
  EXPECT_EQ(forms.stages.size(1).equalities, 18);
  EXPECT_EQ(forms.stages.size(2).equalities, 24) << "the goal binds the base";
}

}  // namespace
}  // namespace prowl
