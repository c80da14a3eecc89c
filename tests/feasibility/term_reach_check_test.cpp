#include "prowl/feasibility/term_reach_check.hpp"

#include <gmock/gmock.h>

#include "tests/support/standing_problem.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// HyQ stands for a second with its base free, and one link or two are to be at points in part of that time.
struct Wish {
  std::string name, frame;
  Vector3d point;
  PhaseFraction from, to;
};

std::vector<std::string> said(const std::vector<Wish>& wishes, bool has_contacts = false) {
  MotionProblem problem = test::standing_problem(test::hyq());
  if (!has_contacts) problem.phases[0].contacts.clear();
  for (const Wish& wish : wishes) {
    TermUse use = test::over(test::limit_on(wish.name, frame_position(wish.frame), 0.0, 0.0), wish.from, wish.to);
    use.lower = use.upper = wish.point;
    problem.terms.push_back(use);
  }
  return terms_out_of_reach(problem, ContactSchedule(problem));
}

TEST(TermReachCheck, NamesTwoLinksThatAreTooFarApart) {
  const Wish one{"left", "lf_foot", {0.4, 0.3, 0.0}, {0, 0.2}, {0, 0.6}};
  const auto other = [](double x, PhaseFraction from, PhaseFraction to) {
    return Wish{"right", "rf_foot", {x, -0.3, 0.0}, from, to};
  };
  EXPECT_THAT(said({one, other(3.0, {0, 0.6}, {0, 0.8})}),
              ElementsAre(testing::AllOf(HasSubstr("term 'right' and term 'left' exclude each other"),
                                         HasSubstr("2.67 m or more apart"))));
  EXPECT_THAT(said({one, other(0.5, {0, 0.6}, {0, 0.8})}), IsEmpty());
  EXPECT_THAT(said({one, other(3.0, {0, 0.7}, {0, 0.8})}), IsEmpty()) << "not at one time";
}

TEST(TermReachCheck, NamesContactAndGoal) {
  const Wish far{"far", "trunk", {4.0, 0.0, 0.6}, {0, 0.5}, {0, 0.5}},
      near{"near", "trunk", {0.1, 0.0, 0.6}, {0, 0.5}, {0, 0.5}};
  EXPECT_THAT(said({far}, true),
              ElementsAre(testing::AllOf(HasSubstr("term 'far' and contact"), HasSubstr("in phase 'stand'"))));
  EXPECT_THAT(said({near}, true), IsEmpty());
  EXPECT_THAT(said({far}), IsEmpty()) << "nothing holds it in the air";
  const Wish at_start{"at the start", "lf_foot", {4.0, 0.0, 0.0}, {0, 0.0}, {0, 0.0}};
  EXPECT_THAT(said({at_start}), ElementsAre(HasSubstr("the base at the start")));
}

}  // namespace
}  // namespace prowl
