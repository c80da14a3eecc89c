#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <mutex>
#include <numeric>

#include "batch.hpp"
#include "bindings.hpp"
#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/nlp/thread_team.hpp"
#include "prowl/session/plan_task.hpp"
#include "signals.hpp"

namespace prowl::python {
namespace {

/// First derivatives of one quantity in each of its arguments.
struct Derivatives {
  std::optional<Array> q, v, a, tau;
};

/// Result of forward() and residual(): `value` is the acceleration or the residual.
struct Evaluation {
  Array value, force;
  std::optional<Derivatives> value_derivatives, force_derivatives;
};

/// prowl.Dynamics: for one or many states, with work space per thread.
class Dynamics {
 public:
  Dynamics(const RobotModel& robot, const std::optional<std::vector<std::string>>& contacts, int threads)
      : robot_(robot), team_(checked(threads)) {
    if (contacts) {
      for (const std::string& name : *contacts) contacts_.push_back(robot_.contact_index(name));
    } else {
      contacts_.resize(robot_.contacts().size());
      std::iota(contacts_.begin(), contacts_.end(), 0);
    }
    for (int i = 0; i < threads; ++i) {
      forward_.emplace_back(robot_, contacts_);
      inverse_.emplace_back(robot_, contacts_);
      terms_.emplace_back(robot_);
    }
  }

  std::vector<std::string> contact_names() const {
    std::vector<std::string> names;
    for (const int c : contacts_) names.push_back(robot_.contacts()[c].name);
    return names;
  }

  Evaluation forward(const Argument& q_array, const Argument& v_array, const Argument& tau_array, bool derivatives) {
    const Batch q(q_array, robot_.nq(), "q"), v(v_array, robot_.nv(), "v"), tau(tau_array, robot_.nu(), "tau");
    check_same_rows(q, {{"v", &v}, {"tau", &tau}});
    check_configurations(q, "q");
    Results a(q, {nv()}), f(q, {count(), 3});
    std::optional<Jacobians> da, df;
    if (derivatives) {
      da.emplace(*this, q, std::vector{nv()});
      df.emplace(*this, q, std::vector{count(), std::size_t{3}});
    }
    for_each(q.rows(), [&](int i) {
      ForwardDynamics& dynamics = forward_[ThreadTeam::slot()];
      if (derivatives) {
        dynamics.evaluate_with_derivatives(q.row(i), v.row(i), tau.row(i));
        da->set(i, dynamics.acceleration_derivatives());
        df->set(i, dynamics.force_derivatives());
      } else {
        dynamics.evaluate(q.row(i), v.row(i), tau.row(i));
      }
      a.set(i, dynamics.acceleration());
      f.set(i, dynamics.forces());
    });
    return {std::move(a).array(), std::move(f).array(), arrays(da, false), arrays(df, false)};
  }

  Evaluation residual(const Argument& q_array, const Argument& v_array, const Argument& a_array,
                      const Argument& tau_array, bool derivatives) {
    const Batch q(q_array, robot_.nq(), "q"), v(v_array, robot_.nv(), "v"), a(a_array, robot_.nv(), "a"),
        tau(tau_array, robot_.nu(), "tau");
    check_same_rows(q, {{"v", &v}, {"a", &a}, {"tau", &tau}});
    check_configurations(q, "q");
    Results c(q, {nv()}), f(q, {count(), 3});
    std::optional<Jacobians> dc, df;
    if (derivatives) {
      dc.emplace(*this, q, std::vector{nv()});
      df.emplace(*this, q, std::vector{count(), std::size_t{3}});
    }
    const Eigen::VectorXd no_anchors = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(count()));
    for_each(q.rows(), [&](int i) {
      ProjectedResidual& dynamics = inverse_[ThreadTeam::slot()];
      const DynamicsPoint point{q.row(i), v.row(i), a.row(i), tau.row(i), no_anchors, {}, {}};
      if (derivatives) {
        dynamics.evaluate_with_derivatives(point);
        dc->set(i, dynamics.residual_derivatives());
        df->set(i, dynamics.force_derivatives());
      } else {
        dynamics.evaluate(point);
      }
      c.set(i, dynamics.residual());
      f.set(i, dynamics.forces());
    });
    return {std::move(c).array(), std::move(f).array(), arrays(dc, true), arrays(df, true)};
  }

