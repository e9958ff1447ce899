#include "bench/results/results_store.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <type_traits>

#include "bench/results/result_json.hpp"
#include "bench/results/result_keys.hpp"
#include "bench/results/sqlite.hpp"

namespace corridor::results {
namespace {

// Marks the file as ours ("CBRS"), so that no other SQLite file is written to by mistake.
constexpr int kApplicationId = 0x43425253;

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

// What has a column of its own: numbers, texts, the status, and the optional ones of these.
template <class T>
constexpr bool is_scalar() {
  if constexpr (IsOptional<T>::value) return is_scalar<typename T::value_type>();
  return std::is_arithmetic_v<T> || std::is_same_v<T, std::string> || std::is_same_v<T, CaseStatus>;
}

// A column without a type keeps 64-bit seeds exact: an INTEGER column would turn large ones into
// floating point.
template <class T>
std::string_view column_type() {
  if constexpr (IsOptional<T>::value)
    return column_type<typename T::value_type>();
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return "";
  else if constexpr (std::is_integral_v<T>)
    return "INTEGER";
  else if constexpr (std::is_floating_point_v<T>)
    return "REAL";
  else
    return "TEXT";
}

template <class T>
void bind_value(Statement& statement, int index, const T& value) {
  if constexpr (IsOptional<T>::value) {
    value ? bind_value(statement, index, *value) : statement.bind_null(index);
  } else if constexpr (std::is_same_v<T, CaseStatus>) {
    statement.bind(index, to_text(value));
  } else if constexpr (std::is_floating_point_v<T>) {
    std::isfinite(value) ? statement.bind(index, value) : statement.bind_null(index);
  } else if constexpr (std::is_same_v<T, int>) {
    statement.bind(index, static_cast<std::int64_t>(value));
  } else {
    statement.bind(index, value);
  }
}

struct Column {
  std::string name;
  std::string type;
};

// One per scalar key, then the whole record.
std::vector<Column> columns() {
  std::vector<Column> found;
  const RunResult result;
  visit_keys(result, [&](const ResultKey& key, const auto& field) {
    using T = std::remove_cvref_t<decltype(field)>;
    if constexpr (is_scalar<T>()) found.push_back({key.name, std::string(column_type<T>())});
  });
  found.push_back({"json", "TEXT"});
  return found;
}

Result<std::set<std::string>> existing_columns(Database& database) {
  Result<Statement> statement = database.prepare("PRAGMA table_info(cases)");
  if (!statement) return tl::make_unexpected(statement.error());
  std::set<std::string> names;
  while (true) {
    const Result<bool> row = statement->step();
    if (!row) return tl::make_unexpected(row.error());
    if (!*row) return names;
    names.insert(statement->text(1));
  }
}

Result<void> check_owner(Database& database, bool may_be_new) {
  std::int64_t id = 0;
  std::int64_t num_tables = 0;
  for (auto [sql, value] : {std::pair("PRAGMA application_id", &id),
                            std::pair("SELECT count(*) FROM sqlite_master", &num_tables)}) {
    Result<Statement> statement = database.prepare(sql);
    if (!statement) return tl::make_unexpected(statement.error());
    const Result<bool> row = statement->step();
    if (!row) return tl::make_unexpected(row.error());
    *value = statement->integer(0);
  }
  if (id == kApplicationId || (may_be_new && num_tables == 0)) return {};
  return fail(ErrorCode::kInvalid, "is a database of another program", database.path(),
              "a results store (results.sqlite)");
}

Result<void> create_tables(Database& database) {
  std::string sql =
      "CREATE TABLE IF NOT EXISTS cases (case_id TEXT PRIMARY KEY NOT NULL);"
      "CREATE TABLE IF NOT EXISTS machines (machine_id TEXT PRIMARY KEY NOT NULL, "
      "cpu_model TEXT, num_cores INTEGER, memory_mib INTEGER, kernel TEXT, "
      "compiler TEXT);";
  sql += fmt::format("PRAGMA application_id = {};", kApplicationId);
  if (Result<void> done = database.execute(sql); !done) return done;
  const Result<std::set<std::string>> existing = existing_columns(database);
  if (!existing) return tl::make_unexpected(existing.error());
  for (const Column& column : columns()) {
    if (existing->contains(column.name)) continue;
    Result<void> added = database.execute(
        fmt::format("ALTER TABLE cases ADD COLUMN \"{}\" {}", column.name, column.type));
    if (!added) return added;
  }
  return {};
}

// BEGIN ... COMMIT around `change`; ROLLBACK if it fails.
template <class F>
Result<void> in_transaction(Database& database, F&& change) {
  if (Result<void> begun = database.execute("BEGIN IMMEDIATE"); !begun) return begun;
  Result<void> done = change();
  if (done) done = database.execute("COMMIT");
  if (!done) (void)database.execute("ROLLBACK");
  return done;
}

std::string insert_sql() {
  std::string names;
  std::string marks;
  for (const Column& column : columns()) {
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", column.name);
    marks += marks.empty() ? "?" : ", ?";
  }
  return fmt::format("INSERT OR REPLACE INTO cases ({}) VALUES ({})", names, marks);
}

Result<void> insert(Statement& statement, const RunResult& result) {
  statement.reset();
  int index = 0;
  visit_keys(result, [&](const ResultKey&, const auto& field) {
    if constexpr (is_scalar<std::remove_cvref_t<decltype(field)>>()) {
      bind_value(statement, index++, field);
    }
  });
  statement.bind(index, to_json(result));
  const Result<bool> stepped = statement.step();
  if (!stepped) return tl::make_unexpected(stepped.error());
  return {};
}

}  // namespace

struct ResultsStore::Connection {
  Database database;
};

ResultsStore::ResultsStore(std::unique_ptr<Connection> connection)
    : connection_(std::move(connection)) {}
ResultsStore::ResultsStore(ResultsStore&&) noexcept = default;
ResultsStore& ResultsStore::operator=(ResultsStore&&) noexcept = default;
ResultsStore::~ResultsStore() = default;

Result<ResultsStore> ResultsStore::open(const std::filesystem::path& path) {
  Result<Database> database = Database::open(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  if (!database) return tl::make_unexpected(database.error());
  if (const Result<void> ours = check_owner(*database, true); !ours) {
    return tl::make_unexpected(ours.error());
  }
  const Result<void> created = in_transaction(*database, [&] { return create_tables(*database); });
  if (!created) return tl::make_unexpected(created.error());
  return ResultsStore(std::make_unique<Connection>(Connection{std::move(*database)}));
}

Result<ResultsStore> ResultsStore::open_read_only(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    return fail(ErrorCode::kNotFound, "does not exist", path.string(),
                "a results store (results.sqlite)");
  }
  Result<Database> database = Database::open(path, SQLITE_OPEN_READONLY);
  if (!database) return tl::make_unexpected(database.error());
  if (const Result<void> ours = check_owner(*database, false); !ours) {
    return tl::make_unexpected(ours.error());
  }
  return ResultsStore(std::make_unique<Connection>(Connection{std::move(*database)}));
}

Result<void> ResultsStore::put(const std::vector<RunResult>& results) {
  Result<Statement> statement = connection_->database.prepare(insert_sql());
  if (!statement) return tl::make_unexpected(statement.error());
  return in_transaction(connection_->database, [&]() -> Result<void> {
    for (const RunResult& result : results) {
      if (Result<void> done = insert(*statement, result); !done) return done;
    }
    statement->reset();
    return {};
  });
}

Result<void> ResultsStore::put(const Machine& machine) {
  Result<Statement> statement =
      connection_->database.prepare("INSERT OR REPLACE INTO machines VALUES (?, ?, ?, ?, ?, ?)");
  if (!statement) return tl::make_unexpected(statement.error());
  statement->bind(0, machine.machine_id);
  statement->bind(1, machine.cpu_model);
  statement->bind(2, machine.num_cores);
  statement->bind(3, machine.memory_mib);
  statement->bind(4, machine.kernel);
  statement->bind(5, machine.compiler);
  const Result<bool> stepped = statement->step();
  if (!stepped) return tl::make_unexpected(stepped.error());
  return {};
}

Result<std::vector<RunResult>> ResultsStore::read_all() const {
  Result<Statement> statement =
      connection_->database.prepare("SELECT case_id, json FROM cases ORDER BY case_id");
  if (!statement) return tl::make_unexpected(statement.error());
  std::vector<RunResult> results;
  while (true) {
    const Result<bool> row = statement->step();
    if (!row) return tl::make_unexpected(row.error());
    if (!*row) return results;
    Result<RunResult> result = result_from_json(
        statement->text(1),
        fmt::format("{}: case {}", connection_->database.path(), statement->text(0)));
    if (!result) return tl::make_unexpected(result.error());
    results.push_back(std::move(*result));
  }
}

Result<std::vector<Machine>> ResultsStore::read_machines() const {
  Result<Statement> statement = connection_->database.prepare(
      "SELECT machine_id, cpu_model, num_cores, memory_mib, kernel, compiler FROM machines "
      "ORDER BY machine_id");
  if (!statement) return tl::make_unexpected(statement.error());
  std::vector<Machine> machines;
  while (true) {
    const Result<bool> row = statement->step();
    if (!row) return tl::make_unexpected(row.error());
    if (!*row) return machines;
    machines.push_back({statement->text(0), statement->text(1), statement->integer(2),
                        statement->integer(3), statement->text(4), statement->text(5)});
  }
}

}  // namespace corridor::results
