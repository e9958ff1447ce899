// Handles of SQLite that close themselves and answer with our Error. Included by results_store.cpp
// only.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "slam/core/result.hpp"

namespace corridor::results {

class Statement {
 public:
  Statement(sqlite3* database, sqlite3_stmt* statement)
      : database_(database), statement_(statement, &sqlite3_finalize) {}

  // Parameters and columns count from 0.
  void bind(int index, const std::string& text);
  void bind(int index, double value);
  void bind(int index, std::int64_t value);
  // As text where 64 signed bits cannot hold it.
  void bind(int index, std::uint64_t value);
  void bind_null(int index);

  // True: a row is there; false: done.
  Result<bool> step();
  void reset();
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;

 private:
  sqlite3* database_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
};

class Database {
 public:
  static Result<Database> open(const std::filesystem::path& path, int flags);

  Result<void> execute(const std::string& sql);
  Result<Statement> prepare(const std::string& sql);
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  Database(std::string path, sqlite3* database)
      : path_(std::move(path)), database_(database, &sqlite3_close) {}

  std::string path_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
};

}  // namespace corridor::results
