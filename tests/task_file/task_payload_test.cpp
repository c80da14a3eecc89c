#include "prowl/task_file/task_payload.hpp"

#include <gmock/gmock.h>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/task_test.hpp"

namespace prowl {
namespace {

using testing::HasSubstr;

constexpr double kMass = 5.0;  // [kg]
const Eigen::Vector3d kCenter(0.3, -0.1, 0.2);

class TaskPayload : public test::TaskTest {
 protected:
  std::string with(const std::string& table) { return test::kTaskFile + ("\n[[payload]]\n" + table); }
};

/// Its weight acts at its centre of mass, its inertia where the link moves it.
TEST_F(TaskPayload, IsAMassAtItsPlace) {
  const RobotModel empty = read(test::kTaskFile).problem.robot;
  const RobotModel loaded = read(with("body = \"lf_lowerleg\"\nmass_kg = 5\ncom_m = [0.3, -0.1, 0.2]\n")).problem.robot;
  EXPECT_NEAR(loaded.mass(), empty.mass() + kMass, 1e-12);
  // A contact there moves as the payload does.
  RobotDescription marked = empty.description();
  marked.contacts.push_back({"payload", "lf_lowerleg", 0.0, kCenter});
  const RobotModel mark(marked);
  const int point = mark.contact_index("payload");
  RigidBodyTerms with_it(loaded), without(mark);
  test::RandomStates states(mark, 7);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = states.configuration(), rest = Eigen::VectorXd::Zero(mark.nv());
    with_it.update_with_derivatives(q, rest, rest);
    without.update_with_derivatives(q, rest, rest);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, mark.nv());
    for (const int k : without.contact_chain(point)) {
      const auto column = without.motion_columns().col(k);
      J.col(k) = column.head<3>() + column.tail<3>().cross(without.contact_position(point));
    }
    const Eigen::MatrixXd mass = without.mass_matrix() + kMass * J.transpose() * J;
    EXPECT_LT((with_it.mass_matrix() - mass).norm(), 1e-10 * mass.norm());
    const Eigen::VectorXd weight = J.transpose() * Eigen::Vector3d(0.0, 0.0, kMass * RobotModel::kGravity);
    EXPECT_LT((with_it.inverse_dynamics() - without.inverse_dynamics() - weight).norm(), 1e-9 * weight.norm());
  }
}

TEST_F(TaskPayload, NamesTheNearestLink) {
  EXPECT_THAT(message_of(with("body = \"lf_lowerlegs\"\nmass_kg = 5\n")),
              testing::AllOf(HasSubstr("payload"), HasSubstr("'lf_lowerlegs'"), HasSubstr("'lf_lowerleg'")));
  EXPECT_THAT(message_of(with("body = \"trunk\"\nmass_kg = 0\n")), HasSubstr("mass_kg"));
  EXPECT_THAT(message_of(with("body = \"trunk\"\n")), HasSubstr("mass_kg"));
}

}  // namespace
}  // namespace prowl
