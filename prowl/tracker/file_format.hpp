#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

/// tracker.bin: a TrackingPlan as bytes, all numbers little-endian, floating point IEEE 754 double.
///
///   header   8 bytes "PROWLTRK"; uint32: version, joints (nu), contacts, segments, torque curves,
///            samples; uint64: bytes of the payload, checksum of the payload
///   payload  names of joints and contacts; a text is its length (uint32) and its bytes
///            segments: name, start and end [s] (double), samples (uint32), one byte per contact: 1
///            in contact, 0 not
///            torque curves: joint, 1 if over the velocity, plus 2 if of positive torques alone or 4
///            if of negative ones, number of values (uint32), lower, upper, values (double)
///            torque limits (nu), then q, v, tau and gains, sample after sample (double)
///
/// The file ends with the payload. Writer: prowl/plan_folder; reader: Tracker::read.
namespace prowl::tracker_file {

constexpr char kMagic[] = "PROWLTRK";
constexpr std::size_t kMagicBytes = 8;
constexpr std::uint32_t kVersion = 2;  ///< 1: curves of both torques only
constexpr std::size_t kHeaderBytes = kMagicBytes + 6 * sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
constexpr std::uint64_t kLongestFile = std::uint64_t{1} << 30;  // [bytes]

/// FNV-1a (Fowler, Noll, Vo) over words of 8 bytes, the last padded with zeros.
class Checksum {
 public:
  /// All parts but the last must be a multiple of 8 bytes.
  void add(const char* bytes, std::size_t size) {
    constexpr std::uint64_t kPrime = 0x100000001b3;
    for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, size - i < sizeof(word) ? size - i : sizeof(word));
      hash_ = (hash_ ^ word) * kPrime;
    }
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

inline std::uint64_t checksum(const char* bytes, std::size_t size) {
  Checksum sum;
  sum.add(bytes, size);
  return sum.value();
}

}  // namespace prowl::tracker_file
