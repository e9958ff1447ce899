#include "datasets/formats/file_bytes.hpp"

#include <gtest/gtest.h>

#include "datasets/formats/atomic_file.hpp"
#include "tests/datasets/formats/formats_support.hpp"

namespace corridor::formats {
namespace {

using test::read_text;
using test::ScratchFolder;
using test::write_text;

std::string sample_text() {
  std::string text;
  for (int i = 0; i < 500; ++i) text += std::to_string(i * i) + (i % 7 == 0 ? "\n" : " ");
  return text;
}

TEST(FileBytes, GzipAndPlainFilesReadAlike) {
  const ScratchFolder folder;
  write_text(folder / "plain", sample_text());
  write_text(folder / "packed", *gzip(sample_text()));
  EXPECT_EQ(*read_file_bytes(folder / "plain"), sample_text());
  EXPECT_EQ(*read_file_bytes(folder / "packed"), sample_text());
}

TEST(FileBytes, EqualContentCompressesToEqualBytes) {
  EXPECT_EQ(*gzip(sample_text()), *gzip(sample_text()));
}

TEST(FileBytes, GzipTruncatedAnywhereIsAnError) {
  const ScratchFolder folder;
  const std::string packed = *gzip(sample_text());
  for (std::size_t length = 2; length < packed.size(); length += 3) {
    write_text(folder / "cut", packed.substr(0, length));
    const auto bytes = read_file_bytes(folder / "cut");
    ASSERT_FALSE(bytes.has_value()) << "cut at byte " << length;
    EXPECT_EQ(bytes.error().code, ErrorCode::kMalformed);
  }
}

TEST(FileBytes, GzipWithAFlippedBitNeverReadsAsOtherContent) {
  const ScratchFolder folder;
  const std::string packed = *gzip(sample_text());
  for (std::size_t byte = 0; byte < packed.size(); byte += 3) {
    std::string flipped = packed;
    flipped[byte] = static_cast<char>(flipped[byte] ^ 0x10);
    write_text(folder / "flipped", flipped);
    const auto bytes = read_file_bytes(folder / "flipped");
    // Header bytes such as the operating system's code carry no content; a lost magic number makes
    // the file a plain one.
    if (bytes && byte >= 2) {
      EXPECT_EQ(*bytes, sample_text()) << "bit flipped in byte " << byte;
    }
  }
}

TEST(FileBytes, SomethingBehindGzipDataIsAnError) {
  const ScratchFolder folder;
  write_text(folder / "tail", *gzip("abc") + "garbage");
  const auto bytes = read_file_bytes(folder / "tail");
  ASSERT_FALSE(bytes.has_value());
  EXPECT_NE(bytes.error().to_line().find("follows the end"), std::string::npos);
}

TEST(FileBytes, GzipMembersOneAfterTheOtherAreOneFile) {
  const ScratchFolder folder;
  write_text(folder / "two", *gzip("abc") + *gzip("def"));
  EXPECT_EQ(*read_file_bytes(folder / "two"), "abcdef");
}

TEST(FileBytes, ABombStopsAtTheLimit) {
  const ScratchFolder folder;
  write_text(folder / "bomb", *gzip(std::string(10'000'000, 'a')));
  const auto bytes = read_file_bytes(folder / "bomb", 1'000'000);
  ASSERT_FALSE(bytes.has_value());
  EXPECT_EQ(bytes.error().code, ErrorCode::kResourceLimit);
}

TEST(FileBytes, AMissingFileOrAFolderIsAnError) {
  const ScratchFolder folder;
  EXPECT_EQ(read_file_bytes(folder / "none").error().code, ErrorCode::kNotFound);
  EXPECT_EQ(read_file_bytes(folder.path()).error().code, ErrorCode::kUnreadable);
}

TEST(AtomicFile, ReplacesTheOldContent) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a", "old"));
  ASSERT_TRUE(write_file_atomically(folder / "a", "new"));
  EXPECT_EQ(read_text(folder / "a"), "new");
}

TEST(AtomicFile, AFailedWriterLeavesTheOldFileAndNothingElse) {
  const ScratchFolder folder;
  ASSERT_TRUE(write_file_atomically(folder / "a.txt", "old"));
  const auto outcome =
      write_file_atomically(folder / "a.txt", [](const std::filesystem::path& temporary) {
        write_text(temporary, "half");
        return Result<void>(fail(ErrorCode::kInternal, "stopped", temporary.string()));
      });
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(outcome.error().where, (folder / "a.txt").string());
  EXPECT_EQ(read_text(folder / "a.txt"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(AtomicFile, AMissingFolderIsAnErrorThatNamesTheFile) {
  const ScratchFolder folder;
  const auto outcome = write_file_atomically(folder / "none" / "a.txt", "text");
  ASSERT_FALSE(outcome.has_value());
  EXPECT_EQ(outcome.error().where, (folder / "none" / "a.txt").string());
}

}  // namespace
}  // namespace corridor::formats
