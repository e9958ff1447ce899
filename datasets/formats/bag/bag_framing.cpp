#include "datasets/formats/bag/bag_framing.hpp"

#include <fmt/format.h>

#include <map>

#include "datasets/formats/bag/bag_chunk.hpp"
#include "datasets/formats/bag/bag_entries.hpp"
#include "datasets/formats/bag/bag_layouts.hpp"
#include "datasets/formats/bag/bag_records.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::string_view kMagicOfAnyVersion = "#ROSBAG V";
constexpr std::uint8_t kOpMessage = 0x02;
constexpr std::uint8_t kOpFileHeader = 0x03;
constexpr std::uint8_t kOpIndex = 0x04;
constexpr std::uint8_t kOpChunk = 0x05;
constexpr std::uint8_t kOpChunkInfo = 0x06;
constexpr std::uint8_t kOpConnection = 0x07;
constexpr std::size_t kMaxConnections = 4096;

struct Connection {
  std::string topic;
  std::string type;
  std::size_t num_messages = 0;
  bool is_listed = false;  // behind the chunks, too
};

class BagFraming {
 public:
  BagFraming(std::string_view bytes, const std::string& file) : file_{bytes, file} {}

  Result<BagIndex> run() {
    for (const auto step :
         {&BagFraming::take_magic, &BagFraming::take_file_header, &BagFraming::take_chunks,
          &BagFraming::take_connections, &BagFraming::take_chunk_infos}) {
      if (auto taken = (this->*step)(); !taken) return tl::make_unexpected(taken.error());
    }
    if (offset_ != file_.bytes.size()) {
      return fail(ErrorCode::kMalformed, "something follows the last record", file_.at(offset_),
                  "the end of the file");
    }
    for (const auto& [id, connection] : connections_) {
      index_.connections.push_back(
          {id, connection.topic, connection.type, connection.num_messages});
    }
    return std::move(index_);
  }

 private:
  struct Chunk {
    bool has_info = false;
    MessageCounts counts;
  };

  Result<void> take_magic() {
    if (file_.bytes.starts_with(kMagic)) {
      offset_ = kMagic.size();
      return {};
    }
    const bool is_bag = file_.bytes.starts_with(kMagicOfAnyVersion);
    return fail(is_bag ? ErrorCode::kUnsupported : ErrorCode::kMalformed,
                is_bag ? "bag of another version " + quote(file_.bytes.substr(0, kMagic.size() - 1))
                       : "no ROS bag",
                file_.at(0), "'#ROSBAG V2.0' in the first line");
  }

  // The next record, of the one kind that may stand here.
  Result<BagRecord> take(const BagBytes& from, std::size_t offset, std::uint8_t op,
                         const char* what) const {
    if (offset >= from.bytes.size()) {
      return fail(ErrorCode::kMalformed, "the file ends early", from.at(offset), what);
    }
    auto record = take_bag_record(from, offset);
    if (record && record->op != op) {
      return fail(ErrorCode::kMalformed, fmt::format("record of kind {}", record->op),
                  record->where, fmt::format("{} (kind {})", what, op));
    }
    return record;
  }

  Result<void> take_file_header() {
    const auto record = take(file_, offset_, kOpFileHeader, "the file's header");
    if (!record) return tl::make_unexpected(record.error());
    const auto index_position = u64_field(record->fields, "index_pos", record->where);
    if (!index_position) return tl::make_unexpected(index_position.error());
    const auto num_connections = u32_field(record->fields, "conn_count", record->where);
    if (!num_connections) return tl::make_unexpected(num_connections.error());
    const auto num_chunks = u32_field(record->fields, "chunk_count", record->where);
    if (!num_chunks) return tl::make_unexpected(num_chunks.error());
    const auto encryptor = text_field(record->fields, "encryptor", record->where);
    if (encryptor && !encryptor->empty()) {
      return fail(ErrorCode::kUnsupported, "bag encrypted by " + quote(*encryptor), record->where,
                  "a bag that is not");
    }
    offset_ = record->end;
    if (*index_position == 0) {
      return fail(ErrorCode::kMalformed, "the bag was not closed: it has no index", record->where,
                  "a bag after 'rosbag reindex'");
    }
    if (*index_position < offset_ || *index_position > file_.bytes.size()) {
      return fail(
          ErrorCode::kMalformed, fmt::format("index at byte {}", *index_position), record->where,
          fmt::format("one from {} to {}, the end of the file", offset_, file_.bytes.size()));
    }
    index_position_ = static_cast<std::size_t>(*index_position);
    num_connections_ = *num_connections;
    num_chunks_ = *num_chunks;
    return {};
  }

