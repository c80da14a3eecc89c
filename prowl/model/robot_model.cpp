#include "prowl/model/robot_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/parsers/urdf.hpp>
#include <set>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/description_error.hpp"
#include "prowl/model/locked_joints.hpp"
#include "prowl/model/physical_inertia.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "prowl/model/urdf/urdf_check.hpp"
#include "prowl/text/nearest_name.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {

namespace {

constexpr auto kLinkOrFixedJoint = static_cast<pinocchio::FrameType>(pinocchio::BODY | pinocchio::FIXED_JOINT);
const char* const kWorldFrame = "universe";
constexpr std::uintmax_t kLargestUrdf = 4u << 20;  // [bytes]; the largest known are below 1 MB

std::string read_text(const std::filesystem::path& path) {
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(path, error);  // first: opening a pipe may block for ever
  std::ifstream stream;
  if (is_file) stream.open(path, std::ios::binary);
  if (!is_file || !stream) {
    throw FileError(fmt::format("{}: cannot be read; expected a URDF file", path.string()));
  }
  if (std::filesystem::file_size(path, error) > kLargestUrdf) {
    throw InputError(fmt::format("{}: more than {} bytes; expected a URDF file", path.string(), kLargestUrdf));
  }
  std::string text(std::istreambuf_iterator<char>(stream), {});
  if (stream.bad()) throw FileError(fmt::format("{}: cannot be read to its end", path.string()));
  return text;
}

/// Throws DescriptionError unless `name` is one of the joints; `field` is its table in the robot file.
Eigen::Index joint_index(const RobotDescription& description, const std::vector<std::string>& joints,
                         const std::string& field, const std::string& name) {
  const auto joint = std::find(joints.begin(), joints.end(), name);
  if (joint == joints.end()) {
    throw DescriptionError(field + "." + name,
                           fmt::format("robot '{}': {}: '{}' is not a joint of {}{}", description.name, field,
                                       shown(name), description.urdf.string(), did_you_mean(name, joints)));
  }
  return joint - joints.begin();
}

/// Those of locked joints do not move.
void set_armature(const RobotDescription& description, pinocchio::Model& model) {
  const std::vector<std::string> joints = moving_joints(model);
  for (const auto& [name, inertia] : description.armature) {
    if (is_locked(description, name)) continue;
    const Eigen::Index j = joint_index(description, joints, "armature", name);
    if (!(inertia >= 0.0) || !std::isfinite(inertia)) {
      throw DescriptionError("armature." + name, fmt::format("robot '{}': armature.{}: {} is not allowed; need >= 0",
                                                             description.name, name, inertia));
    }
    model.armature(6 + j) = inertia;
  }
}

/// The link of that name or, if there is none, the fixed joint; no frame that Pinocchio adds itself.
std::optional<pinocchio::FrameIndex> find_frame(const pinocchio::Model& model, const std::string& name) {
  for (const pinocchio::FrameType type : {pinocchio::BODY, pinocchio::FIXED_JOINT}) {
    if (name != kWorldFrame && model.existFrame(name, type)) return model.getFrameId(name, type);
  }
  return std::nullopt;
}

void add_payloads(const RobotDescription& description, pinocchio::Model& model) {
  for (const Payload& payload : description.payloads) {
    const auto frame = find_frame(model, payload.body);
    if (!frame || !(payload.mass >= 0.0) || !std::isfinite(payload.mass) || !payload.center.allFinite()) {
      throw InputError(fmt::format("robot '{}': payload of {} kg on '{}': need a link of the URDF, and finite numbers",
                                   description.name, payload.mass, shown(payload.body)));
    }
    const pinocchio::Inertia point(payload.mass, payload.center, Eigen::Matrix3d::Zero());
    model.inertias[model.frames[*frame].parentJoint] += model.frames[*frame].placement.act(point);
  }
}

void read_urdf(RobotDescription& description, PinocchioModel& pin) {
  if (description.urdf_text.empty()) description.urdf_text = read_text(description.urdf);
  pin.urdf = check_urdf(description.urdf.string(), description.urdf_text, description.locked_joints);
  try {
    pinocchio::urdf::buildModelFromXML(description.urdf_text, pinocchio::JointModelFreeFlyer(), pin.model);
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: Pinocchio cannot build this robot: {}", description.urdf.string(), error.what()));
  }
  lock_joints(description, pin);
  set_armature(description, pin.model);
  add_payloads(description, pin.model);
}

/// Links joined by fixed joints move as one body; the inertia of that body matters, not that of each link. One without
/// an inertia of its own, as between the axes of a hip, serves if it always moves others with it.
void check_bodies(const RobotDescription& description, const pinocchio::Model& model) {
  std::optional<std::vector<std::string>> massless;
  for (pinocchio::JointIndex joint = kBaseJoint; joint < model.joints.size(); ++joint) {
    const pinocchio::Inertia& body = model.inertias[joint];
    const auto problem = why_not_physical(body.mass(), body.inertia().matrix());
    if (!problem) continue;
    if (joint != kBaseJoint && lacks_inertia(body.mass(), body.inertia().matrix())) {
      if (!massless) massless = find_massless_joints(model);
      if (massless->empty()) continue;
      throw InputError(
          fmt::format("{}: {} a body that has no inertia, and others do not make up for it; need inertias in the "
                      "URDF, or the names in locked_joints of the robot file",
                      description.urdf.string(),
                      massless->size() == 1 ? fmt::format("joint '{}' moves", massless->front())
                                            : fmt::format("joints {} each move", fmt::join(*massless, ", "))));
    }
    std::vector<std::string> links;
    for (const pinocchio::Frame& frame : model.frames) {
      if (frame.type == pinocchio::BODY && frame.parentJoint == joint) links.push_back(frame.name);
    }
    throw InputError(fmt::format("{}: body moved by {} (links {}): {}", description.urdf.string(),
                                 joint == kBaseJoint ? "the floating base" : "joint '" + model.names[joint] + "'",
                                 fmt::join(links, ", "), *problem));
  }
}

std::vector<std::string> link_names(const pinocchio::Model& model) {
  std::vector<std::string> names;
  for (const pinocchio::Frame& frame : model.frames) {
    if ((frame.type & kLinkOrFixedJoint) != 0 && frame.name != kWorldFrame) names.push_back(frame.name);
  }
  return names;
}

std::vector<pinocchio::FrameIndex> add_contact_frames(const RobotDescription& description,
                                                      const std::vector<std::string>& mimics, pinocchio::Model& model) {
  const std::vector<std::string> links = link_names(model);
  std::vector<pinocchio::FrameIndex> frames;
  std::set<std::string> names;
  for (std::size_t i = 0; i < description.contacts.size(); ++i) {
    const ContactPoint& contact = description.contacts[i];
    const auto refuse = [&](const std::string& why) {
      throw DescriptionError(fmt::format("contact[{}].frame", i),
                             fmt::format("robot '{}': contact '{}': {}", description.name, contact.name, why));
    };
    if (contact.name.empty() || !names.insert(contact.name).second)
      refuse("the name of a contact must be unique and not empty");
    const std::optional<pinocchio::FrameIndex> found = find_frame(model, contact.frame);
    if (!found) {
      refuse(fmt::format("frame '{}' is not a link or fixed joint of {}{}", shown(contact.frame),
                         description.urdf.string(), did_you_mean(contact.frame, links)));
    }
    if (!(contact.radius >= 0.0) || !std::isfinite(contact.radius)) {
      refuse(fmt::format("radius {} is not allowed; need radius >= 0 [m]", contact.radius));
    }
    if (!contact.offset.allFinite()) refuse("offset must be three finite numbers [m]");
    const pinocchio::FrameIndex frame = *found;
    for (pinocchio::FrameIndex above = frame; above != 0; above = model.frames[above].parentFrame) {
      if (std::ranges::find(mimics, model.frames[above].name) == mimics.end()) continue;
      refuse(
          fmt::format("it moves with joint '{}', which copies another: Prowl locks such joints; need one actuator a "
                      "joint between the base and a contact",
                      model.frames[above].name));
    }
    if (contact.offset.isZero(0.0)) {
      frames.push_back(frame);
      continue;
    }
    const pinocchio::Frame& link = model.frames[frame];
    const pinocchio::SE3 offset(Eigen::Matrix3d::Identity(), contact.offset);
    frames.push_back(model.addFrame(
        {"contact " + contact.name, link.parentJoint, frame, link.placement * offset, pinocchio::OP_FRAME}));
  }
  return frames;
}

void check_limits(const RobotModel& robot) {
  for (int j = 0; j < robot.nu(); ++j) {
    const std::string& joint = robot.joint_names()[j];
    const auto own = robot.description().limits.find(joint);
    const JointLimits limits = own == robot.description().limits.end() ? JointLimits() : own->second;
    const auto refuse = [&](bool is_own, const std::string& found, const std::string& expected) {
      throw DescriptionError(
          is_own ? "limits." + joint : "urdf",
          fmt::format("{}: joint '{}': {} is not allowed; need {} (in the URDF, or in limits.{} of the robot)",
                      robot.description().urdf.string(), joint, found, expected, joint));
    };
    const double lower = robot.position_lower()(j), upper = robot.position_upper()(j);
    const double velocity = robot.velocity_limit()(j), torque = robot.torque_limit()(j);
    if (!(lower < upper))
      refuse(limits.position_lower || limits.position_upper, fmt::format("position from {} to {}", lower, upper),
             "lower < upper");
    if (!(velocity > 0.0))
      refuse(limits.velocity.has_value(), fmt::format("velocity limit {}", velocity), "velocity > 0");
    if (!(torque > 0.0))
      refuse(limits.torque.has_value(), fmt::format("torque limit (effort) {}", torque), "effort > 0");
  }
}

/// Places the base so that the lowest contact ball touches z = 0 and the mean of the contact points is at x = y = 0.
void put_on_ground(const PinocchioModel& pin, const std::vector<ContactPoint>& contacts, Eigen::VectorXd& q) {
  if (contacts.empty()) return;
  pinocchio::Data data(pin.model);
  pinocchio::framesForwardKinematics(pin.model, data, q);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Eigen::Vector3d& p = data.oMf[pin.contact_frames[c]].translation();
    mean += p / static_cast<double>(contacts.size());
    lowest = std::min(lowest, p.z() - contacts[c].radius);
  }
  q.head<3>() -= Eigen::Vector3d(mean.x(), mean.y(), lowest);
}

