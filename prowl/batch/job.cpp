#include "prowl/batch/job.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <random>
#include <sstream>

#include "prowl/batch/key_path.hpp"
#include "prowl/error.hpp"

namespace prowl {

namespace {

/// Own numbers for each draw of each motion, so that another draw in the job changes none of the others.
std::mt19937_64 random_of(const Job& job, int index, std::size_t draw) {
  std::seed_seq seed{static_cast<std::uint32_t>(job.seed), static_cast<std::uint32_t>(job.seed >> 32),
                     static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(draw)};
  return std::mt19937_64(seed);
}

double drawn_number(const Draw& draw, std::mt19937_64& random) {
  using Uniform = boost::random::uniform_real_distribution<double>;
  constexpr double kDeviations = 3.0;
  switch (draw.kind) {
    case Draw::Kind::log_uniform: return std::exp(Uniform(std::log(draw.first), std::log(draw.second))(random));
    case Draw::Kind::normal: {
      boost::random::normal_distribution<double> standard;
      double value = standard(random);
      while (std::abs(value) > kDeviations) value = standard(random);
      return draw.first + draw.second * value;
    }
    default: return Uniform(draw.first, draw.second)(random);
  }
}

std::size_t drawn_choice(const Draw& draw, std::mt19937_64& random) {
  return boost::random::uniform_int_distribution<std::size_t>(0, draw.choices.size() - 1)(random);
}

}  // namespace

std::vector<DrawnValue> drawn_values(const Job& job, int index) {
  std::vector<DrawnValue> values;
  for (std::size_t i = 0; i < job.draws.size(); ++i) {
    const Draw& draw = job.draws[i];
    std::mt19937_64 random = random_of(job, index, i);
    if (draw.kind == Draw::Kind::one_of) {
      values.push_back(draw.values[drawn_choice(draw, random)]);
    } else {
      values.emplace_back(drawn_number(draw, random));
    }
  }
  return values;
}

std::string drawn_task_text(const Job& job, int index) {
  toml::table task = toml::parse(job.task_file.text);
  for (std::size_t i = 0; i < job.draws.size(); ++i) {
    const Draw& draw = job.draws[i];
    std::mt19937_64 random = random_of(job, index, i);
    const std::string value = draw.kind == Draw::Kind::one_of ? draw.choices[drawn_choice(draw, random)]
                                                              : toml_number(drawn_number(draw, random));
    for (const std::string& key : draw.keys) set_at(task, key, value);
  }
  return toml_text(task);
}

}  // namespace prowl
