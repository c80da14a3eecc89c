#include "prowl/batch/job.hpp"

#include <toml++/toml.h>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <random>
#include <utility>

#include "prowl/batch/key_path.hpp"

namespace prowl {

namespace {

/// Own numbers for each draw of each motion, so that another draw in the job changes none of the others.
std::mt19937_64 random_of(const Job& job, int index, std::size_t draw) {
  std::seed_seq seed{static_cast<std::uint32_t>(job.seed), static_cast<std::uint32_t>(job.seed >> 32),
                     static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(draw)};
  return std::mt19937_64(seed);
}

constexpr double kDeviations = 3.0;  // from the mean, at most

double drawn_number(const Draw& draw, std::mt19937_64& random) {
  using Uniform = boost::random::uniform_real_distribution<double>;
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

/// In the order of the draws.
std::vector<Drawn> drawn_for(const Job& job, int index) {
  std::vector<Drawn> all;
  for (std::size_t i = 0; i < job.draws.size(); ++i) {
    const Draw& draw = job.draws[i];
    std::mt19937_64 random = random_of(job, index, i);
    if (draw.kind == Draw::Kind::one_of) {
      all.push_back(
          draw.choices[boost::random::uniform_int_distribution<std::size_t>(0, draw.choices.size() - 1)(random)]);
    } else {
      const double number = drawn_number(draw, random);
      all.push_back({number, toml_number(number)});
    }
  }
  return all;
}

}  // namespace

std::vector<std::string> end_texts(const Draw& draw) {
  std::vector<std::string> texts;
  for (const Drawn& choice : draw.choices) texts.push_back(choice.text);
  if (draw.kind == Draw::Kind::one_of) return texts;
  const double away = kDeviations * draw.second;
  const bool is_normal = draw.kind == Draw::Kind::normal;
  return {toml_number(is_normal ? draw.first - away : draw.first),
          toml_number(is_normal ? draw.first + away : draw.second)};
}

std::vector<DrawnValue> drawn_values(const Job& job, int index) {
  std::vector<DrawnValue> values;
  for (Drawn& drawn : drawn_for(job, index)) values.push_back(std::move(drawn.value));
  return values;
}

std::string drawn_task_text(const Job& job, int index) {
  toml::table task = toml::parse(job.task_file.text);
  const std::vector<Drawn> drawn = drawn_for(job, index);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    for (const std::string& key : job.draws[i].keys) set_at(task, key, drawn[i].text);
  }
  return toml_text(task);
}

}  // namespace prowl
