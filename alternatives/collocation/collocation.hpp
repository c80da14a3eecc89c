#pragma once

#include <memory>
#include <string>
#include <vector>

#include "alternatives/collocation/contact_form.hpp"
#include "alternatives/collocation/dynamics/dynamics_form.hpp"
#include "alternatives/collocation/rules/collocation_rule.hpp"
#include "prowl/transcription/motion_nlp.hpp"

namespace prowl {

/// Choices of a collocation program.
struct CollocationForm {
  std::string dynamics_name;  ///< for messages
  std::unique_ptr<DynamicsForm> dynamics;
  std::unique_ptr<CollocationRule> rule;
  ContactForm contact;
  std::unique_ptr<BaseChart> chart;
};

/// A motion problem by collocation in coordinates of one chart, with exchangeable dynamics, rule,
/// contacts and chart. Written for comparison: Transcription equals one choice of these, and is several
/// times faster.
///
/// z: per node (x | v | a, if a variable | tau | forces, if variables), followed by the variables in
///    the middle of its interval, if the rule has any (x | v | a | tau | forces); at the end durations
///    and footholds as in DecisionLayout.
/// g: rows of each node, rows of the rule per interval, continuity of x and v per phase transition.
class Collocation : public MotionNlp {
 public:
  /// Throws InputError for incompatible choices, steps too long for the rule's gains, goals on a
  /// part of the base rotation (not expressible in a common chart), or redundant contacts if forces
  /// are variables or contacts are not stabilised.
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
  /// An entry of a piece's Hessian and its index among the values of the whole Hessian.
  struct HessianEntry {
    int row, col, index;
  };

  ChartedNode& charted(int k) const { return *charted_[phase_of(k)]; }
  bool has_acceleration() const { return !form_.dynamics->eliminates_acceleration(); }
  /// Number of variables of a node, or of a middle with or without state.
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
  std::vector<std::unique_ptr<ChartedNode>> charted_;  ///< per phase
  std::vector<int> node_first_, middle_first_;         ///< first variable of a node; of the middle after it, -1 without
  std::vector<int> durations_, footholds_;             ///< per phase, per stance; -1 without
  std::vector<std::unique_ptr<NodePiece>> nodes_;
  std::vector<std::unique_ptr<IntervalPiece>> intervals_;  ///< null at a phase transition
  int first_transition_row_ = 0;
  HessianKind hessian_kind_ = HessianKind::exact;
};

}  // namespace prowl
