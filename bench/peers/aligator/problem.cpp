#include "problem.hpp"

#include <aligator/modelling/constraints/box-constraint.hpp>
#include <aligator/modelling/constraints/equality-constraint.hpp>
#include <aligator/modelling/constraints/negative-orthant.hpp>
#include <aligator/modelling/costs/quad-residual-cost.hpp>
#include <aligator/modelling/costs/quad-state-cost.hpp>
#include <aligator/modelling/costs/sum-of-costs.hpp>
#include <aligator/modelling/dynamics/integrator-euler.hpp>
#include <aligator/modelling/dynamics/integrator-rk2.hpp>
#include <aligator/modelling/dynamics/integrator-semi-euler.hpp>
#include <aligator/modelling/function-xpr-slice.hpp>
#include <aligator/modelling/linear-function-composition.hpp>
#include <aligator/modelling/multibody/frame-placement.hpp>
#include <aligator/modelling/multibody/frame-translation.hpp>
#include <aligator/modelling/multibody/frame-velocity.hpp>
#include <cmath>
#include <pinocchio/parsers/urdf.hpp>
#include <stdexcept>

#include "contact_dynamics.hpp"

namespace peer {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using nlohmann::json;

using Space = aligator::MultibodyPhaseSpace<double>;
using Function = aligator::StageFunctionTpl<double>;
using Unary = aligator::UnaryFunctionTpl<double>;
using Set = aligator::ConstraintSetTpl<double>;
using Stage = aligator::StageModelTpl<double>;
using Stack = aligator::ConstraintStackTpl<double>;
using Box = aligator::BoxConstraintTpl<double>;
using Equality = aligator::EqualityConstraintTpl<double>;
using AtMostZero = aligator::NegativeOrthantTpl<double>;
using Cost = aligator::CostStackTpl<double>;
using Rows = aligator::FunctionSliceXprTpl<double, Unary>;

// As in Aligator's examples: accuracy, regularisation and iterations of the contact dynamics.
const pinocchio::ProximalSettings kContactSolver(1e-9, 1e-10, 10);

VectorXd vector(const json& entries) {
  VectorXd result(static_cast<Index>(entries.size()));
  for (Index i = 0; i < result.size(); ++i) result(i) = entries[static_cast<std::size_t>(i)].get<double>();
  return result;
}

Eigen::Vector3d vector3(const json& entries) { return vector(entries); }

/// Entries that are numbers, and their rows; null: free.
struct Wanted {
  explicit Wanted(const json& entries, int first_row = 0) : value(VectorXd::Zero(static_cast<Index>(entries.size()))) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (entries[i].is_null()) continue;
      value(static_cast<Index>(i)) = entries[i].get<double>();
      rows.push_back(first_row + static_cast<int>(i));
    }
  }
  VectorXd value;
  std::vector<int> rows;
};

class Builder {
 public:
  explicit Builder(const json& document) : document_(document), model_(read_model(document)), space_(model_) {
    rest_.resize(model_.nq + model_.nv);
    rest_ << vector(document.at("start")), VectorXd::Zero(model_.nv);
  }

