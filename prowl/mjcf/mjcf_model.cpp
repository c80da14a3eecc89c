#include "prowl/mjcf/mjcf_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prowl/error.hpp"
#include "prowl/mjcf/mujoco_log.hpp"

namespace prowl {

namespace fs = std::filesystem;

namespace {

struct DeleteSpec {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};

/// Messages of MuJoCo may have several lines.
std::string one_line_of(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

double largest_of(const mjtNum* range) { return std::max(std::abs(range[0]), std::abs(range[1])); }

}  // namespace

MjcfModel::MjcfModel(const fs::path& file) : file_(file) {
  silence_mujoco();
  std::array<char, 1000> error{};
  const std::unique_ptr<mjSpec, DeleteSpec> spec(mj_parseXML(file.c_str(), nullptr, error.data(), error.size()));
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("{}: MuJoCo cannot read it: {}", file.string(), one_line_of(reason)));
  };
  if (!spec) refuse(error.data());
  mesh_folder_ = file.parent_path() / mjs_getString(spec->compiler.meshdir);
  model_.reset(mj_compile(spec.get(), nullptr));
  if (!model_) refuse(mjs_getError(spec.get()));
  base_ = find_base();
}

/// The body of the one free joint. Refuses others, what does not hang on it by hinges and slides, and loops.
int MjcfModel::find_base() const {
  const auto refuse = [&](const std::string& problem) {
    throw InputError(fmt::format("{}: {}", file_.string(), problem));
  };
  std::vector<int> free_bodies;
  for (int joint = 0; joint < model_->njnt; ++joint) {
    if (model_->jnt_type[joint] == mjJNT_BALL) {
      refuse(fmt::format("joint '{}' is a ball; need hinges and slides", name_of(mjOBJ_JOINT, joint)));
    }
    if (model_->jnt_type[joint] == mjJNT_FREE) free_bodies.push_back(model_->jnt_bodyid[joint]);
  }
  if (free_bodies.empty()) refuse("no body has a <freejoint>; need one on the base of the robot");
  if (free_bodies.size() > 1) {
    std::vector<std::string> names;
    for (const int body : free_bodies) names.push_back(name_of(mjOBJ_BODY, body));
    refuse(fmt::format("{} bodies have a free joint ({}); need the file of one robot", names.size(),
                       fmt::join(names, ", ")));
  }
  const int base = free_bodies.front();
  for (int joint = 0; joint < model_->njnt; ++joint) {
    if (model_->body_rootid[model_->jnt_bodyid[joint]] == base) continue;
    refuse(fmt::format("joint '{}' is not behind the free joint of '{}'; need the file of one robot",
                       name_of(mjOBJ_JOINT, joint), name_of(mjOBJ_BODY, base)));
  }
  for (int i = 0; i < model_->neq; ++i) {
    if (model_->eq_type[i] != mjEQ_CONNECT && model_->eq_type[i] != mjEQ_WELD) continue;
    refuse(
        fmt::format("the equality constraint '{}' closes a loop; need a tree of bodies", name_of(mjOBJ_EQUALITY, i)));
  }
  return base;
}

std::string MjcfModel::name() const { return model_->names; }

std::string MjcfModel::name_of(mjtObj kind, int id) const {
  const char* const name = mj_id2name(model_.get(), kind, id);
  return name && *name ? name : fmt::format("{}_{}", mju_type2Str(kind), id);
}

std::vector<int> MjcfModel::children(int body) const {
  std::vector<int> result;
  for (int other = body + 1; other < model_->nbody; ++other) {
    if (model_->body_parentid[other] == body) result.push_back(other);
  }
  return result;
}

std::vector<int> MjcfModel::actuators(int joint) const {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(model_->nactuator); ++i) {
    const int on = model_->actuator_trntype[i];
    if ((on == mjTRN_JOINT || on == mjTRN_JOINTINPARENT) && model_->actuator_trnid[2 * i] == joint) result.push_back(i);
  }
  return result;
}

std::optional<double> MjcfModel::torque_limit(int joint) const {
  std::optional<double> of_actuators;
  for (const int i : actuators(joint)) {
    const double gear = std::abs(model_->actuator_gear[6 * model_->actuator_outadr[i]]);
    const int control = model_->actuator_ctrladr[i];
    const bool is_motor = model_->actuator_gaintype[i] == mjGAIN_FIXED && model_->actuator_biastype[i] == mjBIAS_NONE &&
                          model_->actuator_ctrlnum[i] == 1;
    if (model_->actuator_forcelimited[i]) {
      of_actuators = of_actuators.value_or(0.0) + gear * largest_of(model_->actuator_forcerange + 2 * i);
    } else if (is_motor && model_->actuator_ctrllimited[control]) {
      const double gain = std::abs(model_->actuator_gainprm[mjNGAIN * i]);
      of_actuators = of_actuators.value_or(0.0) + gear * gain * largest_of(model_->actuator_ctrlrange + 2 * control);
    }
  }
  if (!model_->jnt_actfrclimited[joint]) return of_actuators;
  const double of_joint = largest_of(model_->jnt_actfrcrange + 2 * joint);
  return of_actuators ? std::min(*of_actuators, of_joint) : of_joint;
}

fs::path MjcfModel::mesh_file(int mesh) const {
  if (model_->mesh_pathadr[mesh] < 0) return {};
  const fs::path path = model_->paths + model_->mesh_pathadr[mesh];
  std::error_code error;
  for (const fs::path& candidate : {mesh_folder_ / path, file_.parent_path() / path, path}) {
    if (fs::is_regular_file(candidate, error)) return fs::absolute(candidate).lexically_normal();
  }
  return {};
}

}  // namespace prowl