  Array mass_matrix(const Argument& q_array) {
    const Batch q = configurations(q_array);
    Results M(q, {nv(), nv()});
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(robot_.nv());
    for_each(q.rows(), [&](int i) {
      RigidBodyTerms& terms = this->terms();
      terms.update_with_derivatives(q.row(i), zero, zero);
      M.set(i, terms.mass_matrix());
    });
    return std::move(M).array();
  }

  Array bias(const Argument& q_array, const Argument& v_array) {
    const Batch q = configurations(q_array), v(v_array, robot_.nv(), "v");
    check_same_rows(q, {{"v", &v}});
    Results h(q, {nv()});
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(robot_.nv());
    for_each(q.rows(), [&](int i) {
      RigidBodyTerms& terms = this->terms();
      terms.update(q.row(i), v.row(i), zero);
      h.set(i, terms.inverse_dynamics());
    });
    return std::move(h).array();
  }

  Array contact_positions(const Argument& q_array) {
    const Batch q = configurations(q_array);
    Results p(q, {count(), 3});
    for_each(q.rows(), [&](int i) {
      ContactKinematics kinematics(contacts_);
      terms().update_kinematics(q.row(i));
      kinematics.set_configuration(terms());
      p.set(i, kinematics.positions());
    });
    return std::move(p).array();
  }

  Array contact_acceleration(const Argument& q_array, const Argument& v_array, const Argument& a_array) {
    const Batch q = configurations(q_array), v(v_array, robot_.nv(), "v"), a(a_array, robot_.nv(), "a");
    check_same_rows(q, {{"v", &v}, {"a", &a}});
    Results g(q, {count(), 3});
    for_each(q.rows(), [&](int i) {
      ContactKinematics kinematics(contacts_);
      terms().update_kinematics(q.row(i));
      kinematics.set_configuration(terms());
      kinematics.set_motion(v.row(i), a.row(i));
      g.set(i, kinematics.acceleration());
    });
    return std::move(g).array();
  }

  std::vector<std::vector<std::string>> contact_joints() const {
    std::vector<std::vector<std::string>> joints(count());
    for (std::size_t c = 0; c < count(); ++c) {
      for (const int dof : terms_.front().contact_chain(contacts_[c])) {
        if (dof >= 6) joints[c].push_back(robot_.joint_names()[dof - 6]);
      }
    }
    return joints;
  }

  Array contact_jacobian(const Argument& q_array) {
    const Batch q = configurations(q_array);
    Results J(q, {count(), 3, nv()});
    for_each(q.rows(), [&](int i) {
      ContactKinematics kinematics(contacts_);
      terms().update_kinematics(q.row(i));
      kinematics.set_configuration(terms());
      J.set(i, kinematics.jacobian());
    });
    return std::move(J).array();
  }

 private:
  /// Derivatives of a quantity of the given shape for all rows of a batch.
  struct Jacobians {
    Jacobians(const Dynamics& d, const Batch& batch, const std::vector<std::size_t>& shape)
        : q(batch, with(shape, d.nv())),
          v(batch, with(shape, d.nv())),
          a(batch, with(shape, d.nv())),
          tau(batch, with(shape, d.nv() - 6)) {}
    static std::vector<std::size_t> with(std::vector<std::size_t> shape, std::size_t columns) {
      shape.push_back(columns);
      return shape;
    }
    void set(int i, const ForwardDynamics::Derivatives& d) {
      q.set(i, d.q);
      v.set(i, d.v);
      tau.set(i, d.tau);
    }
    void set(int i, const PointDerivatives& d) {
      q.set(i, d.q);
      v.set(i, d.v);
      a.set(i, d.a);
      tau.set(i, d.tau);
    }
    Results q, v, a, tau;
  };
  static std::optional<Derivatives> arrays(std::optional<Jacobians>& d, bool in_acceleration) {
    if (!d) return std::nullopt;
    std::optional<Array> a;
    if (in_acceleration) a = std::move(d->a).array();
    return Derivatives{std::move(d->q).array(), std::move(d->v).array(), std::move(a), std::move(d->tau).array()};
  }