  Result<void> take_chunks() {
    while (offset_ < index_position_) {
      const auto record = take(file_, offset_, kOpChunk, "a chunk");
      if (!record) return tl::make_unexpected(record.error());
      offset_ = record->end;
      const auto messages = take_chunk(*record);
      if (!messages) return tl::make_unexpected(messages.error());
      for (const auto& [id, offsets] : *messages) {
        chunks_[record->begin].counts[id] = static_cast<std::uint32_t>(offsets.size());
      }
      if (auto indexed = take_indices(*messages); !indexed) return indexed;
    }
    if (offset_ == index_position_) return {};
    return fail(ErrorCode::kMalformed, "a chunk's index goes on behind the begin of the index",
                file_.at(index_position_), fmt::format("its end at byte {}", index_position_));
  }

  Result<ChunkMessages> take_chunk(const BagRecord& record) {
    const auto compression = text_field(record.fields, "compression", record.where);
    if (!compression) return tl::make_unexpected(compression.error());
    const auto size = u32_field(record.fields, "size", record.where);
    if (!size) return tl::make_unexpected(size.error());
    num_content_bytes_ += *size;
    if (num_content_bytes_ > kMaxFileBytes) {
      return fail(ErrorCode::kResourceLimit,
                  fmt::format("chunks of {} bytes in all", num_content_bytes_), record.where,
                  fmt::format("at most {}", kMaxFileBytes));
    }
    const auto content = chunk_content(record.data, *compression, *size, record.where);
    if (!content) return tl::make_unexpected(content.error());
    chunks_.emplace(record.begin, Chunk{});
    const BagBytes inside{*content, fmt::format("{}: chunk at byte {}", file_.name, record.begin)};
    const bool is_plain = *compression == "none";
    ChunkMessages messages;
    for (std::size_t offset = 0; offset < content->size();) {
      const auto inner = take_bag_record(inside, offset);
      if (!inner) return tl::make_unexpected(inner.error());
      if (inner->op == kOpConnection) {
        auto taken = take_connection(inside, *inner, false);
        if (!taken) return tl::make_unexpected(taken.error());
      } else if (inner->op == kOpMessage) {
        auto taken = take_message(inside, *inner,
                                  is_plain ? record.data_begin + offset : record.begin, messages);
        if (!taken) return tl::make_unexpected(taken.error());
      } else {
        return fail(ErrorCode::kMalformed, fmt::format("record of kind {} in a chunk", inner->op),
                    inner->where, "a connection (kind 7) or a message (kind 2)");
      }
      offset = inner->end;
    }
    return messages;
  }

  Result<void> take_connection(const BagBytes& from, const BagRecord& record, bool is_listing) {
    const auto id = u32_field(record.fields, "conn", record.where);
    if (!id) return tl::make_unexpected(id.error());
    const auto topic = text_field(record.fields, "topic", record.where);
    if (!topic) return tl::make_unexpected(topic.error());
    const auto data = take_bag_fields(from, record.data_begin, record.end);
    if (!data) return tl::make_unexpected(data.error());
    const auto type = text_field(*data, "type", record.where);
    if (!type) return tl::make_unexpected(type.error());
    const auto md5 = text_field(*data, "md5sum", record.where);
    if (!md5) return tl::make_unexpected(md5.error());
    const auto definition = text_field(*data, "message_definition", record.where);
    if (!definition) return tl::make_unexpected(definition.error());
    if (const auto known = bag_type_of(*type); known && known->md5 != *md5) {
      return fail(ErrorCode::kUnsupported,
                  fmt::format("{} with the MD5 sum {}", known->name, quote(*md5)), record.where,
                  std::string(known->md5));
    }
    const auto [at, is_new] =
        connections_.try_emplace(*id, Connection{std::string(*topic), std::string(*type)});
    Connection& connection = at->second;
    const bool is_same = connection.topic == *topic && connection.type == *type;
    if (!is_same || (is_listing && connection.is_listed)) {
      return fail(ErrorCode::kInvalid,
                  fmt::format("connection {} stands for {} already", *id, quote(connection.topic)),
                  record.where, "one topic and type per connection");
    }
    connection.is_listed = connection.is_listed || is_listing;
    if (connections_.size() > kMaxConnections) {
      return fail(ErrorCode::kResourceLimit, "too many connections", record.where,
                  fmt::format("at most {}", kMaxConnections));
    }
    return {};
  }

