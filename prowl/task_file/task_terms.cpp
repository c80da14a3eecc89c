#include "prowl/task_file/task_terms.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/task_file/task_moment.hpp"
#include "prowl/task_file/toml/toml_vectors.hpp"
#include "prowl/terms/frame_terms.hpp"
#include "prowl/terms/selected_entries.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kFree = std::numeric_limits<double>::infinity();

/// A direction of any length but zero.
Vector3d read_direction(const TomlValue& value) {
  constexpr double kShortest = 1e-6;
  const Vector3d direction = value.as_vector3();
  if (direction.norm() < kShortest) {
    value.fail(fmt::format("too short for a direction; need a length of {:g} or more", kShortest));
  }
  return direction;
}

/// The keys that say more about a quantity; empty if absent.
struct Modifiers {
  std::optional<std::string> frame, relative_to, contact;
  std::optional<Vector3d> axis;
  std::optional<double> within;
  std::vector<TomlBounds> value;
};

Modifiers read_modifiers(const TomlTable& table, const RobotModel& robot) {
  Modifiers modifiers;
  const auto read_frame = [&](const char* key, std::optional<std::string>& frame) {
    const auto value = table.find(key);
    if (!value) return;
    frame = value->as_text();
    try {
      robot_frame(robot, *frame);
    } catch (const InputError& error) {
      value->fail(error.what());
    }
  };
  read_frame("frame", modifiers.frame);
  read_frame("relative_to", modifiers.relative_to);
  if (const auto contact = table.find("contact")) {
    std::vector<std::string> names;
    for (const ContactPoint& point : robot.contacts()) names.push_back(point.name);
    modifiers.contact = names[contact->as_one_of("contact", names)];
  }
  if (const auto axis = table.find("axis")) modifiers.axis = read_direction(*axis);
  if (const auto value = table.find("value")) {
    for (const TomlValue& entry : value->as_list()) modifiers.value.push_back(entry.as_one_sided_bounds());
  }
  if (const auto library = table.find("library")) library->as_text();
  if (const auto within = table.find("within_rad")) modifiers.within = within->as_number();
  return modifiers;
}

/// Bounds of the rows of a term, and what makes the term once the modifiers are known.
struct TermBounds {
  VectorXd lower, upper;
  std::function<std::shared_ptr<const Term>(const Modifiers&)> make;
};
using MakeTerm = decltype(TermBounds::make);

TermBounds with_bounds(const std::vector<TomlBounds>& entries, MakeTerm make) {
  const std::ptrdiff_t rows = std::ssize(entries);
  TermBounds result{VectorXd(rows), VectorXd(rows), std::move(make)};
  for (std::ptrdiff_t i = 0; i < rows; ++i) {
    result.lower(i) = entries[i].lower;
    result.upper(i) = entries[i].upper;
  }
  return result;
}

TermBounds read_entries(const std::vector<TomlValue>& entries, MakeTerm make) {
  std::vector<TomlBounds> bounds;
  for (const TomlValue& entry : entries) bounds.push_back(entry.as_one_sided_bounds());
  return with_bounds(bounds, std::move(make));
}

TermBounds read_orientation(const TomlValue& value) {
  const Eigen::Matrix3d reference = rotation_from_rpy(value.as_vector3());
  return {Vector3d::Zero(), Vector3d::Zero(), [reference](const Modifiers& with) {
            return frame_orientation(*with.frame, reference, with.relative_to.value_or(""));
          }};
}

using OfJoints = std::shared_ptr<const Term> (*)(const RobotModel& robot, const std::vector<int>& joints);

TermBounds read_joint_values(const TomlValue& value, const RobotModel& robot, OfJoints of_joints) {
  std::vector<int> joints;
  std::vector<TomlValue> entries;
  for (const auto& [name, entry] : value.as_named_values(robot.joint_names(), "joint")) {
    const auto joint = std::ranges::find(robot.joint_names(), name) - robot.joint_names().begin();
    if (robot.joint_is_prismatic()[joint]) entry.fail("a sliding joint is not allowed; need one that turns");
    joints.push_back(static_cast<int>(joint));
    entries.push_back(entry);
  }
  if (joints.empty()) value.fail("an empty table is not allowed; need one joint or more");
  const std::shared_ptr<const Term> term = of_joints(robot, joints);
  return read_entries(entries, [term](const Modifiers&) { return term; });
}

/// One quantity that a term may hold.
struct TermQuantity {
  const char* key;
  TermBounds (*read)(const TomlValue& value, const RobotModel& robot);
  std::vector<std::string> needed, allowed;  ///< modifiers
};

