#include "bench/runner/suite.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "bench/runner/back_ends.hpp"

namespace corridor::runner {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxSeeds = 100'000;

std::string join(const std::vector<std::string>& lines) {
  return fmt::format("{}", fmt::join(lines, "; "));
}

// The text form that parameter overrides have.
std::optional<std::string> scalar_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean()) return std::string(flag->get() ? "true" : "false");
  return std::nullopt;
}

// Walks the file once and gathers everything that is wrong with it.
class Parser {
 public:
  explicit Parser(const fs::path& path) : file_(path.string()) {}

  Result<Suite> parse(const toml::table& table) {
    for (const auto& [key, node] : table) take_key(key.str(), node);
    if (suite_.name.empty()) problem(table, R"(key "name" is missing)");
    if (suite_.systems.empty()) problem(table, R"(key "systems" is missing or empty)");
    if (suite_.scenarios.empty() && suite_.datasets.empty()) {
      problem(table, R"(neither "scenarios" nor "datasets" names any data)");
    }
    check_all_overrides(table);
    check_backends_of(table);
    if (problems_.empty()) return suite_;
    return fail(ErrorCode::kInvalid, join(problems_));
  }

 private:
  void problem(const toml::node& node, const std::string& text) {
    problems_.push_back(fmt::format("{}:{}: {}", file_, node.source().begin.line, text));
  }

  void take_key(std::string_view key, const toml::node& node) {
    if (key == "name")
      take_text(key, node, suite_.name);
    else if (key == "description")
      take_text(key, node, suite_.description);
    else if (key == "systems")
      take_systems(node);
    else if (key == "backends")
      suite_.backends = take_backends(key, node);
    else if (key == "backends_of")
      take_backends_of(node);
    else if (key == "scenarios")
      suite_.scenarios = take_texts(key, node);
    else if (key == "datasets")
      suite_.datasets = take_texts(key, node);
    else if (key == "first_seed")
      take_integer(key, node, 0, suite_.first_seed);
    else if (key == "num_seeds")
      take_integer(key, node, 1, suite_.num_seeds);
    else if (key == "threads")
      take_integer(key, node, 1, suite_.threads);
    else if (key == "limits")
      take_limits(node);
    else if (key == "overrides")
      take_overrides(node);
    else
      problem(node,
              fmt::format(
                  R"(unknown key "{}" (known: name description systems backends )"
                  "backends_of scenarios datasets first_seed num_seeds threads limits overrides)",
                  key));
  }

  void take_text(std::string_view key, const toml::node& node, std::string& text) {
    if (const auto* value = node.as_string())
      text = value->get();
    else
      problem(node, fmt::format("{}: expected a text", key));
  }

  std::vector<std::string> take_texts(std::string_view key, const toml::node& node) {
    std::vector<std::string> texts;
    const toml::array* array = node.as_array();
    if (array == nullptr) {
      problem(node, fmt::format("{}: expected an array of texts", key));
      return texts;
    }
    for (const toml::node& element : *array) {
      take_text(key, element, texts.emplace_back());
      if (std::count(texts.begin(), texts.end(), texts.back()) > 1) {
        problem(element, fmt::format(R"({}: "{}" is given twice)", key, texts.back()));
      }
    }
    return texts;
  }

  template <class T>
  void take_integer(std::string_view key, const toml::node& node, std::int64_t min, T& value) {
    const auto* number = node.as_integer();
    const std::int64_t max = std::is_same_v<T, int> ? kMaxSeeds : INT64_MAX;
    if (number == nullptr || number->get() < min || number->get() > max) {
      problem(node, fmt::format("{}: expected an integer from {} to {}", key, min, max));
    } else {
      value = static_cast<T>(number->get());
    }
  }

  void take_systems(const toml::node& node) {
    for (const std::string& text : take_texts("systems", node)) {
      const Result<SystemChoice> choice = parse_system_choice(text);
      if (choice)
        suite_.systems.push_back(*choice);
      else
        problem(node, choice.error().to_line());
    }
  }

  std::vector<std::string> take_backends(std::string_view key, const toml::node& node) {
    std::vector<std::string> backends;
    for (const std::string& text : take_texts(key, node)) {
      const Result<void> known = check_back_end(text);
      if (known)
        backends.push_back(text);
      else
        problem(node, known.error().to_line());
    }
    return backends;
  }

