// Reads tracker.bin (file_format.hpp). Nothing is allocated on the word of the file alone: every size is compared with the
// bytes that are there first.
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "prowl/tracker/file_format.hpp"
#include "prowl/tracker/tracker.hpp"

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "tracker.bin is little-endian, this machine is not"
#endif

namespace prowl {
namespace {

/// Takes one thing after the other from the bytes of a file, never more than there are.
class Bytes {
 public:
  Bytes(std::string path, std::string text) : path_(std::move(path)), text_(std::move(text)) {}

  [[noreturn]] void fail(const std::string& message) const { throw TrackerError(path_ + ": " + message); }
  std::size_t left() const { return text_.size() - next_; }
  const char* here() const { return text_.data() + next_; }

  /// `size` bytes, as a place to copy from.
  const char* take(std::uint64_t size, const char* what) {
    if (size > left()) fail(std::string("cut short in ") + what);
    const char* const begin = here();
    next_ += static_cast<std::size_t>(size);
    return begin;
  }

  template <class Number>
  Number number(const char* what) {
    Number value;
    std::memcpy(&value, take(sizeof(value), what), sizeof(value));
    return value;
  }

  /// A number that an int can hold.
  int count(const char* what) {
    const auto value = number<std::uint32_t>(what);
    if (value > static_cast<std::uint32_t>(std::numeric_limits<int>::max())) fail(std::string("too large a number in ") + what);
    return static_cast<int>(value);
  }

  std::string text(const char* what) {
    const auto size = number<std::uint32_t>(what);
    return {take(size, what), size};
  }

  Eigen::MatrixXd matrix(std::uint64_t rows, std::uint64_t cols, const char* what) {
    if (rows != 0 && cols > left() / sizeof(double) / rows) fail(std::string("cut short in ") + what);
    const char* const begin = take(rows * cols * sizeof(double), what);
    Eigen::MatrixXd matrix(rows, cols);
    if (matrix.size() > 0) std::memcpy(matrix.data(), begin, rows * cols * sizeof(double));
    return matrix;
  }

 private:
  std::string path_, text_;
  std::size_t next_ = 0;
};

struct Header {
  std::uint32_t joints, contacts, segments, curves, samples;
};

Header read_header(Bytes& bytes) {
  if (std::string(bytes.take(tracker_file::kMagicBytes, "the header"), tracker_file::kMagicBytes) != tracker_file::kMagic) {
    bytes.fail("no tracker file; need tracker.bin of a plan");
  }
  const auto count = [&bytes] { return bytes.number<std::uint32_t>("the header"); };
  if (const std::uint32_t version = count(); version != tracker_file::kVersion) {
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
               ": the file is cut short or has something behind it");
  }
  if (checksum != tracker_file::checksum(bytes.here(), bytes.left())) bytes.fail("changed since it was written");
  // A count above the bytes that are left cannot be true, and is not worth reserving for.
  for (const std::uint64_t n : {header.joints, header.contacts, header.segments, header.curves, header.samples}) {
    if (n > bytes.left()) bytes.fail("a count of the header is larger than the file");
  }
  if (header.joints > Tracker::kMostVelocities) bytes.fail(std::to_string(header.joints) + " joints; need fewer");
  return header;
}

TrackingPlan::Segment read_segment(Bytes& bytes, std::uint32_t contacts) {
  const char* const what = "the segments";
  TrackingPlan::Segment segment;
  segment.name = bytes.text(what);
  segment.start = bytes.number<double>(what);
  segment.end = bytes.number<double>(what);
  segment.samples = bytes.count(what);
  const char* const flags = bytes.take(contacts, what);
  for (std::uint32_t i = 0; i < contacts; ++i) segment.in_contact.push_back(flags[i] != 0);
  return segment;
}

TrackingPlan::TorqueCurve read_curve(Bytes& bytes) {
  const char* const what = "the torque curves";
  TrackingPlan::TorqueCurve curve;
  curve.joint = bytes.count(what);
  curve.over_velocity = bytes.number<std::uint32_t>(what) != 0;
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
  if (bytes.left() != 0) bytes.fail(std::to_string(bytes.left()) + " bytes too many");
  return plan;
}

std::string read_bytes(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw TrackerError(path + ": no such file");
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw TrackerError(path + ": " + error.message());
  if (size > tracker_file::kLongestFile) throw TrackerError(path + ": more than 1 GB");
  std::ifstream file(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(size), '\0');
  if (!file || !file.read(text.data(), static_cast<std::streamsize>(size))) throw TrackerError(path + ": cannot be read");
  return text;
}

}  // namespace

Tracker Tracker::read(const std::string& path) {
  Bytes bytes(path, read_bytes(path));
  TrackingPlan plan = read_plan(bytes);
  try {
    return Tracker(std::move(plan));
  } catch (const TrackerError& error) {
    bytes.fail(error.what());
  }
}

}  // namespace prowl
