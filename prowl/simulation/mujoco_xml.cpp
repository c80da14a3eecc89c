#include "prowl/simulation/mujoco_xml.hpp"

#include <fmt/format.h>

#include <array>

#include "prowl/error.hpp"
#include "prowl/simulation/mujoco_model.hpp"

// Private functions of MuJoCo's library, with thread-local effect. By default saved files have six
// digits, which moves feet by micrometres. requirements.txt pins the library; a test checks the
// round trip.
extern "C" {
int _mjPRIVATE__get_xml_precision();
void _mjPRIVATE__set_xml_precision(int digits);
}

namespace prowl {
namespace {

class AllDigits {
 public:
  AllDigits() : before_(_mjPRIVATE__get_xml_precision()) { _mjPRIVATE__set_xml_precision(17); }
  ~AllDigits() { _mjPRIVATE__set_xml_precision(before_); }
  AllDigits(const AllDigits&) = delete;
  AllDigits& operator=(const AllDigits&) = delete;

 private:
  int before_;
};

}  // namespace

std::string mujoco_xml(const RobotModel& robot, const std::vector<Surface>& surfaces, const PhysicsOptions& options) {
  const MujocoSpec spec = make_mujoco_spec(robot, surfaces, options);
  mjs_setString(spec->modelname, robot.name().c_str());
  const auto fail = [&robot](const char* reason) {
    throw InputError(fmt::format("robot '{}' in MuJoCo: {}", robot.name(), reason));
  };
  const MujocoModel::Delete delete_model;
  mjModel* const compiled = mj_compile(spec.get(), nullptr);
  if (!compiled) fail(mjs_getError(spec.get()));
  delete_model(compiled);

  const AllDigits digits;
  std::array<char, 500> error{};
  std::string xml(1u << 16, '\0');
  // Returns 0, the required size if the buffer is too small, or -1.
  int needed = mj_saveXMLString(spec.get(), xml.data(), static_cast<int>(xml.size()), error.data(), error.size());
  if (needed > 0) {
    xml.resize(static_cast<std::size_t>(needed) + 1);
    needed = mj_saveXMLString(spec.get(), xml.data(), static_cast<int>(xml.size()), error.data(), error.size());
  }
  if (needed != 0) fail(error.data());
  xml.resize(xml.find('\0'));
  return xml;
}

}  // namespace prowl
