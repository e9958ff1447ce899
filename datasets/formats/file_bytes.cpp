#include "datasets/formats/file_bytes.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <memory>

namespace corridor::formats {
namespace {

constexpr int kGzipOnly = 15 + 16;  // zlib: largest window, gzip wrapper expected
constexpr int kMemoryLevel = 8;     // zlib's default
constexpr std::size_t kChunkBytes = std::size_t{1} << 16;

bool is_gzip(std::string_view bytes) {
  return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

Result<std::string> read_raw(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return fail(ErrorCode::kNotFound, "no such file", path.string());
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    return fail(ErrorCode::kUnreadable, "is not a file", path.string(), "a regular file");
  }
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > max_bytes) {
    return fail(ErrorCode::kResourceLimit, fmt::format("file of {} bytes", size), path.string(),
                fmt::format("at most {}", max_bytes));
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(error ? 0 : static_cast<std::size_t>(size), '\0');
  if (!file || error || !file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    return fail(ErrorCode::kUnreadable, "cannot be read", path.string());
  }
  return bytes;
}

// Decompresses the members of a gzip file one after the other.
class Inflater {
 public:
  Inflater(std::string_view compressed, const std::filesystem::path& path, std::size_t max_bytes)
      : compressed_(compressed), path_(path), max_bytes_(max_bytes) {}

  Result<std::string> run() {
    while (offset_ < compressed_.size()) {
      if (!is_gzip(compressed_.substr(offset_))) {
        return failure(ErrorCode::kMalformed, "something follows the end of the gzip data",
                       "the end of the file");
      }
      if (auto member = inflate_member(); !member) return tl::make_unexpected(member.error());
    }
    return std::move(content_);
  }

 private:
  struct End {
    void operator()(z_stream* stream) const {
      inflateEnd(stream);
      delete stream;
    }
  };

  tl::unexpected<Error> failure(ErrorCode code, std::string what, std::string expected) const {
    return fail(code, std::move(what),
                fmt::format("{}: byte {} (compressed)", path_.string(), offset_),
                std::move(expected));
  }

  Result<void> inflate_member() {
    std::unique_ptr<z_stream, End> stream(new z_stream{});
    if (inflateInit2(stream.get(), kGzipOnly) != Z_OK) {
      return failure(ErrorCode::kInternal, "zlib cannot start", "");
    }
    std::string chunk(kChunkBytes, '\0');
    int status = Z_OK;
    while (status != Z_STREAM_END) {
      const std::size_t available = std::min<std::size_t>(compressed_.size() - offset_, 1u << 30);
      // zlib's interface is older than const; it does not write to its input.
      stream->next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed_.data() + offset_));
      stream->avail_in = static_cast<uInt>(available);
      stream->next_out = reinterpret_cast<Bytef*>(chunk.data());
      stream->avail_out = static_cast<uInt>(chunk.size());
      status = inflate(stream.get(), Z_NO_FLUSH);
      offset_ += available - stream->avail_in;
      const std::size_t produced = chunk.size() - stream->avail_out;
      if (auto kept = keep(status, produced, chunk); !kept) return kept;
    }
    return {};
  }

  Result<void> keep(int status, std::size_t produced, const std::string& chunk) {
    if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR) {
      return failure(ErrorCode::kMalformed, "corrupted gzip data", "intact data and checksum");
    }
    if (content_.size() + produced > max_bytes_) {
      return failure(ErrorCode::kResourceLimit, "decompresses to more than the limit",
                     fmt::format("at most {} bytes", max_bytes_));
    }
    content_.append(chunk, 0, produced);
    if (status != Z_STREAM_END && produced == 0 && offset_ == compressed_.size()) {
      return failure(ErrorCode::kMalformed, "truncated gzip data", "the end of the stream");
    }
    return {};
  }

  std::string_view compressed_;
  const std::filesystem::path& path_;
  std::size_t max_bytes_;
  std::size_t offset_ = 0;
  std::string content_;
};

}  // namespace

Result<std::string> read_file_bytes(const std::filesystem::path& path, std::size_t max_bytes) {
  auto raw = read_raw(path, max_bytes);
  if (!raw || !is_gzip(*raw)) return raw;
  return Inflater(*raw, path, max_bytes).run();
}

Result<std::string> gzip(std::string_view content) {
  z_stream stream{};
  if (content.size() > std::numeric_limits<uInt>::max() ||
      deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipOnly, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    return fail(ErrorCode::kInternal, fmt::format("zlib cannot compress {} bytes", content.size()));
  }
  std::string compressed(deflateBound(&stream, static_cast<uLong>(content.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(compressed.data());
  stream.avail_out = static_cast<uInt>(compressed.size());
  const int status = deflate(&stream, Z_FINISH);
  compressed.resize(compressed.size() - stream.avail_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) return fail(ErrorCode::kInternal, "zlib cannot compress");
  return compressed;
}

}  // namespace corridor::formats
