#include "prowl/nlp/nlp_solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "prowl/error.hpp"

namespace prowl {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(SolveStatus, HasAWordOfItsOwnForEveryValue) {
  std::set<std::string> words;
  for (int i = 0; i <= static_cast<int>(SolveStatus::solver_failed); ++i) {
    words.insert(to_string(static_cast<SolveStatus>(i)));
  }
  EXPECT_EQ(words.size(), 7u);
  EXPECT_EQ(words.count("unknown"), 0u);
  EXPECT_STREQ(to_string(SolveStatus::iteration_limit), "iteration_limit");
}

TEST(SolverOptions, DefaultsAreValid) { EXPECT_NO_THROW(validate(SolverOptions())); }

TEST(SolverOptions, NamesWhatMakesNoSense) {
  for (const double tolerance : {-1.0, 0.0, 1.0, double{NAN}}) {
    SolverOptions options;
    options.tolerance = tolerance;
    EXPECT_THAT([&] { validate(options); }, ThrowsMessage<InputError>(HasSubstr("tolerance")));
  }
  for (const double seconds : {-1.0, 0.0, double{NAN}}) {
    SolverOptions options;
    options.max_seconds = seconds;
    EXPECT_THAT([&] { validate(options); }, ThrowsMessage<InputError>(HasSubstr("max_seconds")));
  }
  SolverOptions options;
  options.max_iterations = -1;
  EXPECT_THAT([&] { validate(options); }, ThrowsMessage<InputError>(HasSubstr("max_iterations")));
}

}  // namespace
}  // namespace prowl