const std::vector<TermQuantity>& term_quantities() {
  using Value = TomlValue;
  using Robot = RobotModel;
  static const std::vector<TermQuantity> kQuantities = {
      {"position_m",
       [](const Value& value, const Robot&) {
         return read_entries(value.as_list(3), [](const Modifiers& with) {
           return frame_position(*with.frame, with.relative_to.value_or(""));
         });
       },
       {"frame"},
       {"relative_to"}},
      {"orientation_rpy_rad",
       [](const Value& value, const Robot&) { return read_orientation(value); },
       {"frame"},
       {"relative_to", "within_rad"}},
      {"velocity_mps",
       [](const Value& value, const Robot&) {
         return read_entries(value.as_list(3), [](const Modifiers& with) { return frame_velocity(*with.frame); });
       },
       {"frame"},
       {}},
      {"angular_velocity_radps",
       [](const Value& value, const Robot&) {
         return read_entries(value.as_list(3),
                             [](const Modifiers& with) { return frame_angular_velocity(*with.frame); });
       },
       {"frame"},
       {}},
      {"points_along",
       [](const Value& value, const Robot&) {
         const Vector3d along = read_direction(value);
         return TermBounds{Vector2d::Zero(), Vector2d::Zero(), [along](const Modifiers& with) {
                             return frame_pointing_along(*with.frame, *with.axis, along);
                           }};
       },
       {"frame", "axis"},
       {"within_rad"}},
      {"points_at_m",
       [](const Value& value, const Robot&) {
         const Vector3d at = value.as_vector3();
         return TermBounds{Vector2d::Zero(), Vector2d::Zero(),
                           [at](const Modifiers& with) { return frame_pointing_at(*with.frame, *with.axis, at); }};
       },
       {"frame", "axis"},
       {"within_rad"}},
      {"com_m",
       [](const Value& value, const Robot&) {
         return read_entries(value.as_list(3), [](const Modifiers&) { return center_of_mass(); });
       },
       {},
       {}},
      {"com_velocity_mps",
       [](const Value& value, const Robot&) {
         return read_entries(value.as_list(3), [](const Modifiers&) { return center_of_mass_velocity(); });
       },
       {},
       {}},
      {"angular_momentum_Nms",
       [](const Value& value, const Robot&) {
         return read_entries(value.as_list(3), [](const Modifiers&) { return angular_momentum(); });
       },
       {},
       {}},
      {"joints",
       [](const Value& value, const Robot& robot) { return read_joint_values(value, robot, &joint_positions); },
       {},
       {}},
      {"joint_velocity_radps",
       [](const Value& value, const Robot& robot) { return read_joint_values(value, robot, &joint_rates); },
       {},
       {}},
      {"joint_torque_Nm",
       [](const Value& value, const Robot& robot) { return read_joint_values(value, robot, &joint_torques); },
       {},
       {}},
      {"force_N",
       [](const Value& value, const Robot&) {
         return read_entries(value.as_list(3), [](const Modifiers& with) { return contact_force(*with.contact); });
       },
       {"contact"},
       {}},
  };
  return kQuantities;
}

TermBounds read_own(const TomlTable& table, const std::vector<TomlBounds>& value, const OwnTermReader& own_terms) {
  const std::shared_ptr<const Term> term = own_terms.read(table);
  if (std::ssize(value) != term->num_rows()) {
    table.need("value").fail(fmt::format("{} entries are not allowed; need {}: {}", value.size(), term->num_rows(),
                                         fmt::join(term->rows(), ", ")));
  }
  return with_bounds(value, [term](const Modifiers&) { return term; });
}

/// Reads all keys that are there, so that each is checked, before it asks whether they go together.
void read_quantity(const TomlTable& table, const RobotModel& robot, const OwnTermReader& own_terms, TermUse& use) {
  static const TermQuantity kOwn = {"own", nullptr, {"value"}, {"library"}};
  const Modifiers modifiers = read_modifiers(table, robot);
  std::vector<const TermQuantity*> asked;
  TermBounds read;
  std::vector<const char*> keys;
  for (const TermQuantity& quantity : term_quantities()) {
    keys.push_back(quantity.key);
    const auto value = table.find(quantity.key);
    if (!value) continue;
    read = quantity.read(*value, robot);
    asked.push_back(&quantity);
  }
  keys.push_back(kOwn.key);
  if (table.find(kOwn.key)) {
    read = read_own(table, modifiers.value, own_terms);
    asked.push_back(&kOwn);
  }
  if (asked.empty()) table.value().fail(fmt::format("holds nothing; need one of {}", fmt::join(keys, ", ")));
  const TermQuantity& quantity = *asked.front();
  if (asked.size() > 1) {
    table.need(asked[1]->key).fail(fmt::format("{} is here, too; need one quantity in each [[term]]", quantity.key));
  }
  for (const std::string& key : quantity.needed) table.need(key);
  for (const char* key : {"frame", "relative_to", "axis", "within_rad", "contact", "value", "library"}) {
    const auto value = table.find(key);
    if (!value || std::ranges::count(quantity.needed, key) > 0 || std::ranges::count(quantity.allowed, key) > 0)
      continue;
    value->fail(fmt::format("has no meaning beside {}; need no such key", quantity.key));
  }
  use.term = read.make(modifiers);
  const double within = modifiers.within.value_or(0.0);
  use.lower = read.lower.array() - within;  // of what has no such key it is zero
  use.upper = read.upper.array() + within;
}

