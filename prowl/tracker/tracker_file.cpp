// Reads tracker.bin (file_format.hpp). Every size is compared with the bytes left in the file
// before any allocation.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "prowl/tracker/file_format.hpp"
#include "prowl/tracker/tracker.hpp"

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "tracker.bin is little-endian, this machine is not"
#endif

namespace prowl {
namespace {

/// Reads a file sequentially, never beyond its end.
class Bytes {
 public:
  explicit Bytes(const std::string& path) : path_(path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) fail("no such file");
    left_ = std::filesystem::file_size(path, error);
    if (error) fail(error.message());
    if (left_ > tracker_file::kLongestFile) fail("larger than 1 GB");
    file_.open(path, std::ios::binary);
    if (!file_) fail("cannot be read");
  }

  [[noreturn]] void fail(const std::string& message) const { throw TrackerError(path_ + ": " + message); }
  std::uint64_t left() const { return left_; }

  /// Copies the next `size` bytes to `target`.
  void take(void* target, std::uint64_t size, const char* what) {
    if (size > left_) fail(std::string("truncated in ") + what);
    if (!file_.read(static_cast<char*>(target), static_cast<std::streamsize>(size))) fail("cannot be read");
    left_ -= size;
  }

  template <class Number>
  Number number(const char* what) {
    Number value;
    take(&value, sizeof(value), what);
    return value;
  }

  /// A number that an int can hold.
  int count(const char* what) {
    const auto value = number<std::uint32_t>(what);
    if (value > static_cast<std::uint32_t>(std::numeric_limits<int>::max()))
      fail(std::string("a number is too large in ") + what);
    return static_cast<int>(value);
  }

  std::string text(const char* what) {
    const auto size = number<std::uint32_t>(what);
    if (size > left_) fail(std::string("truncated in ") + what);
    std::string value(size, '\0');
    take(value.data(), size, what);
    return value;
  }

  Eigen::MatrixXd matrix(std::uint64_t rows, std::uint64_t cols, const char* what) {
    if (rows != 0 && cols > left_ / sizeof(double) / rows) fail(std::string("truncated in ") + what);
    Eigen::MatrixXd matrix(rows, cols);
    take(matrix.data(), rows * cols * sizeof(double), what);
    return matrix;
  }

  /// Checksum of all remaining bytes; the position stays.
  std::uint64_t checksum_of_rest() {
    const std::streampos here = file_.tellg();
    tracker_file::Checksum sum;
    std::vector<char> part(std::size_t{1} << 16);
    for (std::uint64_t rest = left_; rest > 0;) {
      const std::size_t size = std::min<std::uint64_t>(rest, part.size());
      if (!file_.read(part.data(), static_cast<std::streamsize>(size))) fail("cannot be read");
      sum.add(part.data(), size);
      rest -= size;
    }
    file_.seekg(here);
    return sum.value();
  }

 private:
  std::string path_;
  std::ifstream file_;
  std::uint64_t left_ = 0;
};

struct Header {
  std::uint32_t joints, contacts, segments, curves, samples;
};

Header read_header(Bytes& bytes) {
  std::string magic(tracker_file::kMagicBytes, '\0');
  bytes.take(magic.data(), magic.size(), "the header");
  if (magic != tracker_file::kMagic) bytes.fail("not a tracker file; need tracker.bin of a plan");
  const auto count = [&bytes] { return bytes.number<std::uint32_t>("the header"); };
  if (const std::uint32_t version = count(); version < 1 || version > tracker_file::kVersion) {
    bytes.fail("version " + std::to_string(version) + " of the format; need " + std::to_string(tracker_file::kVersion));
  }
  Header header{};
  header.joints = count();
  header.contacts = count();
  header.segments = count();
  header.curves = count();
  header.samples = count();
  const auto payload = bytes.number<std::uint64_t>("the header");
  const auto checksum = bytes.number<std::uint64_t>("the header");
  if (payload != bytes.left()) {
    bytes.fail(std::to_string(bytes.left()) + " bytes after the header; need " + std::to_string(payload) +
               ": the file is truncated or has trailing bytes");
  }
  if (checksum != bytes.checksum_of_rest()) bytes.fail("altered since it was written");
  // A count above the number of remaining bytes is wrong.
  for (const std::uint64_t n : {header.joints, header.contacts, header.segments, header.curves, header.samples}) {
    if (n > bytes.left()) bytes.fail("a count in the header exceeds the file size");
  }
  if (header.joints > Tracker::kMostVelocities) bytes.fail(std::to_string(header.joints) + " joints are too many");
  return header;
}

TrackingPlan::Segment read_segment(Bytes& bytes, std::uint32_t contacts) {
  const char* const what = "the segments";
  TrackingPlan::Segment segment;
  segment.name = bytes.text(what);
  segment.start = bytes.number<double>(what);
  segment.end = bytes.number<double>(what);
  segment.samples = bytes.count(what);
  for (std::uint32_t i = 0; i < contacts; ++i) segment.in_contact.push_back(bytes.number<char>(what) != 0);
  return segment;
}

TrackingPlan::TorqueCurve read_curve(Bytes& bytes) {
  const char* const what = "the torque curves";
  TrackingPlan::TorqueCurve curve;
  curve.joint = bytes.count(what);
  const auto kind = bytes.number<std::uint32_t>(what);
  if (kind > 5) bytes.fail("an unknown kind of torque curve");
  curve.over_velocity = (kind & 1u) != 0;
  curve.torques = static_cast<TrackingPlan::Torques>(kind / 2);
  const auto values = bytes.number<std::uint32_t>(what);
  curve.lower = bytes.number<double>(what);
  curve.upper = bytes.number<double>(what);
  curve.values = bytes.matrix(values, 1, what);
  return curve;
}

TrackingPlan read_plan(Bytes& bytes) {
  const Header header = read_header(bytes);
  TrackingPlan plan;
  for (std::uint32_t i = 0; i < header.joints; ++i) plan.joint_names.push_back(bytes.text("the joint names"));
  for (std::uint32_t i = 0; i < header.contacts; ++i) plan.contact_names.push_back(bytes.text("the contact names"));
  std::int64_t first = 0;
  for (std::uint32_t i = 0; i < header.segments; ++i) {
    TrackingPlan::Segment segment = read_segment(bytes, header.contacts);
    segment.first_sample = static_cast<int>(first);
    first += segment.samples;
    if (first > header.samples) bytes.fail("the segments have more samples than the file");
    plan.segments.push_back(std::move(segment));
  }
  for (std::uint32_t i = 0; i < header.curves; ++i) plan.torque_curves.push_back(read_curve(bytes));
  const std::uint64_t nu = header.joints, samples = header.samples;
  plan.torque_limit = bytes.matrix(nu, 1, "the torque limits");
  plan.q = bytes.matrix(nu + 7, samples, "q");
  plan.v = bytes.matrix(nu + 6, samples, "v");
  plan.tau = bytes.matrix(nu, samples, "tau");
  plan.gains = bytes.matrix(2 * nu * (nu + 6), samples, "the gains");
  if (bytes.left() != 0) bytes.fail(std::to_string(bytes.left()) + " trailing bytes");
  return plan;
}

}  // namespace

Tracker Tracker::read(const std::string& path) {
  Bytes bytes(path);
  TrackingPlan plan = read_plan(bytes);
  try {
    return Tracker(std::move(plan));
  } catch (const TrackerError& error) {
    bytes.fail(error.what());
  }
}

}  // namespace prowl