  void take_backends_of(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return problem(node, "backends_of: expected a table");
    for (const auto& [system, value] : *table) {
      const Result<SystemChoice> choice = parse_system_choice(system.str());
      if (!choice) {
        problem(value, "backends_of: " + choice.error().to_line());
        continue;
      }
      suite_.backends_of.emplace_back(*choice, take_backends("backends_of", value));
    }
  }

  void take_limits(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return problem(node, "limits: expected a table");
    for (const auto& [key, value] : *table) {
      if (key.str() == "time_s") {
        const std::optional<double> time_s = value.value<double>();
        if (time_s && *time_s > 0)
          suite_.limits.time_s = *time_s;
        else
          problem(value, "limits.time_s: expected a number > 0");
      } else if (key.str() == "memory_mib") {
        take_integer("limits.memory_mib", value, 1, suite_.limits.memory_mib);
      } else {
        problem(value,
                fmt::format(R"(unknown key "limits.{}" (known: time_s memory_mib))", key.str()));
      }
    }
  }

  void take_overrides(const toml::node& node) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return problem(node, "overrides: expected tables [overrides.NAME]");
    for (const auto& [owner, value] : *table) {
      const toml::table* params = value.as_table();
      if (params == nullptr) {
        problem(value, fmt::format("overrides.{}: expected a table", owner.str()));
        continue;
      }
      take_overrides_of(std::string(owner.str()), *params);
    }
  }

  void take_overrides_of(const std::string& owner, const toml::table& params) {
    for (const auto& [key, value] : params) {
      const std::optional<std::string> text = scalar_text(value);
      if (!text) {
        problem(value, fmt::format("overrides.{}.{}: expected a number, text or truth value", owner,
                                   key.str()));
        continue;
      }
      suite_.overrides[owner][std::string(key.str())] = *text;
    }
  }

  void check_all_overrides(const toml::table& table) {
    const std::vector<std::string> back_ends = back_ends_of(suite_);
    for (const auto& [owner, params] : suite_.overrides) {
      const toml::node* found = table.at_path("overrides." + owner).node();
      const toml::node& node = found == nullptr ? table : *found;
      if (const Result<void> good = check_overrides(suite_, owner, params); !good) {
        problem(node, "overrides: " + good.error().to_line());
        continue;
      }
      const std::string& name = owner;  // clang 14 captures no structured binding
      const auto is_run = [&name](const SystemChoice& choice) { return choice.system == name; };
      if (std::none_of(suite_.systems.begin(), suite_.systems.end(), is_run) &&
          std::find(back_ends.begin(), back_ends.end(), owner) == back_ends.end()) {
        problem(node, fmt::format("overrides.{}: the suite does not run this {}", owner,
                                  check_back_end(owner) ? "back-end" : "system"));
      }
    }
  }

  void check_backends_of(const toml::table& table) {
    const toml::node* node = table.get("backends_of");
    for (const auto& [choice, backends] : suite_.backends_of) {
      const auto& run = suite_.systems;
      if (std::find(run.begin(), run.end(), choice) == run.end()) {
        problem(*node, fmt::format("backends_of: the suite does not run {}@{}", choice.system,
                                   choice.profile));
      } else if (!find_system(choice.system)->default_backend) {
        problem(*node, fmt::format("backends_of: {} takes no back-end", choice.system));
      }
    }
  }

  std::string file_;
  Suite suite_;
  std::vector<std::string> problems_;
};

}  // namespace

const std::vector<std::string>& Suite::backends_for(const SystemChoice& choice) const {
  for (const auto& [system, own] : backends_of) {
    if (system == choice) return own;
  }
  return backends;
}

Result<Suite> read_suite(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(ErrorCode::kNotFound, "cannot be opened", path.string(), "a suite");
  std::ostringstream text;
  text << file.rdbuf();
  try {
    return Parser(path).parse(toml::parse(text.str(), path.string()));
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::kMalformed, std::string(error.description()),
                fmt::format("{}:{}", path.string(), error.source().begin.line), "TOML");
  }
}

}  // namespace corridor::runner
