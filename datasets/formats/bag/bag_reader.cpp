#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "datasets/formats/bag/bag.hpp"
#include "datasets/formats/bag/bag_framing.hpp"
#include "datasets/formats/bag/bag_layouts.hpp"
#include "datasets/formats/bag/bag_messages.hpp"
#include "datasets/formats/bag/rosbag_door.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

// The topic that each sensor is read from; empty = not read.
struct ChosenTopics {
  std::string scan;
  std::string wheels;
  std::string imu;

  [[nodiscard]] std::vector<std::string> used() const {
    std::vector<std::string> topics;
    for (const std::string& topic : {scan, wheels, imu}) {
      if (!topic.empty()) topics.push_back(topic);
    }
    return topics;
  }
};

class TopicChooser {
 public:
  TopicChooser(const BagIndex& index, const std::string& file) : index_(index), file_(file) {}

  Result<ChosenTopics> choose(const BagTopics& wanted) {
    ChosenTopics chosen;
    chosen.scan = topic(wanted.scan, BagType::kLaserScan, "scan");
    if (chosen.scan.empty()) {
      refuse(ErrorCode::kInvalid, "the bag has no scans that are read",
             "a topic of sensor_msgs/LaserScan");
    }
    chosen.wheels = wanted.joints ? topic(wanted.joints->topic, BagType::kJointState, "joints")
                                  : topic(wanted.odometry, BagType::kOdometry, "odometry");
    chosen.imu = topic(wanted.imu, BagType::kImu, "imu");
    if (error_) return tl::make_unexpected(*error_);
    return chosen;
  }

 private:
  void refuse(ErrorCode code, std::string what, std::string expected) {
    if (!error_) error_ = Error{code, std::move(what), file_, std::move(expected)};
  }

  std::string topic(const std::optional<std::string>& wanted, BagType type, const char* key) {
    if (wanted && wanted->empty()) return "";
    const std::string type_name(bag_type_info(type).name);
    std::set<std::string> of_type;
    std::set<std::string> of_other_types;
    for (const BagConnection& connection : index_.connections) {
      (connection.type == type_name ? of_type : of_other_types).insert(connection.topic);
    }
    if (wanted) {
      if (of_type.contains(*wanted) && !of_other_types.contains(*wanted)) return *wanted;
      refuse(ErrorCode::kNotFound,
             fmt::format("topic {} is not in the bag as {}", quote(*wanted), type_name),
             names_of(of_type));
      return "";
    }
    if (of_type.empty()) return "";
    if (of_type.size() == 1) return *of_type.begin();
    refuse(ErrorCode::kInvalid, fmt::format("{} topics of {}", of_type.size(), type_name),
           fmt::format("topics.{} in LOG.topics.toml: {}", key, names_of(of_type)));
    return "";
  }

  static std::string names_of(const std::set<std::string>& topics) {
    std::string names;
    for (const std::string& topic : topics) names += (names.empty() ? "" : " or ") + quote(topic);
    return names.empty() ? "a topic that it has" : names;
  }

  const BagIndex& index_;
  const std::string& file_;
  std::optional<Error> error_;
};

// Per topic its messages in the order in which rosbag gives them: by time of recording.
std::map<std::string, std::vector<BagMessage>> messages_by_topic(const BagIndex& index) {
  std::map<std::uint32_t, std::string> topic_of;
  for (const BagConnection& connection : index.connections) {
    topic_of[connection.id] = connection.topic;
  }
  std::map<std::string, std::vector<BagMessage>> messages;
  for (const BagMessage& message : index.messages) {
    messages[topic_of.at(message.connection_id)].push_back(message);
  }
  for (auto& [topic, of_topic] : messages) {
    std::stable_sort(
        of_topic.begin(), of_topic.end(),
        [](const BagMessage& a, const BagMessage& b) { return a.record_ns < b.record_ns; });
  }
  return messages;
}