  Result<void> take_message(const BagBytes& inside, const BagRecord& record, std::size_t origin,
                            ChunkMessages& messages) {
    const auto id = u32_field(record.fields, "conn", record.where);
    if (!id) return tl::make_unexpected(id.error());
    const auto time_ns = time_field(record.fields, "time", record.where);
    if (!time_ns) return tl::make_unexpected(time_ns.error());
    const auto connection = connections_.find(*id);
    if (connection == connections_.end()) {
      return fail(ErrorCode::kInvalid, fmt::format("message of the unknown connection {}", *id),
                  record.where, "a connection that a record before it describes");
    }
    if (const auto known = bag_type_of(connection->second.type)) {
      auto laid_out = check_message_layout(known->type, inside, record.data_begin, record.end);
      if (!laid_out) return laid_out;
    }
    ++connection->second.num_messages;
    index_.messages.push_back({*id, *time_ns, origin});
    messages[*id][static_cast<std::uint32_t>(record.begin)] = *time_ns;
    return {};
  }

  // One index record per connection that has messages in the chunk.
  Result<void> take_indices(const ChunkMessages& messages) {
    ChunkMessages missing = messages;
    while (!missing.empty()) {
      const auto record = take(file_, offset_, kOpIndex, "the index of the chunk before");
      if (!record) return tl::make_unexpected(record.error());
      offset_ = record->end;
      const auto id = u32_field(record->fields, "conn", record->where);
      if (!id) return tl::make_unexpected(id.error());
      const auto num_entries = entry_count(*record, kIndexEntryBytes);
      if (!num_entries) return tl::make_unexpected(num_entries.error());
      const auto of_connection = missing.find(*id);
      if (of_connection == missing.end() || of_connection->second.size() != *num_entries) {
        return fail(
            ErrorCode::kInvalid,
            fmt::format("index of {} messages of connection {}", *num_entries, *id), record->where,
            fmt::format("{}", of_connection == missing.end() ? std::size_t{0}
                                                             : of_connection->second.size()));
      }
      auto matched = match_index_entries(*record, file_, of_connection->second);
      if (!matched) return matched;
      missing.erase(of_connection);
    }
    return {};
  }

  Result<void> take_connections() {
    for (std::uint32_t i = 0; i < num_connections_; ++i) {
      const auto record = take(file_, offset_, kOpConnection, "a connection");
      if (!record) return tl::make_unexpected(record.error());
      offset_ = record->end;
      if (auto taken = take_connection(file_, *record, true); !taken) return taken;
    }
    for (const auto& [id, connection] : connections_) {
      if (connection.is_listed) continue;
      return fail(ErrorCode::kInvalid, fmt::format("connection {} is in no list", id),
                  file_.at(index_position_),
                  fmt::format("all {} connections of the chunks", connections_.size()));
    }
    return {};
  }

  Result<void> take_chunk_infos() {
    if (num_chunks_ != chunks_.size()) {
      return fail(ErrorCode::kInvalid, fmt::format("the header states {} chunks", num_chunks_),
                  file_.at(kMagic.size()), fmt::format("{}", chunks_.size()));
    }
    for (std::uint32_t i = 0; i < num_chunks_; ++i) {
      const auto record = take(file_, offset_, kOpChunkInfo, "a chunk's info");
      if (!record) return tl::make_unexpected(record.error());
      offset_ = record->end;
      if (auto taken = take_chunk_info(*record); !taken) return taken;
    }
    return {};
  }

  Result<void> take_chunk_info(const BagRecord& record) {
    const auto position = u64_field(record.fields, "chunk_pos", record.where);
    if (!position) return tl::make_unexpected(position.error());
    for (const char* name : {"start_time", "end_time"}) {
      const auto time_ns = time_field(record.fields, name, record.where);
      if (!time_ns) return tl::make_unexpected(time_ns.error());
    }
    const auto num_entries = entry_count(record, kChunkInfoEntryBytes);
    if (!num_entries) return tl::make_unexpected(num_entries.error());
    const auto chunk = chunks_.find(*position);
    if (chunk != chunks_.end() && !chunk->second.has_info) {
      chunk->second.has_info = true;
      return match_chunk_counts(record, chunk->second.counts);
    }
    return fail(ErrorCode::kInvalid, fmt::format("info on a chunk at byte {}", *position),
                record.where, "the byte of a chunk, each once");
  }

  BagBytes file_;
  std::size_t offset_ = 0;
  std::size_t index_position_ = 0;
  std::uint32_t num_connections_ = 0;
  std::uint32_t num_chunks_ = 0;
  std::size_t num_content_bytes_ = 0;
  std::map<std::uint32_t, Connection> connections_;
  std::map<std::uint64_t, Chunk> chunks_;  // by the byte where each begins
  BagIndex index_;
};

}  // namespace

Result<BagIndex> check_bag_framing(std::string_view bytes, const std::string& file) {
  return BagFraming(bytes, file).run();
}

}  // namespace corridor::formats
