#include "datasets/catalog/download.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <string_view>

#include "datasets/catalog/public_url.hpp"

namespace corridor::catalog {
namespace {

constexpr long kOk = 200;
constexpr long kPartialContent = 206;
constexpr long kRangeNotSatisfiable = 416;
constexpr long kMillisecondsPerSecond = 1000;

struct EndEasy {
  void operator()(CURL* easy) const { curl_easy_cleanup(easy); }
};

// How one request ended.
enum class Ending {
  kComplete,
  kRedirected,
  kNotSatisfiable,  // the server has nothing behind what has arrived
  kCut,             // worth another attempt
  kFailed,
};

long milliseconds(double seconds) {
  return std::lround(seconds * static_cast<double>(kMillisecondsPerSecond));
}

// "bytes 500-999/1000" -> 500.
std::optional<std::uint64_t> begin_of_content_range(std::string_view value) {
  const std::size_t digits = value.find_first_of("0123456789");
  if (digits == std::string_view::npos) return std::nullopt;
  std::uint64_t begin = 0;
  const char* end = value.data() + value.size();
  const auto [parsed_to, error] = std::from_chars(value.data() + digits, end, begin);
  if (error != std::errc() || parsed_to == end || *parsed_to != '-') return std::nullopt;
  return begin;
}

// One GET of one address, without redirects.
class Request {
 public:
  Request(const std::string& url, PartFile& part, const DownloadOptions& options)
      : url_(url), part_(part), options_(options), begin_(part.size_bytes()) {}

  Ending run() {
    easy_.reset(curl_easy_init());
    if (!easy_) return failed(ErrorCode::kInternal, "libcurl cannot start", "");
    set_up();
    const CURLcode code = curl_easy_perform(easy_.get());
    curl_easy_getinfo(easy_.get(), CURLINFO_RESPONSE_CODE, &status_);
    if (error_) return Ending::kFailed;  // of our own callbacks
    if (code == CURLE_FILESIZE_EXCEEDED) return too_long();
    if (code != CURLE_OK) return transfer_failed(code);
    return judge_status();
  }

  [[nodiscard]] const Error& error() const { return *error_; }
  [[nodiscard]] const std::string& redirected_to() const { return redirected_to_; }

 private:
  void set_up() {
    CURL* easy = easy_.get();
    curl_easy_setopt(easy, CURLOPT_URL, url_.c_str());
    curl_easy_setopt(easy, CURLOPT_PROTOCOLS_STR, "https,http");
    curl_easy_setopt(easy, CURLOPT_FOLLOWLOCATION, 0L);  // each address is checked by us
    curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(easy, CURLOPT_USERAGENT, "corridor-bench");
    curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS, milliseconds(options_.connect_timeout_s));
    curl_easy_setopt(easy, CURLOPT_LOW_SPEED_LIMIT, 1L);
    curl_easy_setopt(easy, CURLOPT_LOW_SPEED_TIME,
                     std::max(1L, std::lround(options_.stall_timeout_s)));
    curl_easy_setopt(easy, CURLOPT_ERRORBUFFER, message_.data());
    curl_easy_setopt(easy, CURLOPT_HEADERFUNCTION, &Request::take_header);
    curl_easy_setopt(easy, CURLOPT_HEADERDATA, this);
    curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, &Request::take_body);
    curl_easy_setopt(easy, CURLOPT_WRITEDATA, this);
    curl_easy_setopt(easy, CURLOPT_MAXFILESIZE_LARGE, static_cast<curl_off_t>(options_.max_bytes));
    // A proxy of the environment is for the world outside.
    if (is_loopback_http(url_)) curl_easy_setopt(easy, CURLOPT_PROXY, "");
    if (begin_ > 0) {
      const std::string range = fmt::format("{}-", begin_);
      curl_easy_setopt(easy, CURLOPT_RANGE, range.c_str());  // copied by libcurl
    }
  }

  static std::size_t take_header(char* data, std::size_t, std::size_t num_bytes, void* self) {
    auto& request = *static_cast<Request*>(self);
    constexpr std::string_view kName = "content-range:";
    const std::string_view line(data, num_bytes);
    bool is_range = line.size() > kName.size();
    for (std::size_t i = 0; is_range && i < kName.size(); ++i) {
      const char c = line[i];
      is_range = (c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c) == kName[i];
    }
    if (is_range) request.content_begin_ = begin_of_content_range(line.substr(kName.size()));
    return num_bytes;
  }

  static std::size_t take_body(char* data, std::size_t, std::size_t num_bytes, void* self) {
    return static_cast<Request*>(self)->take({data, num_bytes}) ? num_bytes : 0;
  }

  // False, with error_ set, to end the transfer.
  bool take(std::string_view bytes) {
    if (!has_begun_ && !begin_body()) return false;
    if (!is_wanted_) return true;  // the page that comes with an error or a redirect
    if (part_.size_bytes() + bytes.size() > options_.max_bytes) {
      too_long();
      return false;
    }
    if (const auto written = part_.append(bytes); !written) {
      error_ = written.error();
      return false;
    }
    if (options_.on_progress) options_.on_progress(part_.size_bytes(), total_bytes());
    return true;
  }

