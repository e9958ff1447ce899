#include "datasets/formats/bag/bag_topics.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <vector>

#include "datasets/formats/toml_text.hpp"

namespace corridor::formats {
namespace {

// 24-bit encoders exist; beyond that a count of a wheel's turn is none.
constexpr std::int64_t kMaxTicksPerTurn = 1 << 24;

class TopicsReader {
 public:
  explicit TopicsReader(const toml::table& document) : document_(document) {}

  BagTopics read() {
    for (const auto& [key, node] : document_) {
      const bool is_known = key.str() == "topics" || key.str() == "joints";
      if (!is_known || !node.is_table()) complain(key.str(), "expected [topics] or [joints]");
    }
    refuse_other_keys("topics", std::array{"scan", "odometry", "imu", "joints"});
    refuse_other_keys("joints", std::array{"left", "right", "ticks_per_turn"});
    BagTopics topics;
    topics.scan = text("topics", "scan");
    topics.odometry = text("topics", "odometry");
    topics.imu = text("topics", "imu");
    topics.joints = joints();
    if (topics.joints && topics.odometry && !topics.odometry->empty()) {
      complain("topics.joints", "wheels come from joints or from odometry, not from both");
    }
    return topics;
  }

  [[nodiscard]] const std::vector<std::string>& wrong() const { return wrong_; }

 private:
  void complain(std::string_view key, std::string_view what) {
    wrong_.push_back(fmt::format("{}: {}", key, what));
  }

  template <std::size_t n>
  void refuse_other_keys(std::string_view table, const std::array<const char*, n>& known) {
    const toml::table* keys = document_[table].as_table();
    if (keys == nullptr) return;
    for (const auto& [key, node] : *keys) {
      if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
        complain(fmt::format("{}.{}", table, key.str()), "unknown key");
      }
    }
  }

  std::optional<std::string> text(std::string_view table, std::string_view key) {
    const auto node = document_[table][key];
    if (!node) return std::nullopt;
    auto value = node.value<std::string>();
    if (!value) complain(fmt::format("{}.{}", table, key), "not a text");
    return value;
  }

  std::optional<WheelJoints> joints() {
    const auto topic = text("topics", "joints");
    if (!topic) {
      if (document_.contains("joints")) complain("topics.joints", "missing");
      return std::nullopt;
    }
    // Exactly an integer: toml++ casts a float of any size to one before it looks at it.
    const auto ticks = document_["joints"]["ticks_per_turn"].value_exact<std::int64_t>();
    WheelJoints joints{*topic, text("joints", "left").value_or(""),
                       text("joints", "right").value_or(""), ticks.value_or(0)};
    if (joints.topic.empty()) complain("topics.joints", "empty");
    if (joints.left.empty() || joints.right.empty() || joints.left == joints.right) {
      complain("joints", "expected the names of two joints, left and right");
    }
    if (joints.ticks_per_turn < 1 || joints.ticks_per_turn > kMaxTicksPerTurn) {
      complain("joints.ticks_per_turn",
               fmt::format("expected a whole number from 1 to {}", kMaxTicksPerTurn));
    }
    return joints;
  }

  const toml::table& document_;
  std::vector<std::string> wrong_;
};

}  // namespace

Result<BagTopics> bag_topics_from_toml(std::string_view text, const std::string& where) {
  const Result<toml::table> document = parse_toml_text(text, where);
  if (!document) return tl::make_unexpected(document.error());
  TopicsReader reader(*document);
  BagTopics topics = reader.read();
  if (reader.wrong().empty()) return topics;
  return fail(ErrorCode::kInvalid, fmt::format("{}", fmt::join(reader.wrong(), "; ")), where,
              "topics of a bag");
}

}  // namespace corridor::formats
