#include "prowl/plan_folder/tracker_file.hpp"

#include <bit>

#include "prowl/tracker/file_format.hpp"

static_assert(std::endian::native == std::endian::little, "tracker.bin is little-endian");

namespace prowl {
namespace {

template <class Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

void append_count(std::string& bytes, std::size_t count) { append(bytes, static_cast<std::uint32_t>(count)); }

void append_text(std::string& bytes, const std::string& text) {
  append_count(bytes, text.size());
  bytes += text;
}

void append_matrix(std::string& bytes, const Eigen::MatrixXd& matrix) {
  bytes.append(reinterpret_cast<const char*>(matrix.data()), static_cast<std::size_t>(matrix.size()) * sizeof(double));
}

std::string payload_of(const TrackingPlan& plan) {
  std::string bytes;
  for (const std::string& name : plan.joint_names) append_text(bytes, name);
  for (const std::string& name : plan.contact_names) append_text(bytes, name);
  for (const TrackingPlan::Segment& segment : plan.segments) {
    append_text(bytes, segment.name);
    append(bytes, segment.start);
    append(bytes, segment.end);
    append_count(bytes, static_cast<std::size_t>(segment.samples));
    for (const bool holds : segment.in_contact) bytes += holds ? '\1' : '\0';
  }
  for (const TrackingPlan::TorqueCurve& curve : plan.torque_curves) {
    append_count(bytes, static_cast<std::size_t>(curve.joint));
    append_count(bytes, (curve.over_velocity ? 1 : 0) + 2 * static_cast<std::size_t>(curve.torques));
    append_count(bytes, static_cast<std::size_t>(curve.values.size()));
    append(bytes, curve.lower);
    append(bytes, curve.upper);
    append_matrix(bytes, curve.values);
  }
  append_matrix(bytes, plan.torque_limit);
  append_matrix(bytes, plan.q);
  append_matrix(bytes, plan.v);
  append_matrix(bytes, plan.tau);
  append_matrix(bytes, plan.gains);
  return bytes;
}

}  // namespace

std::string tracker_file_bytes(const TrackingPlan& plan) {
  const std::string payload = payload_of(plan);
  std::string bytes(tracker_file::kMagic, tracker_file::kMagicBytes);
  append(bytes, tracker_file::kVersion);
  append_count(bytes, plan.joint_names.size());
  append_count(bytes, plan.contact_names.size());
  append_count(bytes, plan.segments.size());
  append_count(bytes, plan.torque_curves.size());
  append_count(bytes, static_cast<std::size_t>(plan.num_samples()));
  append(bytes, static_cast<std::uint64_t>(payload.size()));
  append(bytes, tracker_file::checksum(payload.data(), payload.size()));
  return bytes + payload;
}

}  // namespace prowl
