#include "bench/results/sqlite.hpp"

#include <limits>

namespace corridor::results {
namespace {

constexpr int kBusyTimeout_ms = 10'000;

tl::unexpected<Error> sqlite_error(sqlite3* database, const std::string& where) {
  return fail(ErrorCode::kUnreadable, std::string("SQLite: ") + sqlite3_errmsg(database), where,
              "a results store (results.sqlite)");
}

}  // namespace

void Statement::bind(int index, const std::string& text) {
  sqlite3_bind_text(statement_.get(), index + 1, text.data(), static_cast<int>(text.size()),
                    SQLITE_TRANSIENT);
}

void Statement::bind(int index, double value) {
  sqlite3_bind_double(statement_.get(), index + 1, value);
}

void Statement::bind(int index, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), index + 1, value);
}

void Statement::bind(int index, std::uint64_t value) {
  if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    bind(index, std::to_string(value));
  } else {
    bind(index, static_cast<std::int64_t>(value));
  }
}

void Statement::bind_null(int index) { sqlite3_bind_null(statement_.get(), index + 1); }

Result<bool> Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  const char* name = sqlite3_db_filename(database_, "main");
  return sqlite_error(database_, name == nullptr ? "" : name);
}

void Statement::reset() {
  sqlite3_reset(statement_.get());
  sqlite3_clear_bindings(statement_.get());
}

std::string Statement::text(int column) const {
  const unsigned char* text = sqlite3_column_text(statement_.get(), column);
  const int num_bytes = sqlite3_column_bytes(statement_.get(), column);
  if (text == nullptr) return {};
  return {reinterpret_cast<const char*>(text), static_cast<std::size_t>(num_bytes)};
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

Result<Database> Database::open(const std::filesystem::path& path, int flags) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, flags, nullptr);
  Database database(path.string(), handle);
  if (code != SQLITE_OK) return sqlite_error(handle, database.path_);
  sqlite3_busy_timeout(handle, kBusyTimeout_ms);
  return database;
}

Result<void> Database::execute(const std::string& sql) {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    return sqlite_error(database_.get(), path_);
  }
  return {};
}

Result<Statement> Database::prepare(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
    return sqlite_error(database_.get(), path_);
  }
  return Statement(database_.get(), statement);
}

}  // namespace corridor::results