double distance_of_contacts(const PinocchioModel& pin, const Eigen::VectorXd& q) {
  if (pin.contact_frames.empty()) return 1.0;
  pinocchio::Data data(pin.model);
  pinocchio::framesForwardKinematics(pin.model, data, q);
  double squares = 0.0;
  for (const pinocchio::FrameIndex frame : pin.contact_frames) {
    squares += (data.oMf[frame].translation() - q.head<3>()).squaredNorm();
  }
  constexpr double kSmallest = 0.01;  // [m]; a scale must not vanish
  return std::max(kSmallest, std::sqrt(squares / static_cast<double>(pin.contact_frames.size())));
}

}  // namespace

std::vector<std::string> massless_joints(RobotDescription description) {
  PinocchioModel pin;
  read_urdf(description, pin);
  return find_massless_joints(pin.model);
}

RobotModel::RobotModel(RobotDescription description) : description_(std::move(description)) {
  auto pin = std::make_unique<PinocchioModel>();
  read_urdf(description_, *pin);
  check_bodies(description_, pin->model);
  pin->contact_frames = add_contact_frames(description_, pin->urdf.mimics, pin->model);
  const pinocchio::Model& model = pin->model;

  for (pinocchio::JointIndex joint = kBaseJoint; joint < model.joints.size(); ++joint) {
    mass_ += model.inertias[joint].mass();
  }
  joint_names_ = moving_joints(model);
  for (pinocchio::JointIndex joint = kBaseJoint + 1; joint < model.joints.size(); ++joint) {
    joint_is_prismatic_.push_back(model.joints[joint].shortname().starts_with("JointModelP"));
  }
  position_lower_ = model.lowerPositionLimit.tail(nu());
  position_upper_ = model.upperPositionLimit.tail(nu());
  velocity_limit_ = model.upperVelocityLimit.tail(nu());
  torque_limit_ = model.upperEffortLimit.tail(nu());
  losses_ = {model.damping.tail(nu()), model.upperDryFrictionLimit.tail(nu())};
  for (const auto& [name, limits] : description_.limits) {
    const Eigen::Index j = joint_index(description_, joint_names_, "limits", name);
    position_lower_(j) = limits.position_lower.value_or(position_lower_(j));
    position_upper_(j) = limits.position_upper.value_or(position_upper_(j));
    velocity_limit_(j) = limits.velocity.value_or(velocity_limit_(j));
    torque_limit_(j) = limits.torque.value_or(torque_limit_(j));
    add_torque_curves(name, static_cast<int>(j), limits);
  }
  check_limits(*this);
  check_torque_curves();

  nominal_configuration_ = Eigen::VectorXd::Zero(nq());
  if (!description_.nominal_base_rpy.allFinite()) {
    throw InputError(fmt::format("robot '{}': nominal.base_rpy must be three finite angles [rad]", name()));
  }
  set_base_rotation(nominal_configuration_, rotation_from_rpy(description_.nominal_base_rpy));
  for (const auto& [name, position] : description_.nominal_joints) {
    if (is_locked(description_, name)) continue;
    const Eigen::Index j = joint_index(description_, joint_names_, "nominal.joints", name);
    if (!std::isfinite(position)) {
      throw DescriptionError(
          "nominal.joints." + name,
          fmt::format("robot '{}': nominal.joints.{}: {} is not a finite position", this->name(), name, position));
    }
    nominal_configuration_(7 + j) = position;
  }
  put_on_ground(*pin, description_.contacts, nominal_configuration_);
  size_ = distance_of_contacts(*pin, nominal_configuration_);
  pinocchio_ = std::move(pin);
}