  ShootingProblem build() const {
    VectorXd start = rest_;
    start.tail(model_.nv) = vector(document_.at("start_velocity"));
    const json& nodes = document_.at("nodes");
    std::vector<xyz::polymorphic<Stage>> stages;
    Vectors states, inputs;
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      stages.emplace_back(stage(nodes[k]));
      states.push_back(k == 0 ? start : rest_);
      inputs.push_back(vector(nodes[k].at("holding_torque")));
    }
    states.push_back(rest_);
    ShootingProblem result{Problem(start, stages, Cost(space_, num_inputs())), std::move(states), std::move(inputs)};
    add_events(nodes.back(), result.problem.term_cstrs_);
    return result;
  }

 private:
  static pinocchio::Model read_model(const json& document) {
    pinocchio::Model model;
    pinocchio::urdf::buildModel(document.at("urdf").get<std::string>(), pinocchio::JointModelFreeFlyer(), model);
    for (const json& contact : document.at("contacts")) {
      const auto& parent = model.frames.at(model.getFrameId(contact.at("frame").get<std::string>()));
      const pinocchio::SE3 offset(Eigen::Matrix3d::Identity(), vector3(contact.at("offset")));
      model.addFrame(pinocchio::Frame("contact " + contact.at("name").get<std::string>(), parent.parentJoint,
                                      model.getFrameId(parent.name), parent.placement * offset, pinocchio::OP_FRAME));
    }
    return model;
  }

  int num_inputs() const { return model_.nv - 6; }
  int num_state() const { return space_.ndx(); }
  pinocchio::FrameIndex base() const { return 2; }  // the root link, which the free flyer moves
  pinocchio::FrameIndex frame(const json& name) const {
    return model_.getFrameId("contact " + name.get<std::string>());
  }

  Dynamics dynamics(const json& node) const {
    Dynamics::RigidConstraintModelVector contacts;
    for (const json& held : node.at("held")) {
      const auto& at = model_.frames.at(frame(held.at("name")));
      const bool is_anchored = !held.at("anchor").is_null();
      const pinocchio::SE3 anchor(Eigen::Matrix3d::Identity(),
                                  is_anchored ? vector3(held.at("anchor")) : Eigen::Vector3d::Zero());
      contacts.emplace_back(pinocchio::CONTACT_3D, model_, at.parentJoint, at.placement, 0, anchor,
                            pinocchio::LOCAL_WORLD_ALIGNED);
      contacts.back().name = at.name;
      const double damping = node.at("damping").get<double>();
      contacts.back().baumgarte_corrector_parameters().Kp = is_anchored ? damping * damping / 4.0 : 0.0;
      contacts.back().baumgarte_corrector_parameters().Kd = damping;
    }
    MatrixXd actuation = MatrixXd::Zero(model_.nv, num_inputs());
    actuation.bottomRows(num_inputs()).setIdentity();
    return Dynamics(space_, actuation, contacts, kContactSolver);
  }

  xyz::polymorphic<Stage::Dynamics> integrator(const Dynamics& of, double step) const {
    const std::string name = document_.at("integrator");
    if (name == "euler") return aligator::dynamics::IntegratorEulerTpl<double>(of, step);
    if (name == "semi-implicit") return aligator::dynamics::IntegratorSemiImplEulerTpl<double>(of, step);
    if (name == "rk2") return aligator::dynamics::IntegratorRK2Tpl<double>(of, step);
    throw std::invalid_argument("integrator: " + name);
  }

  Stage stage(const json& node) const {
    const double step = node.at("step");
    const Dynamics of = dynamics(node);
    const ContactDynamics solved(of, num_inputs());
    Stage result(cost(solved, step), integrator(of, step));
    add_limits(node, solved, result);
    for (std::size_t i = 0; i < node.at("held").size(); ++i) {
      if (!node["held"][i].at("opens").get<bool>()) continue;
      result.addConstraint(of_forces(solved, i, Eigen::Matrix3d::Identity()), Equality());
    }
    add_events(node, result.constraints_);
    return result;
  }

  Cost cost(const ContactDynamics& solved, double step) const {
    const json& weights = document_.at("cost");
    VectorXd state(num_state()), dynamic = VectorXd::Zero(solved.nr);
    state << vector(weights.at("configuration")), vector(weights.at("velocity"));
    dynamic.head(model_.nv) = vector(weights.at("acceleration"));
    const Eigen::Vector3d force = vector3(weights.at("force"));
    for (Index row = model_.nv; row < dynamic.size(); row += 3) dynamic.segment<3>(row) = force;
    const MatrixXd of_state = state.asDiagonal(), of_dynamics = dynamic.asDiagonal(),
                   of_torque = vector(weights.at("torque")).asDiagonal();
    Cost sum(space_, num_inputs());
    sum.addCost(aligator::QuadraticStateCostTpl<double>(space_, num_inputs(), rest_, of_state), step);
    sum.addCost(aligator::QuadraticControlCostTpl<double>(space_, vector(weights.at("torque_reference")), of_torque),
                step);
    if (dynamic.any()) sum.addCost(aligator::QuadraticResidualCostTpl<double>(space_, solved, of_dynamics), step);
    return sum;
  }

  /// `directions` times the force of a contact that holds.
  Function::Data::MatrixXs rows_of_force(const ContactDynamics& solved, std::size_t i,
                                         const MatrixXd& directions) const {
    MatrixXd rows = MatrixXd::Zero(directions.rows(), solved.nr);
    rows.middleCols<3>(model_.nv + 3 * static_cast<Index>(i)) = directions;
    return rows;
  }
  xyz::polymorphic<Function> of_forces(const ContactDynamics& solved, std::size_t i, const MatrixXd& directions) const {
    return aligator::LinearFunctionCompositionTpl<double>(solved, rows_of_force(solved, i, directions));
  }

  void add_limits(const json& node, const ContactDynamics& solved, Stage& stage) const {
    const VectorXd torque = vector(document_.at("limits").at("torque"));
    stage.addConstraint(aligator::ControlErrorResidualTpl<double>(num_state(), num_inputs()), Box(-torque, torque));

    const std::size_t held = node.at("held").size();
    if (held > 0) {  // four planes inside the cone, and no pull
      Eigen::Matrix3d axes;
      for (Index i = 0; i < 3; ++i) axes.col(i) = vector3(document_.at("ground_axes")[static_cast<std::size_t>(i)]);
      const double slope = document_.at("friction").get<double>() / std::sqrt(2.0);
      MatrixXd planes(5, 3), all(5 * static_cast<Index>(held), solved.nr);
      planes << 1, 0, -slope, -1, 0, -slope, 0, 1, -slope, 0, -1, -slope, 0, 0, -1;
      for (std::size_t i = 0; i < held; ++i)
        all.middleRows<5>(5 * static_cast<Index>(i)) = rows_of_force(solved, i, planes * axes.transpose());
      stage.addConstraint(aligator::LinearFunctionCompositionTpl<double>(solved, all), AtMostZero());
    }
    for (const json& open : node.at("open")) {
      const aligator::FrameTranslationResidualTpl<double> place(num_state(), num_inputs(), model_,
                                                                Eigen::Vector3d::Zero(), frame(open.at("name")));
      stage.addConstraint(aligator::LinearUnaryFunctionCompositionTpl<double>(
                              place, MatrixXd(-Eigen::RowVector3d::UnitZ()), VectorXd::Constant(1, open.at("height"))),
                          AtMostZero());
    }
    if (node.at("joints_bounded")) add_joint_limits(stage);
  }

  void add_joint_limits(Stage& stage) const {
    const json& limits = document_.at("limits");
    const VectorXd speed = vector(limits.at("velocity"));
    VectorXd lower(2 * num_inputs()), upper(2 * num_inputs());
    lower << vector(limits.at("lower")), -speed;
    upper << vector(limits.at("upper")), speed;
    std::vector<int> rows;
    for (int i = 6; i < model_.nv; ++i) rows.push_back(i);
    for (int i = 6; i < model_.nv; ++i) rows.push_back(model_.nv + i);
    stage.addConstraint(Rows(state_error(space_.neutral()), rows), Box(lower, upper));
  }

  aligator::StateErrorResidualTpl<double> state_error(const VectorXd& target) const {
    return {xyz::polymorphic<aligator::ManifoldAbstractTpl<double>>(space_), num_inputs(), target};
  }

  /// Rows of a function of the state that vanish.
  static void hold(xyz::polymorphic<Unary> function, const std::vector<int>& rows, Stack& constraints) {
    if (!rows.empty()) constraints.pushBack(Rows(std::move(function), rows), Equality());
  }

  void hold_place(pinocchio::FrameIndex id, const Wanted& wanted, Stack& constraints) const {
    hold(aligator::FrameTranslationResidualTpl<double>(num_state(), num_inputs(), model_, wanted.value, id),
         wanted.rows, constraints);
  }

  /// What has to hold at this node alone: landings and goals.
  void add_events(const json& node, Stack& constraints) const {
    for (const json& landing : node.at("lands")) {
      const pinocchio::FrameIndex id = frame(landing.at("name"));
      hold_place(id, Wanted(landing.at("place")), constraints);
      hold(aligator::FrameVelocityResidualTpl<double>(num_state(), num_inputs(), model_, pinocchio::Motion::Zero(), id,
                                                      pinocchio::LOCAL_WORLD_ALIGNED),
           {0, 1, 2}, constraints);
    }
    for (const json& goal : node.at("goals")) {
      hold_place(base(), Wanted(goal.at("position")), constraints);
      if (!goal.at("rotation").is_null()) {
        Eigen::Matrix3d rotation;
        for (Index i = 0; i < 3; ++i) rotation.row(i) = vector3(goal["rotation"][static_cast<std::size_t>(i)]);
        std::vector<int> rows;  // of the angular part, which does not depend on the place
        for (const json& axis : goal.at("turn")) rows.push_back(3 + axis.get<int>());
        const pinocchio::SE3 placement(rotation, rest_.head<3>());
        hold(aligator::FramePlacementResidualTpl<double>(num_state(), num_inputs(), model_, placement, base()), rows,
             constraints);
      }
      const Wanted velocity(goal.at("velocity"), model_.nv);
      VectorXd target = rest_;
      target.segment<6>(model_.nq) = velocity.value;
      hold(state_error(target), velocity.rows, constraints);
    }
  }

  const json& document_;
  pinocchio::Model model_;
  Space space_;
  VectorXd rest_;  ///< the start without its velocity
};

}  // namespace

ShootingProblem read_problem(const json& document) { return Builder(document).build(); }

}  // namespace peer