  // What the answer is: the rest, the whole, or something else.
  bool begin_body() {
    has_begun_ = true;
    curl_easy_getinfo(easy_.get(), CURLINFO_RESPONSE_CODE, &status_);
    is_wanted_ = status_ == kOk || status_ == kPartialContent;
    if (!is_wanted_) return true;
    // Range was ignored, or is another than asked for: what comes is not what is missing.
    if (status_ == kPartialContent && content_begin_.value_or(0) != begin_) {
      failed(ErrorCode::kMalformed, "the server sends another part of the file than was asked for",
             fmt::format("bytes from {} on", begin_));
      return false;
    }
    if (status_ == kOk && begin_ > 0) {
      begin_ = 0;
      if (const auto cleared = part_.clear(); !cleared) {
        error_ = cleared.error();
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::optional<std::uint64_t> total_bytes() const {
    curl_off_t length = -1;
    curl_easy_getinfo(easy_.get(), CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &length);
    if (length < 0) return std::nullopt;
    return begin_ + static_cast<std::uint64_t>(length);
  }

  Ending judge_status() {
    // An empty answer has no body to begin.
    if (!has_begun_ && !begin_body()) return Ending::kFailed;
    if (is_wanted_) return Ending::kComplete;
    if (status_ == kRangeNotSatisfiable && begin_ > 0) return Ending::kNotSatisfiable;
    char* location = nullptr;
    curl_easy_getinfo(easy_.get(), CURLINFO_REDIRECT_URL, &location);
    if (location != nullptr) {
      redirected_to_ = location;
      return Ending::kRedirected;
    }
    return failed(status_ == 404 || status_ == 410 ? ErrorCode::kNotFound : ErrorCode::kUnreadable,
                  fmt::format("the server answers {}", status_), "200");
  }

  Ending transfer_failed(CURLcode code) {
    // What no repetition mends: the address, the certificate.
    const bool is_final = code == CURLE_COULDNT_RESOLVE_HOST || code == CURLE_COULDNT_CONNECT ||
                          code == CURLE_PEER_FAILED_VERIFICATION || code == CURLE_URL_MALFORMAT ||
                          code == CURLE_UNSUPPORTED_PROTOCOL;
    const std::string_view detail(message_.data());
    failed(ErrorCode::kUnreadable, detail.empty() ? curl_easy_strerror(code) : std::string(detail),
           is_final ? "an answer of the server" : "the whole file");
    return is_final ? Ending::kFailed : Ending::kCut;
  }

  Ending too_long() {
    return failed(ErrorCode::kResourceLimit, "the file is longer than the limit",
                  fmt::format("at most {} bytes", options_.max_bytes));
  }

  Ending failed(ErrorCode code, std::string what, std::string expected) {
    error_ = Error{code, std::move(what), url_, std::move(expected)};
    return Ending::kFailed;
  }

  const std::string& url_;
  PartFile& part_;
  const DownloadOptions& options_;
  std::uint64_t begin_;
  std::unique_ptr<CURL, EndEasy> easy_;
  std::array<char, CURL_ERROR_SIZE> message_{};
  long status_ = 0;
  bool has_begun_ = false;
  bool is_wanted_ = false;
  std::optional<std::uint64_t> content_begin_;
  std::string redirected_to_;
  std::optional<Error> error_;
};

// The address that a server names instead of `from`.
Result<std::string> follow(const std::string& from, const std::string& to) {
  if (const auto good = check_public_url(to); !good) return tl::make_unexpected(good.error());
  if (!is_loopback_http(from) && is_loopback_http(to)) {
    return fail(ErrorCode::kInvalid, "the server leads from https to http", to, "https");
  }
  return to;
}

}  // namespace

Result<void> download(const std::string& url, PartFile& part, const DownloadOptions& options) {
  if (const auto good = check_public_url(url); !good) return good;
  std::string at = url;
  int num_redirects = 0;
  int num_attempts = 0;
  while (true) {
    const std::uint64_t size_before = part.size_bytes();
    Request request(at, part, options);
    switch (request.run()) {
      case Ending::kComplete:
        return {};
      case Ending::kRedirected: {
        if (++num_redirects > options.max_redirects) {
          return fail(ErrorCode::kUnreadable,
                      fmt::format("more than {} redirects", options.max_redirects), url, "a file");
        }
        auto next = follow(at, request.redirected_to());
        if (!next) return tl::make_unexpected(next.error());
        at = std::move(*next);
        break;
      }
      case Ending::kNotSatisfiable:
        // The part is as long as the file, or longer: its checksum will tell.
        return {};
      case Ending::kCut:
        if (++num_attempts < options.max_attempts && part.size_bytes() != size_before) break;
        return tl::make_unexpected(request.error());
      case Ending::kFailed:
        return tl::make_unexpected(request.error());
    }
  }
}

}  // namespace corridor::catalog
