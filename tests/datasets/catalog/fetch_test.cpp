// Fetching from a server on loopback that behaves, and from one that does not.
#include "datasets/catalog/fetch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "datasets/catalog/sha256.hpp"
#include "datasets/formats/file_bytes.hpp"
#include "tests/support/http_server.hpp"
#include "tests/support/scratch_folder.hpp"

namespace corridor::catalog {
namespace {

namespace fs = std::filesystem;
using testing::HttpReply;
using testing::HttpRequest;
using testing::HttpServer;
using testing::ScratchFolder;

// More than one packet, and no two parts alike.
std::string content() {
  std::string text;
  for (int line = 0; line < 20'000; ++line) text += "line " + std::to_string(line) + "\n";
  return text;
}

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class Fetch : public ::testing::Test {
 protected:
  // One file of the given content at `url`.
  [[nodiscard]] FetchedFile fetch(const std::string& url) const {
    CatalogEntry entry;
    entry.name = "tiny";
    entry.files = {{"sub/tiny.clf", to_hex(sha256_of(content_)), false, url}};
    return fetch_dataset(entry, folder_.path(), options_).front();
  }
  [[nodiscard]] fs::path target() const { return folder_ / "sub/tiny.clf"; }
  [[nodiscard]] fs::path part() const { return folder_ / "sub/tiny.clf.part"; }

  void expect_whole(const FetchedFile& file) const {
    EXPECT_EQ(file.status, FetchStatus::kFetched) << file.message;
    EXPECT_EQ(bytes_of(target()), content_);
    EXPECT_FALSE(fs::exists(part()));
  }

  void expect_failure(const FetchedFile& file, const std::vector<std::string>& says) const {
    EXPECT_EQ(file.status, FetchStatus::kFailed);
    EXPECT_FALSE(fs::exists(target()));
    EXPECT_EQ(file.message.find('\n'), std::string::npos) << file.message;
    for (const std::string& what : says) {
      EXPECT_NE(file.message.find(what), std::string::npos) << what << " in " << file.message;
    }
  }

  ScratchFolder folder_;
  std::string content_ = content();
  DownloadOptions options_;
};

TEST_F(Fetch, BringsAWholeFileAndSaysSo) {
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, content_); });
  std::uint64_t num_bytes = 0;
  std::optional<std::uint64_t> num_total;
  options_.on_progress = [&](std::uint64_t arrived, std::optional<std::uint64_t> total) {
    num_bytes = arrived;
    num_total = total;
  };
  expect_whole(fetch(server.url("/tiny")));
  EXPECT_EQ(num_bytes, content_.size());
  EXPECT_EQ(num_total, content_.size());
}

TEST_F(Fetch, AsksNoServerForWhatIsThere) {
  folder_.write("sub/tiny.clf", content_);
  const HttpServer server([](const HttpRequest&) { return HttpReply{}; });
  EXPECT_EQ(fetch(server.url("/tiny")).status, FetchStatus::kPresent);
  EXPECT_TRUE(server.requests().empty());
}

TEST_F(Fetch, LeavesAnotherFileOfTheNameAlone) {
  folder_.write("sub/tiny.clf", "my own log");
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, content_); });
  const FetchedFile file = fetch(server.url("/tiny"));
  EXPECT_EQ(file.status, FetchStatus::kFailed);
  EXPECT_NE(file.message.find("lies there"), std::string::npos) << file.message;
  EXPECT_EQ(bytes_of(target()), "my own log");
  EXPECT_TRUE(server.requests().empty());
}

TEST_F(Fetch, GoesOnWhereAnEarlierAttemptStopped) {
  folder_.write("sub/tiny.clf.part", content_.substr(0, 1000));
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, content_); });
  expect_whole(fetch(server.url("/tiny")));
  ASSERT_EQ(server.requests().size(), 1U);
  EXPECT_EQ(server.requests()[0].range_begin, 1000U);
}