void RobotModel::add_torque_curves(const std::string& name, int joint, const JointLimits& limits) {
  const auto fail = [&](const char* key, const std::string& why) {
    throw DescriptionError("limits." + name, fmt::format("limits.{}.{}: {}", name, key, why));
  };
  const auto curve = [&](const char* key, const LimitCurve::Table& table) -> LimitCurve {
    try {
      return LimitCurve(table);
    } catch (const InputError& error) {
      fail(key, error.what());
      throw;
    }
  };
  const LimitCurve::Table& negative = limits.negative_torque_over_position;
  if (!limits.torque_over_position.empty()) {
    const LimitCurve positive = curve("torque_over_position", limits.torque_over_position);
    torque_curves_.push_back(
        {joint, false, positive, negative.empty() ? positive : curve("negative_torque_over_position", negative)});
  } else if (!negative.empty()) {
    fail("negative_torque_over_position", "needs torque_over_position, for positive torques");
  }
  if (!limits.torque_over_velocity.empty()) {
    const LimitCurve both = curve("torque_over_velocity", limits.torque_over_velocity);
    torque_curves_.push_back({joint, true, both, both});
  }
}

/// A curve must cover the joint's range: beyond its table it is a guess.
void RobotModel::check_torque_curves() const {
  for (const TorqueCurve& limit : torque_curves_) {
    const double lower = limit.over_velocity ? -velocity_limit_(limit.joint) : position_lower_(limit.joint);
    const double upper = limit.over_velocity ? velocity_limit_(limit.joint) : position_upper_(limit.joint);
    for (const LimitCurve* curve : {&limit.positive, &limit.negative}) {
      if (curve->lower_end() <= lower && curve->upper_end() >= upper) continue;
      const std::string& name = joint_names_[limit.joint];
      throw DescriptionError(
          "limits." + name,
          fmt::format("limits.{}.{}torque_over_{}: a table from {:g} to {:g} is not allowed; need the joint's "
                      "range, {:g} to {:g}",
                      name, curve == &limit.positive ? "" : "negative_", limit.over_velocity ? "velocity" : "position",
                      curve->lower_end(), curve->upper_end(), lower, upper));
    }
  }
}

