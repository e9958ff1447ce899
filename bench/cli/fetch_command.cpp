#include "bench/cli/fetch_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <CLI/Option.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "bench/runner/exit_code.hpp"
#include "datasets/catalog/fetch.hpp"

namespace corridor::cli {
namespace {

using catalog::CatalogEntry;
using catalog::FetchedFile;
using catalog::FetchStatus;

constexpr double kBytesPerMebibyte = 1024.0 * 1024.0;

// One line on a terminal that says how far a download is; nothing elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_shown) : is_shown_(is_shown) {}
  ~ProgressLine() { erase(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void draw(const std::string& name, std::uint64_t num_bytes,
            std::optional<std::uint64_t> num_bytes_total) {
    constexpr std::chrono::milliseconds kRedrawInterval{200};
    const auto now = std::chrono::steady_clock::now();
    if (!is_shown_ || now - last_drawn_ < kRedrawInterval) return;
    last_drawn_ = now;
    const auto mebibytes = [](std::uint64_t bytes) {
      return static_cast<double>(bytes) / kBytesPerMebibyte;
    };
    std::string line = fmt::format("{}: {:.1f} MiB", name, mebibytes(num_bytes));
    if (num_bytes_total) line += fmt::format(" of {:.1f}", mebibytes(*num_bytes_total));
    erase();
    std::fputs(line.c_str(), stdout);
    std::fflush(stdout);
    is_drawn_ = true;
  }

  void erase() {
    if (is_drawn_) std::fputs("\r\033[K", stdout);
    if (is_drawn_) std::fflush(stdout);
    is_drawn_ = false;
  }

 private:
  bool is_shown_;
  bool is_drawn_ = false;
  std::chrono::steady_clock::time_point last_drawn_;
};

Result<std::vector<const CatalogEntry*>> wanted_of(const catalog::Catalog& known,
                                                   const std::vector<std::string>& names) {
  std::vector<const CatalogEntry*> wanted;
  if (names.empty()) {
    for (const CatalogEntry& entry : known.entries) wanted.push_back(&entry);
    return wanted;
  }
  for (const std::string& name : names) {
    const CatalogEntry* entry = known.find(name);
    if (entry == nullptr) return tl::make_unexpected(catalog::unknown_dataset(known, name));
    const bool is_new = std::find(wanted.begin(), wanted.end(), entry) == wanted.end();
    if (is_new) wanted.push_back(entry);
  }
  return wanted;
}

Result<std::filesystem::path> target_folder(const CommonOptions& common) {
  if (const auto folder = common.data_path()) return *folder;
  if (const auto folder = catalog::cache_folder()) return *folder;
  return fail(ErrorCode::kNotFound,
              "there is no cache folder: neither XDG_CACHE_HOME nor HOME is set", "data fetch",
              "--data-dir DIR");
}

// Without --data-dir a data set that is complete in any folder is not fetched again, and one that
// lies there with other bytes would be found before what is fetched.
Result<std::vector<FetchedFile>> here_already(const catalog::Catalog& known,
                                              const CatalogEntry& entry,
                                              const CommonOptions& common) {
  std::vector<FetchedFile> files;
  if (common.data_path()) return files;
  const auto verified = catalog::verify_dataset(known, entry.name, common.data_dirs());
  if (!verified) return tl::make_unexpected(verified.error());
  for (const catalog::VerifiedFile& file : *verified) {
    if (file.status == catalog::FileStatus::kDiffers) {
      return std::vector<FetchedFile>{
          {file.path, FetchStatus::kFailed,
           fmt::format("a file of SHA-256 {} lies there; expected {}, or nothing: move it away to "
                       "fetch the data set",
                       file.sha256, file.sha256_expected)}};
    }
    if (file.status != catalog::FileStatus::kMatches) return std::vector<FetchedFile>{};
    files.push_back({file.path, FetchStatus::kPresent, ""});
  }
  return files;
}

}  // namespace

void FetchCommand::add_to(CLI::App& command) {
  command.add_option("names", names, "Data sets (default: all that can be fetched)")
      ->type_name("NAME");
  common.add_to(command);
}

Result<ExitCode> FetchCommand::run() const {
  const Result<catalog::Catalog> known = catalog::known_datasets(common.data_dirs());
  if (!known) return tl::make_unexpected(known.error());
  const auto wanted = wanted_of(*known, names);
  if (!wanted) return tl::make_unexpected(wanted.error());
  const auto folder = target_folder(common);
  if (!folder) return tl::make_unexpected(folder.error());

  ProgressLine progress(!common.is_quiet && isatty(STDOUT_FILENO) != 0);
  std::vector<std::vector<std::string>> rows{{"data set", "file", "status", "why"}};
  bool is_good = true;
  for (const CatalogEntry* entry : *wanted) {
    auto files = here_already(*known, *entry, common);
    if (!files) return tl::make_unexpected(files.error());
    if (files->empty()) {
      catalog::DownloadOptions options;
      options.on_progress = [&](std::uint64_t num_bytes, std::optional<std::uint64_t> num_total) {
        progress.draw(entry->name, num_bytes, num_total);
      };
      *files = catalog::fetch_dataset(*entry, entry->folder.value_or(*folder), options);
      progress.erase();
    }
    for (const FetchedFile& file : *files) {
      rows.push_back(
          {entry->name, file.path.string(), std::string(to_text(file.status)), file.message});
      const bool is_here =
          file.status == FetchStatus::kFetched || file.status == FetchStatus::kPresent;
      const bool is_expected = file.status == FetchStatus::kFailed || !names.empty();
      is_good = is_good && (is_here || !is_expected);
    }
  }
  std::fputs(text_table(rows).c_str(), stdout);
  return is_good ? runner::kExitDone : runner::kExitNo;
}

}  // namespace corridor::cli
