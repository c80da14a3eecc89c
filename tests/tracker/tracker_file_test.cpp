#include "prowl/plan_folder/tracker_file.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "prowl/tracker/file_format.hpp"
#include "prowl/tracker/tracker.hpp"
#include "tests/support/random_tracking_plan.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

constexpr std::size_t kCounts = 12;   // joints, contacts, segments, curves, samples: 4 bytes each
constexpr std::size_t kPayload = 32;  // its length, then its checksum

template <class Number>
void put(std::string& bytes, std::size_t at, Number number) {
  bytes.replace(at, sizeof(number), reinterpret_cast<const char*>(&number), sizeof(number));
}

/// With length and checksum of what is there: what a forger would write.
std::string resealed(std::string bytes) {
  const std::size_t payload = bytes.size() - tracker_file::kHeaderBytes;
  put<std::uint64_t>(bytes, kPayload, payload);
  put<std::uint64_t>(bytes, kPayload + 8, tracker_file::checksum(bytes.data() + tracker_file::kHeaderBytes, payload));
  return bytes;
}

TEST(TrackerFile, ReadsBackEveryBit) {
  const test::TempFolder folder;
  const TrackingPlan plan = test::random_tracking_plan();
  const Tracker tracker = Tracker::read(folder.write("tracker.bin", tracker_file_bytes(plan)));
  const TrackingPlan& read = tracker.plan();
  EXPECT_EQ(read.joint_names, plan.joint_names);
  EXPECT_EQ(read.contact_names, plan.contact_names);
  EXPECT_EQ(read.torque_limit, plan.torque_limit);
  EXPECT_EQ(read.q, plan.q);
  EXPECT_EQ(read.v, plan.v);
  EXPECT_EQ(read.tau, plan.tau);
  EXPECT_EQ(read.gains, plan.gains);
  ASSERT_EQ(read.segments.size(), plan.segments.size());
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    EXPECT_EQ(read.segments[s].name, plan.segments[s].name);
    EXPECT_EQ(read.segments[s].start, plan.segments[s].start);
    EXPECT_EQ(read.segments[s].end, plan.segments[s].end);
    EXPECT_EQ(read.segments[s].first_sample, plan.segments[s].first_sample);
    EXPECT_EQ(read.segments[s].samples, plan.segments[s].samples);
    EXPECT_EQ(read.segments[s].in_contact, plan.segments[s].in_contact);
  }
  ASSERT_EQ(read.torque_curves.size(), 3u);
  EXPECT_EQ(read.torque_curves[2].torques, TrackingPlan::Torques::negative);
  EXPECT_EQ(read.torque_curves[1].over_velocity, true);
  EXPECT_EQ(read.torque_curves[1].values, plan.torque_curves[1].values);
  EXPECT_EQ(tracker_file_bytes(read), tracker_file_bytes(plan));
}

TEST(TrackerFile, SumsPartsAsTheWhole) {
  const std::string bytes = tracker_file_bytes(test::random_tracking_plan());
  for (const std::size_t first : {std::size_t{0}, std::size_t{8}, std::size_t{64}}) {
    tracker_file::Checksum sum;
    sum.add(bytes.data(), first);
    sum.add(bytes.data() + first, bytes.size() - first);
    EXPECT_EQ(sum.value(), tracker_file::checksum(bytes.data(), bytes.size()));
  }
}

TEST(TrackerFile, RefusesWhatIsNoFile) {
  const test::TempFolder folder;
  for (const std::string path : {"missing.bin", ""}) {
    EXPECT_THROW(Tracker::read((folder.path() / path).string()), TrackerError) << path;
  }
}

// Cut anywhere, any byte changed, anything behind it: refused with the file's name.
TEST(TrackerFile, RefusesDamage) {
  const test::TempFolder folder;
  const std::string good = tracker_file_bytes(test::random_tracking_plan(3, 2));
  std::mt19937 rng(1);
  std::vector<std::string> damaged = {"", good + '\0', good + good};
  for (int i = 0; i < 300; ++i) {
    const std::size_t at = i < 80 ? static_cast<std::size_t>(i) : rng() % good.size();
    damaged.push_back(good.substr(0, at));
    damaged.push_back(good);
    damaged.back()[at] = static_cast<char>(damaged.back()[at] ^ (1 << rng() % 8));
  }
  for (const std::string& bytes : damaged) {
    const std::string path = folder.write("tracker.bin", bytes).string();
    try {
      Tracker::read(path);
      ADD_FAILURE() << "took a damaged file of " << bytes.size() << " bytes";
    } catch (const TrackerError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(path, 0), 0u) << error.what();
    }
  }
}

// With the checksum right: sizes that lie must not lead to large allocations, reads beyond the end or plans that are
// none.
TEST(TrackerFile, RefusesSizesThatLieUnderARightChecksum) {
  const test::TempFolder folder;
  const std::string good = tracker_file_bytes(test::random_tracking_plan(3, 2));
  EXPECT_NO_THROW(Tracker::read(folder.write("tracker.bin", resealed(good)).string()));
  for (std::size_t count = 0; count < 5; ++count) {
    for (const std::uint32_t lie : {0u, 1u, 255u, 257u, 65536u, 0x7fffffffu, 0x80000000u, 0xffffffffu}) {
      std::string bytes = good;
      put(bytes, kCounts + 4 * count, lie);
      if (bytes == good) continue;
      EXPECT_THROW(Tracker::read(folder.write("tracker.bin", resealed(bytes)).string()), TrackerError)
          << "count " << count << " = " << lie;
    }
  }
  // Every word of names, segments and curves in turn set to the largest and to zero: no crash, no hang.
  for (std::size_t at = tracker_file::kHeaderBytes; at + 4 <= std::min<std::size_t>(good.size(), 600); ++at) {
    for (const std::uint32_t lie : {0u, 0x7fffffffu, 0xffffffffu}) {
      std::string bytes = good;
      put(bytes, at, lie);
      try {
        Tracker::read(folder.write("tracker.bin", resealed(bytes)).string());
      } catch (const TrackerError&) {
      }
    }
  }
}

}  // namespace
}  // namespace prowl
