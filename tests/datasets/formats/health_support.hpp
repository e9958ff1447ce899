// What the tests of logs' health share: logs changed, reports searched.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "datasets/formats/log_health.hpp"

namespace corridor::formats::test {

template <class T>
void change_each(SensorLog& log, const std::function<void(T&)>& change) {
  for (SensorEvent& event : log.events) {
    if (T* reading = std::get_if<T>(&event)) change(*reading);
  }
}

inline std::string all_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

inline void expect_suspicion(const SensorLog& log, const std::string& part) {
  const std::string said = all_lines(examine(log).suspicions);
  EXPECT_NE(said.find(part), std::string::npos) << part << " in " << said;
}

}  // namespace corridor::formats::test