/// The key weight: a diagonal.
MatrixXd read_weight(const TomlTable& table, const TomlValue& weight, Eigen::Index rows) {
  VectorXd weights(rows);
  if (weight.is_list() && rows != 3) weight.fail(fmt::format("need one number for {} entries", rows));
  read_axes(table, "weight", weights);
  return weights.asDiagonal();
}

MatrixXd read_weight_matrix(const TomlValue& value, Eigen::Index size) {
  MatrixXd matrix(size, size);
  const std::vector<TomlValue> rows = value.as_list(static_cast<std::size_t>(size));
  for (Eigen::Index i = 0; i < size; ++i) {
    const std::vector<TomlValue> entries = rows[i].as_list(static_cast<std::size_t>(size));
    for (Eigen::Index j = 0; j < size; ++j) matrix(i, j) = entries[j].as_number();
  }
  return matrix;
}

/// Turns bounds into a cost to their values.
void make_cost(const TomlTable& table, TermUse& use) {
  const auto weight = table.find("weight"), matrix = table.find("weight_matrix");
  if (!weight && !matrix) return;
  const TomlValue& key = matrix ? *matrix : *weight;
  if (weight && matrix) matrix->fail("weight is here, too; need one of both");
  const auto rows = use.lower.size();
  use.weight = matrix ? read_weight_matrix(*matrix, rows) : read_weight(table, *weight, rows);
  use.reference.setZero(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (use.lower(row) == -kFree && use.upper(row) == kFree) {
      use.weight.row(row).setZero();
      use.weight.col(row).setZero();
      continue;
    }
    if (use.lower(row) != use.upper(row)) key.fail("a range has no weight; need a value that the cost pulls to");
    use.reference(row) = use.lower(row);
  }
  if (use.weight.isZero(0.0)) key.fail("weighs nothing; need one positive weight on an entry that is not free");
  use.lower.resize(0);
  use.upper.resize(0);
}

}  // namespace

std::shared_ptr<const Term> OwnTermReader::read(const TomlTable& table) const {
  const TomlValue own = table.need("own");
  const std::string name = own.as_text();
  const auto library_key = table.find("library");
  OwnTermMap terms;
  if (!library_key) terms = own_terms_.known;
  if (const auto& library = library_key) {
    if (!own_terms_.allows_libraries) {
      library->fail("a library is not loaded by default; need --allow-libraries, in Python allow_libraries=True");
    }
    try {
      terms = own_terms_of(std::filesystem::absolute(folder_ / library->as_text()));
    } catch (const InputError& error) {
      library->fail(error.what());
    }
  }
  const auto found = terms.find(name);
  if (found != terms.end() && !found->second) own.fail(fmt::format("the library has no function for '{}'", name));
  if (found != terms.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [other, term] : terms) known.push_back(other);
  if (known.empty()) {
    own.fail(
        fmt::format("no term '{}' is known; need the key library, or own_terms in Python (docs/own-terms.md)", name));
  }
  own.fail_unknown_name("term of your own", known);
}

std::vector<TermUse> read_terms(const TomlTable& root, const RobotModel& robot, const std::vector<Phase>& phases,
                                const std::optional<Mesh>& mesh, const OwnTermReader& own_terms) {
  std::vector<TermUse> terms;
  for (const TomlTable& table : root.find_tables("term")) {
    TermUse use;
    const auto name = table.find("name");
    use.name = name ? name->as_name() : fmt::format("term {}", terms.size() + 1);
    if (std::ranges::count(terms, use.name, &TermUse::name) > 0) {
      table.value().fail("\"" + use.name + "\" is already another term");
    }
    read_quantity(table, robot, own_terms, use);
    const MotionSpan span = read_span(table, phases, mesh);
    use.from = span.from;
    use.to = span.to;
    make_cost(table, use);
    const bool binds = use.is_cost() || use.lower.array().isFinite().any() || use.upper.array().isFinite().any();
    if (!binds) table.value().fail("limits nothing; need one entry that is not free");
    terms.push_back(std::move(use));
  }
  return terms;
}

}  // namespace prowl
