#include "datasets/formats/bag/bag_chunk.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>

#include <memory>

#include "datasets/formats/text.hpp"

namespace corridor::formats {
namespace {

// What a decompressor did with its whole input.
struct Outcome {
  bool is_intact = false;
  bool has_ended = false;
  std::size_t num_taken = 0;
  std::size_t num_given = 0;
};

// `content` has room for one byte more than stated: only data that give too much use it.
Outcome inflate_bz2(std::string_view data, std::string& content) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return {};
  // bzip2's interface is older than const; it does not write to its input.
  stream.next_in = const_cast<char*>(data.data());
  stream.avail_in = static_cast<unsigned>(data.size());
  stream.next_out = content.data();
  stream.avail_out = static_cast<unsigned>(content.size());
  const int status = BZ2_bzDecompress(&stream);
  const Outcome outcome{status == BZ_OK || status == BZ_STREAM_END, status == BZ_STREAM_END,
                        data.size() - stream.avail_in, content.size() - stream.avail_out};
  BZ2_bzDecompressEnd(&stream);
  return outcome;
}

struct FreeContext {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

Outcome inflate_lz4(std::string_view data, std::string& content) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) return {};
  const std::unique_ptr<LZ4F_dctx, FreeContext> context(raw);
  Outcome outcome;
  for (;;) {
    std::size_t num_in = data.size() - outcome.num_taken;
    std::size_t num_out = content.size() - outcome.num_given;
    const std::size_t hint =
        LZ4F_decompress(context.get(), content.data() + outcome.num_given, &num_out,
                        data.data() + outcome.num_taken, &num_in, nullptr);
    if (LZ4F_isError(hint) != 0) return {};
    outcome.num_taken += num_in;
    outcome.num_given += num_out;
    outcome.has_ended = hint == 0;
    outcome.is_intact = true;
    if (outcome.has_ended || (num_in == 0 && num_out == 0)) return outcome;
  }
}

}  // namespace

Result<std::string> chunk_content(std::string_view data, std::string_view compression,
                                  std::size_t stated_size, const std::string& where) {
  const bool is_plain = compression == "none";
  if (!is_plain && compression != "bz2" && compression != "lz4") {
    return fail(ErrorCode::kUnsupported, "chunk with the compression " + quote(compression), where,
                "none, bz2 or lz4");
  }
  if (stated_size > kMaxChunkBytes) {
    return fail(ErrorCode::kResourceLimit, fmt::format("chunk of {} bytes", stated_size), where,
                fmt::format("at most {}", kMaxChunkBytes));
  }
  const std::string expected = fmt::format("the {} bytes that the chunk states", stated_size);
  if (is_plain) {
    if (data.size() == stated_size) return std::string(data);
    return fail(ErrorCode::kMalformed, fmt::format("chunk of {} bytes", data.size()), where,
                expected);
  }
  std::string content(stated_size + 1, '\0');
  const Outcome outcome =
      compression == "bz2" ? inflate_bz2(data, content) : inflate_lz4(data, content);
  if (!outcome.is_intact) {
    return fail(ErrorCode::kMalformed, fmt::format("corrupted {} data", compression), where,
                expected);
  }
  if (outcome.num_given > stated_size) {
    return fail(ErrorCode::kResourceLimit, "chunk decompresses to more than it states", where,
                expected);
  }
  if (!outcome.has_ended || outcome.num_given < stated_size) {
    return fail(ErrorCode::kMalformed,
                fmt::format("truncated {} data: {} bytes", compression, outcome.num_given), where,
                expected);
  }
  if (outcome.num_taken != data.size()) {
    return fail(ErrorCode::kMalformed,
                fmt::format("something follows the end of the {} data", compression), where,
                "the end of the chunk");
  }
  content.resize(stated_size);
  return content;
}

}  // namespace corridor::formats
