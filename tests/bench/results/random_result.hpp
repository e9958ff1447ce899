// A result record with every field drawn at random, for round trips.
#pragma once

#include <rapidcheck.h>

#include <bit>
#include <cmath>
#include <string>

#include "bench/results/result_keys.hpp"

namespace corridor::results {

inline std::string draw_text() {
  return *rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '~'));
}

inline void draw(std::string& value) { value = draw_text(); }
inline void draw(CaseStatus& value) { value = static_cast<CaseStatus>(*rc::gen::inRange(0, 7)); }
inline void draw(int& value) { value = *rc::gen::arbitrary<int>(); }
inline void draw(std::int64_t& value) { value = *rc::gen::arbitrary<std::int64_t>(); }
inline void draw(std::uint64_t& value) { value = *rc::gen::arbitrary<std::uint64_t>(); }

// Any finite double, by its bits.
inline void draw(double& value) {
  value = std::bit_cast<double>(*rc::gen::arbitrary<std::uint64_t>());
  if (!std::isfinite(value)) value = *rc::gen::arbitrary<double>();
  if (!std::isfinite(value)) value = 0;
}

template <class T>
void draw(std::map<std::string, T>& values);

template <class T>
void draw(std::optional<T>& value) {
  value.reset();
  if (*rc::gen::arbitrary<bool>()) draw(value.emplace());
}

inline void draw(KeyDistance& key) {
  draw(key.true_m), draw(key.measured_m), draw(key.error_m), draw(key.sigma_m), draw(key.status);
}
inline void draw(KeyAngle& key) {
  draw(key.true_deg), draw(key.measured_deg), draw(key.error_deg), draw(key.sigma_deg);
  draw(key.status);
}
inline void draw(KeyDistances& keys) { draw(keys.a), draw(keys.b), draw(keys.c), draw(keys.alpha); }
inline void draw(StageTimes& stage) {
  draw(stage.name), draw(stage.count), draw(stage.total_s), draw(stage.p50_us);
  draw(stage.p95_us), draw(stage.p99_us), draw(stage.max_us);
}

template <class T>
void draw(std::vector<T>& values) {
  values.resize(*rc::gen::inRange<std::size_t>(0, 4));
  for (T& value : values) draw(value);
}

template <class T>
void draw(std::map<std::string, T>& values) {
  values.clear();
  const int num_values = *rc::gen::inRange(0, 4);
  for (int i = 0; i < num_values; ++i) draw(values[draw_text()]);
}

inline RunResult draw_result() {
  RunResult result;
  visit_keys(result, [](const ResultKey&, auto& field) { draw(field); });
  return result;
}

}  // namespace corridor::results
