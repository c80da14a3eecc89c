#pragma once

#include <Eigen/Core>
#include <cmath>
#include <type_traits>
#include <unsupported/Eigen/AutoDiff>

/// A number with its first and second derivatives in N variables: Eigen's AutoDiffScalar of itself.
namespace prowl {

template <int N>
using FirstDerivatives = Eigen::AutoDiffScalar<Eigen::Matrix<double, N, 1>>;
template <int N>
using SecondOrder = Eigen::AutoDiffScalar<Eigen::Matrix<FirstDerivatives<N>, N, 1>>;

/// Variables at y: entry i has the derivative 1 in variable i.
template <int N>
Eigen::Matrix<SecondOrder<N>, N, 1> second_order_variables(const Eigen::Matrix<double, N, 1>& y) {
  Eigen::Matrix<SecondOrder<N>, N, 1> variables;
  for (int i = 0; i < N; ++i) {
    variables(i) = SecondOrder<N>(FirstDerivatives<N>(y(i), N, i), N, i);
    variables(i).derivatives().setZero();
    variables(i).derivatives()(i) = FirstDerivatives<N>(1.0);
  }
  return variables;
}

}  // namespace prowl

// What Eigen has for numbers and for AutoDiffScalar of numbers, but not for AutoDiffScalar of itself.
namespace Eigen {

template <int N, class Operation>
struct ScalarBinaryOpTraits<prowl::SecondOrder<N>, double, Operation> {
  using ReturnType = prowl::SecondOrder<N>;
};
template <int N, class Operation>
struct ScalarBinaryOpTraits<double, prowl::SecondOrder<N>, Operation> {
  using ReturnType = prowl::SecondOrder<N>;
};

template <class Derivatives>
using OfItself = AutoDiffScalar<typename internal::remove_all<Derivatives>::type::PlainObject>;
template <class Derivatives>
concept NestedDerivatives = !std::is_arithmetic_v<typename internal::remove_all<Derivatives>::type::Scalar>;

template <NestedDerivatives Derivatives>
OfItself<Derivatives> pow(const AutoDiffScalar<Derivatives>& x, double power) {
  using std::pow;
  const OfItself<Derivatives> at(x);
  using Inner = typename OfItself<Derivatives>::Scalar;
  return {Inner(pow(at.value(), power)), at.derivatives() * Inner(power * pow(at.value(), power - 1.0))};
}

template <NestedDerivatives Derivatives>
OfItself<Derivatives> abs(const AutoDiffScalar<Derivatives>& x) {
  const OfItself<Derivatives> at(x);
  return at.value() < 0.0 ? OfItself<Derivatives>(-at) : at;
}

template <class Derivatives>
OfItself<Derivatives> atan(const AutoDiffScalar<Derivatives>& x) {
  using std::atan;
  const OfItself<Derivatives> at(x);
  using Inner = typename OfItself<Derivatives>::Scalar;
  return {Inner(atan(at.value())), at.derivatives() * Inner(1.0 / (1.0 + at.value() * at.value()))};
}

}  // namespace Eigen
