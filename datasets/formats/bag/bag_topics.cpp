#include "datasets/formats/bag/bag_topics.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <utility>
#include <vector>

#include "datasets/formats/bag/topics_table.hpp"
#include "datasets/formats/toml_text.hpp"

namespace corridor::formats {
namespace {

// 24-bit encoders exist; beyond that a count of a wheel's turn is none.
constexpr std::int64_t kMaxTicksPerTurn = 1 << 24;

class TopicsReader {
 public:
  TopicsReader(const toml::table& document, std::vector<TomlProblem>& problems)
      : document_(document), problems_(problems) {}

  BagTopics read() {
    refuse_other_keys("topics", {"scan", "odometry", "imu", "joints"});
    refuse_other_keys("joints", {"left", "right", "ticks_per_turn"});
    BagTopics topics;
    topics.scan = value<std::string>("topics", "scan");
    topics.odometry = value<std::string>("topics", "odometry");
    topics.imu = value<std::string>("topics", "imu");
    topics.joints = joints();
    if (topics.joints && topics.odometry && !topics.odometry->empty()) {
      complain("topics", "joints", "wheels come from joints or from odometry, not from both");
    }
    return topics;
  }

 private:
  void complain(std::string_view table, std::string_view key, std::string_view what) {
    const std::string path = key.empty() ? std::string(table) : path_of(table, key);
    problems_.push_back({line_for(table, key), fmt::format("{}: {}", path, what)});
  }

  // What is missing is told in the line of what asks for it.
  [[nodiscard]] std::uint32_t line_for(std::string_view table, std::string_view key) const {
    for (const std::string_view place : {table, std::string_view("topics")}) {
      if (const std::uint32_t line = line_of(document_, place, key); line != 0) return line;
    }
    const std::uint32_t line = line_of(document_, "joints", key);
    return line == 0 ? document_.source().begin.line : line;
  }

  void refuse_other_keys(std::string_view table, const std::vector<std::string>& known) {
    const toml::node* node = document_.get(table);
    if (node == nullptr) return;
    if (const toml::table* keys = node->as_table()) {
      find_unknown_keys(*keys, table, known, problems_);
    } else {
      problems_.push_back(no_table(*node, table));
    }
  }

  template <class T>
  std::optional<T> value(std::string_view table, std::string_view key) {
    const auto node = document_[table][key];
    if (!node) return std::nullopt;
    T found{};
    read_field(*node.node(), path_of(table, key), found, problems_);
    return found;
  }

  std::optional<WheelJoints> joints() {
    const std::size_t num_problems = problems_.size();
    const auto topic = value<std::string>("topics", "joints");
    if (!topic) {
      if (document_.contains("joints")) complain("topics", "joints", "missing");
      return std::nullopt;
    }
    WheelJoints joints{*topic, value<std::string>("joints", "left").value_or(""),
                       value<std::string>("joints", "right").value_or(""),
                       value<std::int64_t>("joints", "ticks_per_turn").value_or(0)};
    if (problems_.size() > num_problems) return joints;  // its rules would only repeat them
    if (joints.topic.empty()) complain("topics", "joints", "empty");
    if (joints.left.empty() || joints.right.empty() || joints.left == joints.right) {
      complain("joints", "", "expected the names of two joints, left and right");
    }
    if (joints.ticks_per_turn < 1 || joints.ticks_per_turn > kMaxTicksPerTurn) {
      complain("joints", "ticks_per_turn",
               fmt::format("expected a whole number from 1 to {}", kMaxTicksPerTurn));
    }
    return joints;
  }

  const toml::table& document_;
  std::vector<TomlProblem>& problems_;
};

}  // namespace

BagTopics read_bag_topics(const toml::table& document, std::vector<TomlProblem>& problems) {
  return TopicsReader(document, problems).read();
}

Result<BagTopics> bag_topics_from_toml(std::string_view text, const std::string& where) {
  const Result<toml::table> document = parse_toml_text(text, where);
  if (!document) return tl::make_unexpected(document.error());
  std::vector<TomlProblem> problems;
  find_unknown_keys(*document, "", {"topics", "joints"}, problems);
  BagTopics topics = read_bag_topics(*document, problems);
  if (!problems.empty()) return tl::make_unexpected(to_error(where, problems));
  return topics;
}

}  // namespace corridor::formats
