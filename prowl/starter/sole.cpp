#include "prowl/starter/sole.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/multi_point.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>

namespace prowl {
namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Polygon = bg::model::polygon<Point>;

constexpr double kLayer = 2e-3;       // [m]: tolerance for rounded edges and mesh triangles
constexpr double kLayerShare = 0.02;  // of the foot's length
constexpr double kLeast = 0.02;       // [m]
constexpr double kDrawnIn = 0.97;     // edges carry no load
constexpr int kSteps = 40;            // search steps per side of the rectangle

std::optional<Polygon> hull_of_lowest(const Eigen::Matrix3Xd& points) {
  const double lowest = points.row(2).minCoeff();
  const double length = std::max(points.row(0).maxCoeff() - points.row(0).minCoeff(),
                                 points.row(1).maxCoeff() - points.row(1).minCoeff());
  const double layer = kLayer + kLayerShare * length;
  bg::model::multi_point<Point> low;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points(2, i) <= lowest + layer) bg::append(low, Point(points(0, i), points(1, i)));
  }
  Polygon hull;
  bg::convex_hull(low, hull);
  if (bg::area(hull) <= 0.0) return std::nullopt;
  return hull;
}

bool contains(const Polygon& hull, const Rectangle& r) {
  for (const double x : {r.lower.x(), r.upper.x()}) {
    for (const double y : {r.lower.y(), r.upper.y()}) {
      if (!bg::covered_by(Point(x, y), hull)) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<Rectangle> find_sole(const Eigen::Matrix3Xd& points) {
  if (points.cols() < 3) return std::nullopt;
  const auto hull = hull_of_lowest(points);
  if (!hull) return std::nullopt;
  bg::model::box<Point> box{};
  bg::envelope(*hull, box);
  const Eigen::Vector2d lower(box.min_corner().x(), box.min_corner().y()),
      upper(box.max_corner().x(), box.max_corner().y());
  // Feet are symmetrical across but not along: both ends of the length are free, but only half the
  // width.
  const Eigen::Vector2d middle = 0.5 * (lower + upper), edges = upper - lower;
  std::optional<Rectangle> best;
  double best_area = 0.0;
  for (int back = 0; back < kSteps; ++back) {
    for (int front = kSteps; front > back; --front) {
      for (int half = kSteps; half > 0; --half) {
        const double width = edges.y() * half / kSteps, x0 = lower.x() + edges.x() * back / kSteps,
                     x1 = lower.x() + edges.x() * front / kSteps;
        if ((x1 - x0) * width <= best_area) break;
        const Rectangle r{{x0, middle.y() - 0.5 * width}, {x1, middle.y() + 0.5 * width}};
        // Rounding may move a corner on the hull outside.
        const Eigen::Vector2d center = 0.5 * (r.lower + r.upper), in = (1.0 - 1e-9) * (r.upper - center);
        if (!contains(*hull, {center - in, center + in})) continue;
        best = r;
        best_area = (x1 - x0) * width;
        break;
      }
    }
  }
  if (!best) return std::nullopt;
  const Eigen::Vector2d center = 0.5 * (best->lower + best->upper), half = 0.5 * kDrawnIn * (best->upper - best->lower);
  if (2.0 * half.minCoeff() < kLeast) return std::nullopt;
  return Rectangle{center - half, center + half};
}

}  // namespace prowl
