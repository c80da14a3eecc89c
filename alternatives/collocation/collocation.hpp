#pragma once

#include <memory>
#include <string>
#include <vector>

#include "alternatives/collocation/contact_form.hpp"
#include "alternatives/collocation/dynamics/dynamics_form.hpp"
#include "alternatives/collocation/rules/collocation_rule.hpp"
#include "prowl/transcription/motion_nlp.hpp"

namespace prowl {

/// The choices of a collocation program.
struct CollocationForm {
  std::string dynamics_name;  ///< for messages
  std::unique_ptr<DynamicsForm> dynamics;
  std::unique_ptr<CollocationRule> rule;
  ContactForm contact;
  std::unique_ptr<BaseChart> chart;
};

/// A motion problem by collocation in coordinates of one chart, from parts that can be exchanged: dynamics, rule,
/// contacts and chart. Written for comparison, not for speed: Transcription is the same for one choice of them, and
/// several times faster.
///
/// z: for each node (x | v | a, where it is a variable | tau | forces, where they are variables), after each but the
/// last of a phase
///    the variables in the middle of its interval, if the rule has any (x | v | a | tau | forces); at the end durations
///    and places as in DecisionLayout.
/// g: for each node its rows, for each interval those of the rule, for each phase switch continuity of x and v.
class Collocation : public MotionNlp {
 public:
  /// Throws InputError if the choices do not go together, if steps are too long for the rule's gains, if the problem
  /// binds the base's rotation in part (a chart for all nodes has no bounds for that), or if contacts depend on each
  /// other and forces are variables or contacts are not stabilised.
  Collocation(const DiscreteProblem& discrete, const Trajectory& guess, CollocationForm form);
  ~Collocation() override;

  Eigen::VectorXd pack(const Trajectory& trajectory) const override;
  Trajectory unpack(const Eigen::VectorXd& z) override;
  void use_hessian(HessianKind kind) override;

  double cost(const Eigen::VectorXd& z) override;
  void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) override;
  void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override;
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) override;
  void hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override;

  std::string describe_constraint(int row) const override;
  std::string describe_variable(int index) const override;

 private:
  struct NodePiece;
  struct IntervalPiece;
  /// An entry of a piece's Hessian, and where it goes among the values of the whole.
  struct HessianPlace {
    int row, col, place;
  };

  ChartedNode& charted(int k) const { return *charted_[phase_of(k)]; }
  bool has_acceleration() const { return !form_.dynamics->eliminates_acceleration(); }
  /// Variables of a node (or of a middle, with or without its state).
  int point_size(int k, bool state) const;
  std::vector<int> columns(int first, int size) const;
  std::vector<int> shared_columns(int k) const;
  StepSize step(int k, int first_shared) const;

  void make_layout();
  void make_node(int k);
  void make_interval(int k);
  void set_bounds(const Trajectory& guess);
  void set_rows();
  void set_patterns();
  IntervalProgram::Point variables(ProgramGraph& graph, int k, int first, bool state) const;
  void write_point(const TrajectoryPoint& point, int k, int first, bool state, const Eigen::Vector3d& near,
                   Eigen::VectorXd& z) const;
  void evaluate_all(const Eigen::VectorXd& z, bool with_derivatives) override;
  template <class Visit>
  void for_each_piece(Visit visit) const;

  CollocationForm form_;
  std::vector<std::unique_ptr<ChartedNode>> charted_;  ///< one a phase
  std::vector<int> node_first_, middle_first_;         ///< variables; of the interval after a node, -1 without
  std::vector<int> durations_, places_;                ///< of phases and stances; -1 where there is none
  std::vector<std::unique_ptr<NodePiece>> nodes_;
  std::vector<std::unique_ptr<IntervalPiece>> intervals_;  ///< null at a phase switch
  int first_switch_row_ = 0;
  HessianKind hessian_kind_ = HessianKind::exact;
};

}  // namespace prowl
