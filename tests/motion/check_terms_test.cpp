#include "prowl/motion/check_terms.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/motion/contradicting_terms.hpp"
#include "prowl/terms/own_term.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/standing_problem.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

/// What check_terms() says of HyQ that stands for a second with this term; "" if nothing.
std::string complaint(const TermUse& use) {
  MotionProblem problem = test::standing_problem(test::hyq());
  problem.terms = {use};
  try {
    check_terms(problem);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TermUse whole(TermUse use) { return test::over(std::move(use), PhaseFraction::start_of(0), PhaseFraction::end_of(0)); }

TEST(CheckTerms, TakesOnesThatAreRight) {
  EXPECT_EQ(complaint(whole(test::limit_on("centre", center_of_mass(), -1.0, 1.0))), "");
  EXPECT_EQ(complaint(whole(test::cost_on("centre", center_of_mass(), 1.0, 0.2))), "");
  EXPECT_EQ(complaint(test::over(test::limit_on("base", frame_position("base"), 0.2, 0.2), {0, 0.5}, {0, 0.5})), "");
}

TEST(CheckTerms, NamesTheFieldThatIsWrong) {
  const auto with = [](const std::function<void(TermUse&)>& fault, bool is_cost = false) {
    TermUse use = whole(is_cost ? test::cost_on("hand", frame_position("lf_foot"), 1.0, 0.0)
                                : test::limit_on("hand", frame_position("lf_foot"), -9.0, 9.0));
    fault(use);
    return complaint(use);
  };
  EXPECT_EQ(with([](TermUse& use) { use.term = nullptr; }), "terms[0].term: none is not allowed; need a term");
  EXPECT_EQ(with([](TermUse& use) { use.name = ""; }), "terms[0].name: an empty name is not allowed");
  EXPECT_EQ(with([](TermUse& use) { use.term = frame_position("lf_fot"); }),
            "terms[0].frame: robot 'HyQ' has no link 'lf_fot'; did you mean 'lf_foot'?");
  EXPECT_EQ(with([](TermUse& use) { use.to = PhaseFraction::end_of(3); }),
            "terms[0].to: phase 3 is not allowed; need 0 to 0");
  EXPECT_EQ(with([](TermUse& use) { use.from.fraction = 1.5; }),
            "terms[0].from: fraction 1.5 is not allowed; need 0 to 1");
  EXPECT_EQ(with([](TermUse& use) { std::swap(use.from, use.to); }),
            "terms[0].to: is before from; need a later moment");
  EXPECT_EQ(with([](TermUse& use) { use.lower.resize(2); }), "terms[0].lower: 2 entries are not allowed; need 3");
  EXPECT_EQ(with([](TermUse& use) { use.lower(1) = 10.0; }),
            "terms[0].lower: 10 to 9 for y is not allowed; need lower <= upper");
  EXPECT_EQ(with([](TermUse& use) {
              use.lower.setConstant(-std::numeric_limits<double>::infinity());
              use.upper = -use.lower;
            }),
            "terms[0]: limits nothing; need one finite bound or more");
  EXPECT_EQ(with([](TermUse& use) { use.reference.setZero(3); }),
            "terms[0].reference: 3 entries are not allowed; need 0");
  EXPECT_EQ(with([](TermUse& use) { use.upper.setZero(3); }, true),
            "terms[0].upper: 3 entries are not allowed; need 0");
  EXPECT_EQ(with(
                [](TermUse& use) {
                  use.term = frame_orientation("trunk", Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal());
                  use.reference.setZero();
                },
                true),
            "terms[0]: at the start: term 'hand': its value is not finite; need another start or reference");
  EXPECT_EQ(with([](TermUse& use) { use.weight = Eigen::Vector3d(1.0, -2.0, 1.0).asDiagonal(); }, true),
            "terms[0].weight: is not positive semidefinite: an eigenvalue is -2; need none below zero");
  EXPECT_EQ(with([](TermUse& use) { use.weight(2, 0) = 0.5; }, true),
            "terms[0].weight: is not symmetric: entry 2, 0 is 0.5, entry 0, 2 is 0.3");
  EXPECT_EQ(with([](TermUse& use) { use.weight.setIdentity(2, 2); }, true),
            "terms[0].weight: 2 x 2 entries are not allowed; need 3 x 3");
  EXPECT_EQ(with([](TermUse& use) { use.weight(1, 1) = std::nan(""); }, true),
            "terms[0].weight: an entry that is not finite is not allowed");
  EXPECT_EQ(with([](TermUse& use) { use.reference(0) = std::nan(""); }, true),
            "terms[0].reference: nan is not allowed; need a finite number");
}

/// A user's function with an entry of its derivatives that is wrong by a factor.
std::shared_ptr<const Term> distance(double slope, double curvature) {
  class Distance : public Term {
   public:
    Distance(double slope, double curvature)
        : Term({{.kind = Quantity::Kind::position, .name = "lf_foot"}}, {"distance"}, "m"),
          slope_(slope),
          curvature_(curvature) {}
    void value(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> f) const override { f(0) = y.squaredNorm(); }
    void jacobian(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> f_y) const override {
      f_y.row(0) = 2.0 * y.transpose();
      f_y(0, 2) *= slope_;
    }
    void hessian(const Eigen::VectorXd& /*y*/, const Eigen::VectorXd& multipliers,
                 Eigen::Ref<Eigen::MatrixXd> f_yy) const override {
      f_yy.diagonal().setConstant(2.0 * multipliers(0));
      f_yy(1, 1) *= curvature_;
    }

   private:
    double slope_, curvature_;
  };
  return std::make_shared<Distance>(slope, curvature);
}

TEST(CheckTerms, NamesTheWrongDerivative) {
  const auto said = [](double slope, double curvature) {
    return complaint(whole(test::limit_on("mine", distance(slope, curvature), -9.0, 9.0)));
  };
  EXPECT_EQ(said(1.0, 1.0), "");
  EXPECT_THAT(said(1.001, 1.0),
              testing::StartsWith(
                  "terms[0].term: the derivative of 'distance' with respect to the position of 'lf_foot', z is "));
  EXPECT_THAT(said(1.0, 0.5),
              testing::AllOf(testing::HasSubstr("with respect to the position of 'lf_foot', y and the position"),
                             testing::EndsWith(" is 2; finite differences give 4")));
}

TEST(CheckTerms, NamesTheNearestContact) {
  EXPECT_THAT(complaint(whole(test::limit_on("push", contact_force("lf_fot"), -9.0, 9.0))),
              testing::AllOf(testing::StartsWith("terms[0].contact: "), testing::HasSubstr("'lf_foot'")));
}

TEST(CheckTerms, NamesTwoThatContradictEachOther) {
  const auto said = [](double high, PhaseFraction from, PhaseFraction to) {
    MotionProblem problem = test::standing_problem(test::hyq());
    problem.terms = {test::over(test::limit_on("low", frame_position("trunk"), -9.0, 0.7), {0, 0.3}, {0, 0.6}),
                     test::over(test::limit_on("high", frame_position("trunk"), high, 9.0), from, to)};
    try {
      check_terms(problem);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(said(0.75, {0, 0.5}, {0, 0.9}),
            "terms: terms 'low' and 'high' contradict each other: x must be 0.75 m or more, and 0.7 m or less at one "
            "time");
  EXPECT_EQ(said(0.7, {0, 0.5}, {0, 0.9}), "");
  EXPECT_EQ(said(0.75, {0, 0.7}, {0, 0.9}), "");
  EXPECT_NE(said(0.75, {0, 0.6}, {0, 0.6}), "");
}

/// At a phase transition positions are those of both phases, and forces may jump.
TEST(CheckTerms, ComparesBothSidesOfAPhaseTransition) {
  const auto said = [](const std::shared_ptr<const Term>& term, double low, double high, PhaseFraction from) {
    MotionProblem problem = test::standing_problem(test::hyq());
    problem.phases.push_back(problem.phases.front());
    problem.terms = {test::over(test::limit_on("before", term, -9e3, low), {0, 0.5}, PhaseFraction::end_of(0)),
                     test::over(test::limit_on("after", term, high, 9e3), from, PhaseFraction::end_of(1))};
    return contradicting_terms(problem);
  };
  for (const PhaseFraction from : {PhaseFraction::end_of(0), PhaseFraction::start_of(1)}) {
    EXPECT_NE(said(frame_position("trunk"), 0.7, 0.75, from), "");
    EXPECT_EQ(said(contact_force("lf_foot"), 100.0, 200.0, from), "");
  }
  EXPECT_NE(said(contact_force("lf_foot"), 100.0, 200.0, {0, 0.9}), "");
}

TEST(CheckTerms, RefusesTheTimeOfFreeDurations) {
  const auto drift = own_term<4, 1>({{.name = "base"}, {Quantity::Kind::time, ""}}, {"x"}, "m",
                                    [](const auto& y, auto& f) { f(0) = y(0) - 0.1 * y(3); });
  MotionProblem problem = test::standing_problem(test::hyq());
  problem.terms = {whole(test::limit_on("drift", drift, -1.0, 1.0))};
  EXPECT_NO_THROW(check_terms(problem));
  problem.phases[0].duration = {0.5, 1.0};
  try {
    check_terms(problem);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()),
              "terms[0].term: reads the time, which the free duration of phase 'stand' changes; need fixed durations");
  }
}

TEST(CheckTerms, RefusesTwoOfOneName) {
  MotionProblem problem = test::standing_problem(test::hyq());
  problem.terms.assign(2, whole(test::cost_on("centre", center_of_mass(), 1.0, 0.0)));
  EXPECT_THROW(check_terms(problem), InputError);
}

/// What moves on with the robot has no bound that every cycle keeps.
TEST(CheckTerms, RefusesWhatDiffersFromCycleToCycle) {
  const auto said = [](const std::shared_ptr<const Term>& term, int row) {
    MotionProblem problem = test::standing_problem(test::hyq());
    problem.phases.assign(2, problem.phases.front());
    problem.cycle = Cycle{.count = 2, .displacement = {0.3, 0.0, 0.0}};
    TermUse use =
        test::over(test::cost_on("mine", term, 1.0, 0.0), PhaseFraction::start_of(0), PhaseFraction::end_of(1));
    use.weight.setZero();
    use.weight(row, row) = 1.0;
    problem.terms = {use};
    try {
      check_terms(problem);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(said(center_of_mass(), 0),
            "terms[0]: x changes by 0.3 m from cycle to cycle; need a quantity that repeats itself");
  EXPECT_EQ(said(center_of_mass(), 2), "");
  EXPECT_EQ(said(frame_position("lf_foot", "base"), 0), "");
}

/// Forces turn with the robot from cycle to cycle; torques do not.
TEST(CheckTerms, RefusesForcesThatTurnWithTheCycle) {
  const auto said = [](const std::shared_ptr<const Term>& term, double turn) {
    MotionProblem problem = test::standing_problem(test::hyq());
    problem.phases.assign(2, problem.phases.front());
    problem.cycle = Cycle{.count = 2, .turn = turn};
    problem.terms = {
        test::over(test::limit_on("mine", term, -1e4, 1e4), PhaseFraction::start_of(0), PhaseFraction::end_of(1))};
    try {
      check_terms(problem);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(said(contact_force("lf_foot"), 0.4), testing::HasSubstr("N from cycle to cycle"));
  EXPECT_EQ(said(contact_force("lf_foot"), 0.0), "");
  EXPECT_EQ(said(joint_torques(test::hyq(), {0, 1}), 0.4), "");
}

TEST(CheckTerms, RefusesAForceOfAnOpenContact) {
  const auto said = [](double lower) {
    MotionProblem problem = test::standing_problem(test::hyq());
    problem.phases.push_back(problem.phases.front());
    problem.phases[1].name = "swing";
    problem.phases[1].contacts.erase(problem.phases[1].contacts.begin());
    const std::string open = problem.robot.contacts()[problem.phases[0].contacts[0].contact].name;
    problem.terms = {test::over(test::limit_on("push", contact_force(open), lower, 500.0), {1, 0.0}, {1, 1.0})};
    try {
      check_terms(problem);
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(said(50.0), testing::AllOf(testing::StartsWith("terms[0]: in phase 'swing' x is 0 N, as contact "),
                                         testing::HasSubstr("is open, 50 beyond its bound")));
  EXPECT_EQ(said(-50.0), "");
}

TEST(CheckTerms, RefusesASizeThatNoToleranceFits) {
  for (const double size : {-1.0, static_cast<double>(INFINITY), std::nan("")}) {
    const auto height =
        own_term<3, 1>({{.name = "base"}}, {"z"}, "m", [](const auto& y, auto& f) { f(0) = y(2); }, size);
    EXPECT_THAT(complaint(whole(test::limit_on("height", height, 0.0, 9.0))), testing::HasSubstr("a size of "));
  }
}

/// A wrong Jacobian where the first states that are tried have none: the root of a force that pushes.
class WrongRoot : public Term {
 public:
  explicit WrongRoot(const std::string& contact)
      : Term({{.kind = Quantity::Kind::force, .name = contact}}, {"root"}, "-") {}
  void value(const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> f) const override { f(0) = std::sqrt(y(2)); }
  void jacobian(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> f_y) const override {
    f_y(0, 2) = 1.0 / std::sqrt(y(2));
  }
  void hessian(const Eigen::VectorXd& y, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::MatrixXd> f_yy) const override {
    f_yy(2, 2) = -0.25 * multipliers(0) * std::pow(y(2), -1.5);
  }
};

TEST(CheckTerms, ComparesDerivativesWhereTheTermIsDefined) {
  const RobotModel robot = test::hyq();
  for (const ContactPoint& contact : robot.contacts()) {
    EXPECT_THAT(complaint(whole(test::limit_on("root", std::make_shared<WrongRoot>(contact.name), 0.0, 99.0))),
                testing::HasSubstr("the derivative of 'root' with respect to the force of '" + contact.name + "', z"));
  }
}

TEST(CheckTerms, RefusesALimitThatAFixedStartBreaks) {
  const std::string said = complaint(whole(test::limit_on("high", center_of_mass(), 1.0, 9.0)));
  EXPECT_NE(said.find("terms[0]: at the start x is"), std::string::npos) << said;
  EXPECT_NE(said.find("beyond its bound; need another start, or a later moment"), std::string::npos) << said;
}

}  // namespace
}  // namespace prowl