TEST_F(Fetch, TakesAPartThatIsWholeAlready) {
  folder_.write("sub/tiny.clf.part", content_);
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, content_); });
  expect_whole(fetch(server.url("/tiny")));
}

TEST_F(Fetch, StartsAnewIfThePartIsOfAnotherFile) {
  folder_.write("sub/tiny.clf.part", "not the beginning of it");
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, content_); });
  expect_whole(fetch(server.url("/tiny")));
  ASSERT_EQ(server.requests().size(), 2U);
  EXPECT_FALSE(server.requests()[1].range_begin.has_value());
}

TEST_F(Fetch, TakesTheWholeFromAServerThatIgnoresRange) {
  folder_.write("sub/tiny.clf.part", content_.substr(0, 1000));
  const HttpServer server([&](const HttpRequest&) {
    return HttpReply{"200 OK", "", content_, {}};
  });
  expect_whole(fetch(server.url("/tiny")));
  EXPECT_EQ(server.requests().size(), 1U);
}

TEST_F(Fetch, RefusesAnotherPartThanItAskedFor) {
  folder_.write("sub/tiny.clf.part", content_.substr(0, 1000));
  const HttpServer server([&](const HttpRequest&) {
    return HttpServer::serve_content({"/tiny", 500, 0}, content_);
  });
  expect_failure(fetch(server.url("/tiny")), {"another part of the file", "1000"});
  EXPECT_EQ(bytes_of(part()), content_.substr(0, 1000));
}

TEST_F(Fetch, GoesOnAfterACutConnection) {
  const HttpServer server([&](const HttpRequest& request) {
    HttpReply reply = HttpServer::serve_content(request, content_);
    if (request.number == 0) reply.num_bytes_sent = 5000;
    return reply;
  });
  expect_whole(fetch(server.url("/tiny")));
  ASSERT_EQ(server.requests().size(), 2U);
  EXPECT_EQ(server.requests()[1].range_begin, 5000U);
}

TEST_F(Fetch, KeepsWhatArrivedOfATruncatedFileForLater) {
  const HttpServer server([&](const HttpRequest& request) {
    HttpReply reply = HttpServer::serve_content(request, content_);
    reply.num_bytes_sent = request.number == 0 ? 5000 : 0;
    return reply;
  });
  expect_failure(fetch(server.url("/tiny")), {"5000 bytes are kept in", "tiny.clf.part"});
  EXPECT_EQ(bytes_of(part()), content_.substr(0, 5000));
}

TEST_F(Fetch, RemovesAFileOfAnotherChecksum) {
  const HttpServer server(
      [](const HttpRequest& request) { return HttpServer::serve_content(request, "forged"); });
  expect_failure(fetch(server.url("/tiny")),
                 {"SHA-256 is " + to_hex(sha256_of("forged")), "removed",
                  "expected " + to_hex(sha256_of(content_))});
  EXPECT_FALSE(fs::exists(part()));
  EXPECT_EQ(server.requests().size(), 1U);
}

TEST_F(Fetch, SaysThatAPageIsMissingAndLeavesNothing) {
  const HttpServer server([](const HttpRequest&) {
    return HttpReply{"404 Not Found", "", "<html>no such page</html>", {}};
  });
  expect_failure(fetch(server.url("/tiny")), {server.url("/tiny"), "404"});
  EXPECT_FALSE(fs::exists(part()));
}

TEST_F(Fetch, SaysThatNobodyAnswers) {
  std::string url;
  {
    const HttpServer server([](const HttpRequest&) { return HttpReply{}; });
    url = server.url("/tiny");
  }
  expect_failure(fetch(url), {url});
  EXPECT_FALSE(fs::exists(part()));
}

TEST_F(Fetch, EndsAnAttemptThatBringsNothingForTooLong) {
  const HttpServer server([](const HttpRequest&) {
    std::this_thread::sleep_for(std::chrono::seconds(4));
    return HttpReply{};
  });
  options_.stall_timeout_s = 1;
  expect_failure(fetch(server.url("/tiny")), {"too slow"});
  EXPECT_EQ(server.requests().size(), 1U) << "nothing came: no other attempt";
}

