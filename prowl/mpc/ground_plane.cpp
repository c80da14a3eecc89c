#include "prowl/mpc/ground_plane.hpp"

#include <Eigen/LU>

namespace prowl {
namespace {

/// Heights count as uncertain by so much, and slopes as level within kMostSlope beforehand: a share of the size [-].
constexpr double kHeightError = 0.02, kMostSlope = 0.3;

}  // namespace

GroundPlane::GroundPlane(int num_contacts, double size)
    : size_(size),
      places_(static_cast<std::size_t>(num_contacts), Eigen::Vector3d::Zero()),
      has_place_(static_cast<std::size_t>(num_contacts), false) {}

void GroundPlane::see(int contact, const Eigen::Vector3d& place) {
  places_[static_cast<std::size_t>(contact)] = place;
  has_place_[static_cast<std::size_t>(contact)] = true;
}

void GroundPlane::fit(double share) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (!has_place_[i]) continue;
    mean += places_[i];
    ++count;
  }
  if (count == 0) return;
  mean /= count;
  const double prior = kHeightError * size_ / kMostSlope;
  Eigen::Matrix2d square = prior * prior * Eigen::Matrix2d::Identity();
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (!has_place_[i]) continue;
    const Eigen::Vector3d off = places_[i] - mean;
    square += off.head<2>() * off.head<2>().transpose();
    moment += off.head<2>() * off.z();
  }
  const double before = height(mean.head<2>());
  slope_ += share * (square.inverse() * moment - slope_);
  centre_ << mean.head<2>(), before + share * (mean.z() - before);
}

}  // namespace prowl