  static int checked(int threads) {
    if (threads >= 1 && threads <= kMostThreads) return threads;
    throw InputError(fmt::format("threads: {} is not allowed; need 1 to {}", threads, kMostThreads));
  }
  std::size_t nv() const { return static_cast<std::size_t>(robot_.nv()); }
  std::size_t count() const { return contacts_.size(); }
  RigidBodyTerms& terms() { return terms_[ThreadTeam::slot()]; }
  Batch configurations(const Argument& q_array) const {
    const Batch q(q_array, robot_.nq(), "q");
    check_configurations(q, "q");
    return q;
  }

  /// Releases the GIL; one call at a time, as calls share work space.
  template <class Function>
  void for_each(Eigen::Index rows, const Function& function) {
    const nb::gil_scoped_release others_may_run;
    const std::lock_guard lock(busy_);
    constexpr Eigen::Index kRows = 4096;  // between checks for Ctrl-C
    for (Eigen::Index first = 0; first < rows; first += kRows) {
      if (first > 0) check_signals();
      team_.for_each(static_cast<int>(std::min(kRows, rows - first)),
                     [&](int i) { function(static_cast<int>(first) + i); });
    }
  }

  RobotModel robot_;
  ThreadTeam team_;
  std::vector<int> contacts_;
  std::vector<ForwardDynamics> forward_;
  std::vector<ProjectedResidual> inverse_;
  std::vector<RigidBodyTerms> terms_;
  std::mutex busy_;
};

Array integrate_rows(const Argument& q_array, const Argument& tangent_array) {
  const auto nv = static_cast<Eigen::Index>(tangent_array.ndim() ? tangent_array.shape(tangent_array.ndim() - 1) : 0);
  const Batch tangent(tangent_array, std::max<Eigen::Index>(nv, 6), "tangent"),
      q(q_array, std::max<Eigen::Index>(nv, 6) + 1, "q");
  check_same_rows(q, {{"tangent", &tangent}});
  check_configurations(q, "q");
  Results sum(q, {static_cast<std::size_t>(nv) + 1});
  for (Eigen::Index i = 0; i < q.rows(); ++i) sum.set(i, integrate(q.row(i), tangent.row(i)));
  return std::move(sum).array();
}

Array difference_rows(const Argument& from_array, const Argument& to_array) {
  const auto nq = static_cast<Eigen::Index>(from_array.ndim() ? from_array.shape(from_array.ndim() - 1) : 0);
  const Batch from(from_array, std::max<Eigen::Index>(nq, 7), "q"), to(to_array, std::max<Eigen::Index>(nq, 7), "q_to");
  check_same_rows(from, {{"q_to", &to}});
  check_configurations(from, "q");
  check_configurations(to, "q_to");
  Results tangent(from, {static_cast<std::size_t>(nq) - 1});
  for (Eigen::Index i = 0; i < from.rows(); ++i) tangent.set(i, difference(from.row(i), to.row(i)));
  return std::move(tangent).array();
}

}  // namespace