TEST_F(Fetch, FollowsARedirectOfTheSameMachine) {
  const HttpServer server([&](const HttpRequest& request) {
    if (request.path == "/moved") return HttpServer::serve_content(request, content_);
    return HttpReply{"302 Found", "Location: /moved\r\n", "elsewhere", {}};
  });
  expect_whole(fetch(server.url("/tiny")));
}

TEST_F(Fetch, EndsALoopOfRedirects) {
  const HttpServer server([](const HttpRequest&) {
    return HttpReply{"302 Found", "Location: /tiny\r\n", "", {}};
  });
  expect_failure(fetch(server.url("/tiny")), {"more than 8 redirects"});
  EXPECT_EQ(server.requests().size(), 9U);
}

TEST_F(Fetch, FollowsNoRedirectToPlainHttpElsewhereNorToFiles) {
  for (const std::string to : {"http://example.org/tiny", "file:///etc/passwd", "ftp://a/b"}) {
    const HttpServer server([&](const HttpRequest&) {
      return HttpReply{"302 Found", "Location: " + to + "\r\n", "", {}};
    });
    expect_failure(fetch(server.url("/tiny")), {to, "expected https"});
    EXPECT_EQ(server.requests().size(), 1U) << to;
  }
}

TEST_F(Fetch, EndsADownloadThatIsLongerThanTheLimit) {
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, content_); });
  options_.max_bytes = 100;
  expect_failure(fetch(server.url("/tiny")), {"at most 100 bytes"});
}

TEST_F(Fetch, LeavesAFileToTheProgramThatIsFetchingIt) {
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, content_); });
  fs::create_directories(target().parent_path());
  const auto other = PartFile::open(part());
  ASSERT_TRUE(other.has_value());
  expect_failure(fetch(server.url("/tiny")), {"another program is fetching"});
}

TEST_F(Fetch, PacksWhatIsPublishedPlainAndKnowsItByItsContent) {
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, content_); });
  CatalogEntry entry;
  entry.files = {{"tiny.clf.gz", to_hex(sha256_of(content_)), true, server.url("/tiny")}};
  const FetchedFile file = fetch_dataset(entry, folder_.path(), options_).front();
  EXPECT_EQ(file.status, FetchStatus::kFetched) << file.message;
  EXPECT_LT(fs::file_size(folder_ / "tiny.clf.gz"), content_.size());
  EXPECT_EQ(formats::read_file_bytes(folder_ / "tiny.clf.gz"), content_);
  EXPECT_EQ(fetch_dataset(entry, folder_.path(), options_).front().status, FetchStatus::kPresent);
  EXPECT_FALSE(fs::exists(folder_ / "tiny.clf.gz.part"));
}

TEST_F(Fetch, UnpacksWhatIsPublishedPackedUnderAPlainName) {
  const std::string packed = *formats::gzip(content_);
  const HttpServer server(
      [&](const HttpRequest& request) { return HttpServer::serve_content(request, packed); });
  CatalogEntry entry;
  entry.files = {{"tiny.clf", to_hex(sha256_of(content_)), true, server.url("/tiny.gz")}};
  EXPECT_EQ(fetch_dataset(entry, folder_.path(), options_).front().status, FetchStatus::kFetched);
  EXPECT_EQ(bytes_of(folder_ / "tiny.clf"), content_);
}

TEST_F(Fetch, SaysWhyThereIsNothingToFetch) {
  CatalogEntry entry;
  entry.files = {{"tiny.clf", to_hex(sha256_of(content_)), false, ""}};
  entry.not_fetchable = "derived";
  const FetchedFile file = fetch_dataset(entry, folder_.path(), options_).front();
  EXPECT_EQ(file.status, FetchStatus::kNotFetchable);
  EXPECT_EQ(file.message, "derived");
}

}  // namespace
}  // namespace corridor::catalog