RobotModel::RobotModel(const RobotModel& other)
    : description_(other.description_),
      pinocchio_(std::make_unique<PinocchioModel>(*other.pinocchio_)),
      joint_names_(other.joint_names_),
      joint_is_prismatic_(other.joint_is_prismatic_),
      position_lower_(other.position_lower_),
      position_upper_(other.position_upper_),
      velocity_limit_(other.velocity_limit_),
      torque_limit_(other.torque_limit_),
      torque_curves_(other.torque_curves_),
      losses_(other.losses_),
      nominal_configuration_(other.nominal_configuration_),
      mass_(other.mass_),
      size_(other.size_) {}

RobotModel::RobotModel(RobotModel&&) noexcept = default;

RobotModel& RobotModel::operator=(RobotModel other) noexcept {
  std::swap(description_, other.description_);
  std::swap(pinocchio_, other.pinocchio_);
  std::swap(joint_names_, other.joint_names_);
  std::swap(joint_is_prismatic_, other.joint_is_prismatic_);
  std::swap(position_lower_, other.position_lower_);
  std::swap(position_upper_, other.position_upper_);
  std::swap(velocity_limit_, other.velocity_limit_);
  std::swap(torque_limit_, other.torque_limit_);
  std::swap(torque_curves_, other.torque_curves_);
  std::swap(losses_, other.losses_);
  std::swap(nominal_configuration_, other.nominal_configuration_);
  std::swap(mass_, other.mass_);
  std::swap(size_, other.size_);
  return *this;
}

RobotModel::~RobotModel() = default;

Eigen::VectorXd RobotModel::armature() const { return pinocchio_->model.armature.tail(nu()); }

double RobotModel::torque_upper(int joint, double position, double velocity) const {
  double limit = torque_limit_(joint);
  for (const TorqueCurve& curve : torque_curves_) {
    if (curve.joint == joint) limit = std::min(limit, curve.upper(position, velocity));
  }
  return limit;
}

double RobotModel::torque_lower(int joint, double position, double velocity) const {
  double limit = -torque_limit_(joint);
  for (const TorqueCurve& curve : torque_curves_) {
    if (curve.joint == joint) limit = std::max(limit, curve.lower(position, velocity));
  }
  return limit;
}

int RobotModel::contact_index(const std::string& name) const {
  std::vector<std::string> names;
  for (const ContactPoint& contact : contacts()) names.push_back(contact.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InputError(
        fmt::format("'{}' is not a contact of robot '{}'{}", name, this->name(), did_you_mean(name, names)));
  }
  return static_cast<int>(found - names.begin());
}

}  // namespace prowl