void bind_dynamics(nb::module_& module) {
  constexpr auto kKept = nb::rv_policy::reference;  // arrays own their memory
  nb::class_<Derivatives>(
      module, "Derivatives",
      "First derivatives of one quantity: its shape with one more axis at the end. In q they refer to the\n"
      "tangent of integrate(): displacement of the base in the WORLD, rotation vector in the base frame, joints.")
      .def_ro("q", &Derivatives::q, kKept, "(..., nv)")
      .def_ro("v", &Derivatives::v, kKept, "(..., nv)")
      .def_ro("a", &Derivatives::a, kKept, "(..., nv); None if the function has no such argument.")
      .def_ro("tau", &Derivatives::tau, kKept, "(..., nu)");
  nb::class_<Evaluation>(module, "Evaluation",
                         "Result of Dynamics at one state, or at N states with a first axis of N.")
      .def_ro("value", &Evaluation::value, kKept, "The acceleration or the residual, (nv).")
      .def_ro("force", &Evaluation::force, kKept, "Contact forces on the robot, (contacts, 3), world axes [N].")
      .def_ro("value_derivatives", &Evaluation::value_derivatives, "None unless requested.")
      .def_ro("force_derivatives", &Evaluation::force_derivatives, "None unless requested.");
  nb::class_<Dynamics>(
      module, "Dynamics",
      "Projected dynamics of a robot with contacts in stance (docs/theory.md), for one or many states: q (nq) or (N, "
      "nq),\n"
      "v and a (nv) or (N, nv), tau (nu) or (N, nu). Conventions: see Robot. Releases the GIL; one object\n"
      "serves one call at a time.\n\n"
      "contacts: names, possibly none or redundant ones (then forces have least norm); None: all of the robot.\n"
      "threads: share the rows; results do not depend on it.")
      .def(nb::init<const RobotModel&, const std::optional<std::vector<std::string>>&, int>(), nb::arg("robot"),
           nb::arg("contacts").none() = nb::none(), nb::arg("threads") = 1)
      .def_prop_ro("contact_names", &Dynamics::contact_names, "Names in the order of the forces.")
      .def("forward", &Dynamics::forward, nb::arg("q"), nb::arg("v"), nb::arg("tau"), nb::arg("derivatives") = false,
           "Accelerations and contact forces caused by torques: value is a (nv), rates of the components of v [m/s^2, "
           "rad/s^2].")
      .def("residual", &Dynamics::residual, nb::arg("q"), nb::arg("v"), nb::arg("a"), nb::arg("tau"),
           nb::arg("derivatives") = false,
           "Inverse form: value is c (nv) [N, N m], zero if and only if (q, v, a, tau) obeys the dynamics with these "
           "contacts.")
      .def("mass_matrix", &Dynamics::mass_matrix, nb::arg("q"), "M(q), (nv, nv) [kg, kg m, kg m^2].")
      .def("bias", &Dynamics::bias, nb::arg("q"), nb::arg("v"),
           "h(q, v), (nv) [N, N m]: Coriolis, centrifugal and gravity forces; M a + h = S' tau + J' f.")
      .def("contact_positions", &Dynamics::contact_positions, nb::arg("q"),
           "Positions in the world, (contacts, 3) [m].")
      .def("contact_jacobian", &Dynamics::contact_jacobian, nb::arg("q"),
           "J, (contacts, 3, nv): velocity of the contact points in the world is J v [m/s].")
      .def("contact_acceleration", &Dynamics::contact_acceleration, nb::arg("q"), nb::arg("v"), nb::arg("a"),
           "J a + Jdot v, (contacts, 3): acceleration of the contact points in the world [m/s^2].")
      .def_prop_ro("contact_joints", &Dynamics::contact_joints,
                   "Per contact, names of the joints that move it, from the base to the tip.");
  module.def(
      "integrate", &integrate_rows, nb::arg("q"), nb::arg("tangent"),
      "q moved by a tangent (nv): displacement of the base in the WORLD [m], rotation vector in the base frame [rad],\n"
      "joints. One of each, or N rows.");
  module.def("difference", &difference_rows, nb::arg("q"), nb::arg("q_to"),
             "The tangent (nv) that moves q to q_to, see integrate(). One of each, or N rows.");
}

}  // namespace prowl::python