struct PlacedEvent {
  SensorEvent event;
  std::uint64_t origin = 0;
  std::int64_t record_ns = 0;
};

using Streams = std::map<std::string, std::vector<PlacedEvent>>;

// Takes the head with the smallest key until no stream has any. Streams keep their own order.
void merge(Streams& streams, bool by_record_time, ParsedLog& log) {
  std::map<std::string, std::size_t> heads;
  const auto key_of = [&](const PlacedEvent& placed) {
    return by_record_time ? placed.record_ns : stamp_of(placed.event).nanoseconds;
  };
  for (;;) {
    std::vector<PlacedEvent>* next = nullptr;
    std::size_t* next_head = nullptr;
    for (auto& [topic, stream] : streams) {
      std::size_t& head = heads[topic];
      if (head == stream.size()) continue;
      if (next == nullptr || key_of(stream[head]) < key_of((*next)[*next_head])) {
        next = &stream;
        next_head = &head;
      }
    }
    if (next == nullptr) return;
    PlacedEvent& placed = (*next)[(*next_head)++];
    log.add(std::move(placed.event), placed.origin);
  }
}

// The events of each topic with their bytes: rosbag's messages are those of the framing, in order.
Result<Streams> read_streams(const BagIndex& index, const std::vector<ros1::Message>& messages,
                             const std::vector<std::string>& used, const std::string& file,
                             BagMessageReader& reader) {
  auto framed = messages_by_topic(index);
  std::map<std::string, std::size_t> num_taken;
  Streams streams;
  for (const ros1::Message& message : messages) {
    const auto& of_topic = framed[message.topic];
    std::size_t& taken = num_taken[message.topic];
    if (taken >= of_topic.size() || of_topic[taken].record_ns != message.record_ns) {
      return fail(ErrorCode::kInternal, "rosbag gives other messages than the file holds", file,
                  "the messages of its chunks");
    }
    const std::uint64_t origin = of_topic[taken++].origin;
    auto event = reader.take(message, fmt::format("{}: byte {}", file, origin));
    if (!event) return tl::make_unexpected(event.error());
    if (!*event) continue;
    streams[message.topic].push_back({std::move(**event), origin, message.record_ns});
  }
  for (const std::string& topic : used) {
    if (num_taken[topic] == framed[topic].size()) continue;
    return fail(ErrorCode::kInternal, "rosbag gives fewer messages than the file holds", file,
                fmt::format("{} of {}", framed[topic].size(), quote(topic)));
  }
  return streams;
}

void count_left_out(const BagIndex& index, const std::vector<std::string>& used, ParsedLog& log) {
  for (const BagConnection& connection : index.connections) {
    if (std::find(used.begin(), used.end(), connection.topic) != used.end()) continue;
    if (connection.num_messages == 0) continue;
    log.left_out[fmt::format("messages of {} ({}) left out", quote(connection.topic),
                             quote(connection.type))] += connection.num_messages;
  }
}

}  // namespace

Result<ParsedLog> parse_bag(std::string_view bytes, const std::filesystem::path& path,
                            const BagOptions& options) {
  const std::string file = path.string();
  const auto index = check_bag_framing(bytes, file);
  if (!index) return tl::make_unexpected(index.error());
  const auto topics = TopicChooser(*index, file).choose(options.topics);
  if (!topics) return tl::make_unexpected(topics.error());
  const auto messages = ros1::read_messages(file, topics->used());
  if (!messages) return tl::make_unexpected(messages.error());

  ParsedLog log;
  log.origin_unit = "byte";
  log.scans_state_pose = false;
  log.has_wheel_ticks_only = options.topics.joints.has_value();
  BagMessageReader reader(options.topics.joints, log);
  auto streams = read_streams(*index, *messages, topics->used(), file, reader);
  if (!streams) return tl::make_unexpected(streams.error());
  count_left_out(*index, topics->used(), log);
  merge(*streams, options.keeps_record_order, log);
  return log;
}

}  // namespace corridor::formats
